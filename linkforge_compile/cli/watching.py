"""Runs a command again whenever one of the files changes that it read or looked for."""

from __future__ import annotations

import argparse
import gc
import time
from collections.abc import Callable, Collection, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple, NoReturn

from linkforge_compile.cli import UsageError
from linkforge_compile.cli.reports import print_line, print_status
from linkforge_compile.file_watcher import FileWatcher

_POLL_INTERVAL = 0.3
"""Time between two polls of the files [s]."""

_SETTLE_TIME = 0.05
"""Time without another change before the next run [s], because an editor may write files in several steps."""


class Watched(NamedTuple):
    """What a run depends on.

    `files` are named to the user. `poll` returns those that have changed since its last call, and may return others,
    and what else has changed, by its name. `pause` sleeps for a time [s], or less if `poll` has news; None for
    time.sleep. The deletion of one of the `outputs` is a reason for another run too.
    """

    files: Sequence[Path]
    poll: Callable[[], tuple[Path | str, ...]]
    outputs: Sequence[Path] = ()
    pause: Callable[[float], None] | None = None


def repeat_on_changes(command: str, run: Callable[[], Watched], arguments: argparse.Namespace) -> NoReturn:
    """Call `run`, and again after each change of what it returns, until Ctrl-C.

    Raises:
        UsageError: by the first call. One of a later call is reported, because the user may correct its cause.

    """
    watched = run()
    while True:
        # The command's thresholds are those of a short process: the robots of former runs would add up.
        gc.collect()
        print_status(f"watching {_listed(watched.files)}; Ctrl-C ends", arguments)
        changed, gone = _wait(watched)
        if changed:
            print_status(f"{_listed(changed)} changed", arguments)
        if gone:
            print_status(f"{_listed(gone)} {'is' if len(gone) == 1 else 'are'} gone", arguments)
        try:
            watched = run()
        except UsageError as error:
            print_line(f"linkforge {command}: {error}")
            watched = watched._replace(outputs=())


def _wait(watched: Watched) -> tuple[tuple[Path | str, ...], tuple[Path, ...]]:
    """Wait for what changes or deleted outputs, then until no other file changes; return both."""
    changed: tuple[Path | str, ...] = ()
    gone: tuple[Path, ...] = ()
    pause = watched.pause or time.sleep
    while not changed and not gone:
        pause(_POLL_INTERVAL)
        changed = watched.poll()
        gone = tuple(path for path in watched.outputs if not path.exists())
    while True:
        time.sleep(_SETTLE_TIME)
        more = watched.poll()
        changed = tuple(dict.fromkeys((*changed, *more)))
        if not any(isinstance(one, Path) for one in more):
            return changed, gone


def _listed(names: Sequence[Path | str]) -> str:
    first, *others = names
    return f"{_shown(first)} and {len(others)} more" if others else _shown(first)


def _shown(name: Path | str) -> str:
    """Return the name of a file as seen from the working folder, if it is below that."""
    folder = Path.cwd()
    return str(name.relative_to(folder) if isinstance(name, Path) and name.is_relative_to(folder) else name)


class SpecSearch:
    """Detects specs that appear in folders or leave them, without a search while no folder changes."""

    def __init__(self, find_folders: Callable[[], Iterable[Path]], find_specs: Callable[[], Collection[str]]) -> None:
        self._find_folders, self._find_specs = find_folders, find_specs
        # First, because it reports too many folders as an error of usage.
        self._specs = frozenset(find_specs())
        self._folders = FileWatcher(find_folders())

    def poll(self) -> tuple[Path, ...]:
        """Return the specs that are new or gone since the last poll; the folders, where no search is possible."""
        changed, began = self._folders.poll(), time.time_ns()
        if not changed:
            return ()
        try:
            specs = frozenset(self._find_specs())
        except UsageError:
            return changed
        self._folders.track(self._find_folders(), began)
        before, self._specs = self._specs, specs
        return tuple(map(Path, sorted(specs ^ before)))
