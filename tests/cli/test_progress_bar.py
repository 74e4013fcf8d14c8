"""The progress of a long computation: a bar on a terminal, lines elsewhere."""

import argparse
import io

import pytest

from linkforge_compile.cli import progress_bar
from linkforge_compile.cli.progress_bar import ProgressBar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Let a test set the time [s]."""
    now = [0.0]
    monkeypatch.setattr(progress_bar, "monotonic", lambda: now[0])
    return now


def show(stream: io.StringIO, clock: list[float], monkeypatch: pytest.MonkeyPatch, *, quiet: bool = False) -> str:
    """Return what is printed for 1,000 units that take a second each 100."""
    monkeypatch.setattr("sys.stderr", stream)
    bar = ProgressBar(1000, "samples", argparse.Namespace(quiet=quiet, diagnostics="text"))
    for second in range(1, 6):
        clock[0] = float(second)
        bar.show(100 * second)
    bar.close()
    return stream.getvalue()


def test_a_terminal_has_a_bar_that_disappears(clock: list[float], monkeypatch: pytest.MonkeyPatch):
    frames = show(Terminal(), clock, monkeypatch).split("\r")
    assert frames[1] == "[###                           ] 100 of 1,000 samples\033[K"
    assert frames[5] == "[###############               ] 500 of 1,000 samples, 5 s left\033[K"
    assert frames[6:] == ["\033[K"]


def test_a_log_has_a_line_every_two_seconds(clock: list[float], monkeypatch: pytest.MonkeyPatch):
    assert show(io.StringIO(), clock, monkeypatch) == ("200 of 1,000 samples\n400 of 1,000 samples, 6 s left\n")


def test_the_start_of_processes_does_not_count(clock: list[float], monkeypatch: pytest.MonkeyPatch):
    """They take 10 s, then 10 units take a second; 40 are of an earlier run."""
    stream = io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)
    bar = ProgressBar(240, "robots", argparse.Namespace(quiet=False, diagnostics="text"))
    for time, done in ((0.1, 40), (10, 40), (11, 50), (12, 60), (13, 70), (14, 80)):
        clock[0] = time
        bar.show(done)
    lines = ["40 of 240 robots", "60 of 240 robots", "80 of 240 robots, 16 s left"]
    assert stream.getvalue().splitlines() == lines


def test_a_terminal_shows_what_is_waited_for_at_once(clock: list[float], monkeypatch: pytest.MonkeyPatch):
    stream = Terminal()
    monkeypatch.setattr("sys.stderr", stream)
    ProgressBar(240, "robots", argparse.Namespace(quiet=False, diagnostics="text")).show(0, "waiting for processes")
    assert stream.getvalue().endswith("] 0 of 240 robots, waiting for processes\033[K")


@pytest.mark.parametrize("stream", [io.StringIO, Terminal])
def test_quiet_shows_nothing(stream: type[io.StringIO], clock: list[float], monkeypatch: pytest.MonkeyPatch):
    assert show(stream(), clock, monkeypatch, quiet=True) == ""
