"""`linkforge collisions` that a person or the system ends: no process of it stays."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.collisions.sampled import HEAD
from tests.collisions.test_command import ARM

pytest.importorskip("pinocchio")

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="lists the processes of a group in /proc")

PATIENCE = 200
"""Longer than any of these steps on a busy machine [s]."""


@pytest.mark.parametrize("is_starting", [True, False])
def test_ctrl_c_ends_all_processes(is_starting: bool, arm: Path):
    with running(arm) as process:
        assert process.stderr
        if is_starting:
            wait_until(lambda: has_workers(process.pid))
        else:
            assert "of 9,000,000 samples" in process.stderr.readline()
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(PATIENCE) == 130
        assert "Traceback" not in process.stderr.read()
        wait_until(lambda: not processes_in(process.pid))


def test_workers_end_with_a_command_that_is_killed(arm: Path):
    with running(arm) as process:
        assert process.stderr
        process.stderr.readline()
        wait_until(lambda: has_workers(process.pid))
        process.kill()
        assert process.wait(PATIENCE) == -signal.SIGKILL
        wait_until(lambda: not processes_in(process.pid))
        assert "Traceback" not in process.stderr.read()


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    path = tmp_path / "arm.robot.yaml"
    path.write_text(HEAD + ARM, "utf-8")
    return path


@contextmanager
def running(spec: Path) -> Iterator[subprocess.Popen[str]]:
    """Run the command, with two workers, in a group of its own as a terminal does; end what is left of it."""
    # A shell has a job in the background, such as the tests themselves, ignore Ctrl-C.
    words = ["env", "--default-signal=INT", sys.executable, "-m", "linkforge_compile", "collisions", spec.name]
    process = subprocess.Popen(
        [*words, "--samples", "9000000", "--jobs", "2"],
        cwd=spec.parent,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        for one in processes_in(process.pid):
            os.kill(one, signal.SIGKILL)
        process.communicate()


def has_workers(group: int) -> bool:
    """Whether there are the command, a tracker of resources, and two workers, which still import their modules."""
    return len(processes_in(group)) == 4


def wait_until(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def processes_in(group: int) -> list[int]:
    """Return the processes of a group that run, those without a parent that waits for them as well."""
    found: list[int] = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            # The name of the program, in parentheses, may have spaces.
            state, _, number = path.read_text().rpartition(")")[2].split()[:3]
        except OSError:  # it has ended
            continue
        if int(number) == group and state not in "ZX":
            found.append(int(path.parent.name))
    return found
