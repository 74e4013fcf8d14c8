"""The virtual environment in which the benchmarks run, and which they cannot write."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, NamedTuple

ROOT = Path(__file__).resolve().parents[1]
WORKER = Path(__file__).with_name("worker.py")

_READ_ONLY_MOUNT = 'mount --bind -o ro "$0" "$0" && exec "$@"'


class Description(NamedTuple):
    """The contents of an environment."""

    python: str
    packages: dict[str, str]
    """Versions by name."""
    compiled: dict[str, tuple[int, int]]
    """The number of modules with bytecode and of all modules, by package."""


class Sample(NamedTuple):
    """The cost of one run."""

    wall: float
    """[s]"""
    processor: float
    """[s]"""
    megabytes: float
    """Peak memory of a process; 0 for a run inside the worker."""


class Worker:
    """A process of the environment that runs an action for each request."""

    def __init__(self, process: subprocess.Popen[str], errors: IO[str]) -> None:
        self.process = process
        self.errors = errors

    def measure(self, *command: str) -> Sample:
        """Run the action once, or a process for the action `process`."""
        assert self.process.stdin
        assert self.process.stdout
        print(json.dumps(command), file=self.process.stdin, flush=True)
        answer = self.process.stdout.readline()
        if not answer:
            self.errors.seek(0)
            sys.exit(f"a benchmark failed:\n{self.errors.read()[-2000:]}")
        return Sample(*json.loads(answer))


class Environment:
    """A virtual environment that its processes cannot write."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.prefix = find_read_only_mount(folder)
        """The words before each command that make the folder read-only for it."""

    def program(self, name: str) -> str:
        return str(self.folder / "bin" / name)

    @property
    def protection(self) -> str:
        """How the folder is protected, for the description of a measurement."""
        if self.prefix:
            return "mounted read-only"
        if self.folder.stat().st_mode & 0o222:
            return "WRITABLE"
        return "read-only by permissions" + (", which do not bind root" if os.geteuid() == 0 else "")

    def describe(self) -> Description:
        """Return the versions and bytecode in the environment."""
        run = self.run(self.program("python"), "-P", str(WORKER), "describe")
        if run.returncode:
            sys.exit(f"{self.folder} is no environment with linkforge-compile, xacro and linkforge-core\n{run.stderr}")
        return Description(**json.loads(run.stdout))

    def run(self, *command: str) -> subprocess.CompletedProcess[str]:
        """Run a process without measuring it."""
        return subprocess.run(
            [*self.prefix, *command],
            env=_make_variables(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )

    @contextmanager
    def worker(self, *action: str) -> Iterator[Worker]:
        """Start a worker for an action of worker.py and its arguments."""
        command = [*self.prefix, self.program("python"), "-P", str(WORKER), *action]
        with (
            tempfile.TemporaryFile("w+") as errors,
            subprocess.Popen(
                command, env=_make_variables(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, text=True
            ) as process,
        ):
            yield Worker(process, errors)


def _make_variables() -> dict[str, str]:
    """Return the environment variables of a measured process."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "LINKFORGE", "PIP_NO"))}
    # 10,000 links exceed the default limits of a spec.
    return {**kept, "PYTHONDONTWRITEBYTECODE": "1", "LINKFORGE_LIMITS": "10"}


def find_read_only_mount(folder: Path) -> list[str]:
    """Return the words that run a command with a folder mounted read-only; () if the system refuses that."""
    if shutil.which("unshare"):
        for namespace in (("unshare", "--mount"), ("unshare", "--user", "--map-root-user", "--mount")):
            words = [*namespace, "sh", "-c", _READ_ONLY_MOUNT, str(folder)]
            if not subprocess.run(
                [*words, "test", "!", "-w", str(folder)], capture_output=True, check=False
            ).returncode:
                return words
    return []


def forbid_writing(folder: Path) -> None:
    for path in (folder, *folder.rglob("*")):
        if not path.is_symlink():
            path.chmod(path.stat().st_mode & ~0o222)


def make_environment(folder: Path, wheel: Path | None, extras: str = "xacro") -> None:
    """Create an environment with a wheel (default: built from this checkout), its extras and linkforge-core."""
    _report("making a virtual environment")
    _run_or_exit(sys.executable, "-m", "venv", str(folder))
    pip = (str(folder / "bin" / "python"), "-m", "pip", "--quiet", "--disable-pip-version-check")
    with tempfile.TemporaryDirectory() as built:
        if wheel is None:
            _report("building the wheel")
            _run_or_exit(*pip, "wheel", "--no-deps", "--wheel-dir", built, str(ROOT))
            (wheel,) = Path(built).glob("*.whl")
        _report("installing it, xacro and linkforge-core")
        _run_or_exit(*pip, "install", "--compile", f"{wheel.resolve()}[{extras}]", _find_core_requirement())
    if not find_read_only_mount(folder):
        forbid_writing(folder)


def _find_core_requirement() -> str:
    """Return the version of linkforge-core that our tests require."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return next(name for name in project["optional-dependencies"]["dev"] if name.startswith("linkforge-core"))


def _run_or_exit(*command: str) -> None:
    run = subprocess.run(command, env=_make_variables(), capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"{' '.join(command)}\n{run.stdout}{run.stderr}")


def _report(what: str) -> None:
    print(what, file=sys.stderr, flush=True)
