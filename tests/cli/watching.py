"""Runs a command that waits for changes of files; each step of a test is done where the command would sleep."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from linkforge_compile.cli.main import main

Deed = Callable[[Path], object]


def sets(name: str, text: str) -> Deed:
    return lambda folder: (folder / name).write_text(text)


def removes(name: str) -> Deed:
    return lambda folder: (folder / name).unlink()


def nothing(folder: Path) -> None:
    """Let a poll find no change."""


def run_with(
    deeds: tuple[Deed, ...],
    words: tuple[str, ...],
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> list[str]:
    """Run a command while the steps are done, each one when the last is seen; return the printed lines."""
    left: Iterator[Deed] = iter(deeds)

    def pause(seconds: float) -> None:
        # The long pause is that before a look, the short one that for a change to be whole.
        if seconds < 0.1:
            return
        deed = next(left, None)
        if deed is None:
            raise KeyboardInterrupt
        deed(folder)

    monkeypatch.setattr(time, "sleep", pause)
    assert main(words) == 130
    return capfd.readouterr().err.splitlines()
