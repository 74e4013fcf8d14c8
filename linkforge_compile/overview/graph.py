"""The graph of a robot: its links, ordered so that those of a module are together, and the modules around them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import takewhile
from typing import NamedTuple, TypeAlias

from linkforge_compile.overview.tree import TreeRow

Path: TypeAlias = tuple[str, ...]
"""The names of a module and of those that it is in, the outermost first."""


class ModuleRun(NamedTuple):
    """Consecutive rows of one module, from the first to the last.

    `height` is how deeply runs are nested in it. A module has several runs if others are mounted between.
    """

    module: Path
    first: int
    last: int
    height: int
    is_continued: bool


class ModuleBox(NamedTuple):
    """A module with its own links, and the modules in it; the module of the robot itself has no name."""

    module: Path
    links: list[str]
    boxes: list[ModuleBox]

    @property
    def name(self) -> str:
        return self.module[-1] if self.module else ""


def order_by_module(rows: Sequence[TreeRow]) -> list[TreeRow]:
    """Return the rows of a tree depth first; at each link, branches to other modules come last."""
    below: list[list[int]] = [[] for _ in rows]
    around = [row.modules for row in rows]  # the innermost module that holds all of a branch
    path: list[int] = []
    for index, row in enumerate(rows):
        del path[row.depth :]
        if path:
            below[path[-1]].append(index)
        path.append(index)
    for index in reversed(range(len(rows))):
        for child in below[index]:
            around[index] = _common(around[index], around[child])
    ordered = []
    waiting = [index for index, row in reversed(list(enumerate(rows))) if not row.depth]
    while waiting:
        index = waiting.pop()
        ordered.append(rows[index])
        own = rows[index].modules
        inside = sorted(below[index], key=lambda child: around[child][: len(own)] != own)
        waiting.extend(reversed(inside))
    return ordered


def _common(one: Path, other: Path) -> Path:
    return tuple(a for a, _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))


def module_runs(rows: Iterable[TreeRow]) -> list[ModuleRun]:
    """Return the runs of rows of each module, outer ones before those in them."""
    runs: list[ModuleRun] = []
    opened: list[int] = []  # places in `runs`
    seen: set[Path] = set()
    for index, row in enumerate(rows):
        kept = len(_common(row.modules, runs[opened[-1]].module if opened else ()))
        del opened[kept:]
        for length in range(kept + 1, len(row.modules) + 1):
            module = row.modules[:length]
            opened.append(len(runs))
            runs.append(ModuleRun(module, index, index, 1, module in seen))
            seen.add(module)
        for height, place in enumerate(reversed(opened), 1):
            runs[place] = runs[place]._replace(last=index, height=max(runs[place].height, height))
    return runs


def module_boxes(rows: Iterable[TreeRow]) -> ModuleBox:
    """Return the nested modules of a robot, with their links in the order of the rows."""
    whole = ModuleBox((), [], [])
    by_module = {whole.module: whole}
    for row in rows:
        for length in range(1, len(row.modules) + 1):
            module = row.modules[:length]
            if module not in by_module:
                by_module[module] = ModuleBox(module, [], [])
                by_module[module[:-1]].boxes.append(by_module[module])
        if not row.is_again:
            by_module[row.modules].links.append(row.link)
    return whole


def walk_boxes(box: ModuleBox) -> Iterator[ModuleBox]:
    """Yield a module and all modules in it."""
    yield box
    for inner in box.boxes:
        yield from walk_boxes(inner)
