"""How the benchmarks take time: medians of runs that take turns, in seconds of the processor.

Turns, so that a busy machine slows all sides alike; the processor's time, since what waits for others is not ours.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from statistics import median
from time import process_time
from typing import NamedTuple, TypeVar

L = TypeVar("L")
T = TypeVar("T")


class Usage(NamedTuple):
    """What a whole process took: its time in user and system mode [s], and its peak memory [MB]."""

    seconds: float
    megabytes: float


def turns(rounds: int, runs: Mapping[L, Callable[[], T]]) -> dict[L, list[T]]:
    """Return what each run answers on its turns, after a first one that does not count."""
    taken: dict[L, list[T]] = {label: [] for label in runs}
    for turn in range(rounds + 1):
        for label, run in runs.items():
            one = run()
            if turn:
                taken[label].append(one)
    return taken


def medians(rounds: int, runs: Mapping[str, Callable[[], float]]) -> dict[str, float]:
    """Return the median of what each run answers on its turns."""
    return {label: median(values) for label, values in turns(rounds, runs).items()}


def seconds_of(action: Callable[[], object]) -> float:
    """Return what an action takes in this process [s]."""
    start = process_time()
    action()
    return process_time() - start


def python(*arguments: str) -> Usage:
    """Run Python as a whole process, as installed packages run: from bytecode, which the first run leaves."""
    return _process([sys.executable, *arguments])


def process(*arguments: str) -> Callable[[], float]:
    """Return what runs Python as a whole process, and answers with its time [s]."""
    return lambda: python(*arguments).seconds


def _process(command: Sequence[str]) -> Usage:
    # A process takes over the peak memory of the one that started it, so a small one starts it.
    done = subprocess.run(
        [sys.executable, "-S", _USAGE, *command], capture_output=True, text=True, env=_environment(), check=False
    )
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}\n{done.stderr}")
    seconds, peak = map(float, done.stdout.split())
    # Linux counts in kilobytes, macOS in bytes.
    return Usage(seconds, peak / (1e6 if sys.platform == "darwin" else 1e3))


_USAGE = str(Path(__file__).with_name("usage.py"))


@cache
def _environment() -> dict[str, str]:
    """Return our environment with bytecode on, which installers write, and bounds that admit 10,000 links."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, "PYTHONPYCACHEPREFIX": _bytecode().name, "LINKFORGE_LIMITS": "10"}


@cache
def _bytecode() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="bytecode")
