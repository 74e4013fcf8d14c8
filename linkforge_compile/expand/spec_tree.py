"""Turn a spec's text into its validated tree; faultless trees are cached for later compiles in the same process."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from threading import Lock
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.expand.syntax_markers import ExpressionScan, may_compute, may_need_context_check
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.schema import validate
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlMap, read

MAX_CACHED_CHARACTERS = 500_000
"""How many characters of text the cached trees may have together; their trees take up to 100 MB."""

_Place: TypeAlias = tuple[str, Path | None, int]
"""The name of a file, its path, and how many files were read before it."""


class _CachedTree:
    """A text without faults, its tree, and how many values of the budget it took."""

    def __init__(self, source: SourceFile, tree: YamlMap, values: int) -> None:
        self.source, self.tree, self.values = source, tree, values

    @cached_property
    def is_computed(self) -> bool:
        return _is_computed(self.source, self.tree)


class _TreeCache:
    """The latest faultless tree of each place, the oldest dropped first; safe to share between threads."""

    def __init__(self) -> None:
        self._trees: dict[_Place, _CachedTree] = {}
        self._characters = 0
        self._lock = Lock()

    def find(self, source: SourceFile) -> _CachedTree | None:
        """Return the cached tree of the same text at the same place, included by the same file."""
        with self._lock:
            cached = self._trees.get(_place(source))
        is_same = cached and (cached.source.text, cached.source.included) == (source.text, source.included)
        return cached if is_same else None

    def add(self, cached: _CachedTree) -> None:
        """Cache a tree in the place of the one before; drop the oldest if there are too many."""
        with self._lock:
            self._drop(_place(cached.source))
            if len(cached.source.text) > MAX_CACHED_CHARACTERS:
                return
            self._trees[_place(cached.source)] = cached
            self._characters += len(cached.source.text)
            while self._characters > MAX_CACHED_CHARACTERS:
                self._drop(next(iter(self._trees)))

    def _drop(self, place: _Place) -> None:
        dropped = self._trees.pop(place, None)
        self._characters -= len(dropped.source.text) if dropped else 0


_cache = _TreeCache()


def cached_source(source: SourceFile) -> SourceFile:
    """Return the SourceFile of an earlier compile for the same text at the same place, whose tree is cached."""
    cached = _cache.find(source)
    return cached.source if cached else source


def read_tree(source: SourceFile, sink: Diagnostics, budget: Budget) -> YamlMap | None:
    """Read and validate a spec; its faulty parts are reported and left out. None if it cannot be read at all."""
    cached = _cache.find(source)
    if cached and cached.source is source and cached.values <= budget.left(Limit.VALUES):
        budget.spend(Limit.VALUES, cached.values, source.whole)
        return cached.tree
    values_before, watched = budget.left(Limit.VALUES), _WatchedSink(sink)
    tree = read(source, watched, budget)
    if tree is None:
        return None
    tree = validate(tree, watched, is_included=source.included is not None)
    if may_need_context_check(source.text):
        from linkforge_compile.expand.expression_context import check_context

        tree = check_context(tree, watched)
    if watched.is_silent:
        _cache.add(_CachedTree(source, tree, values_before - budget.left(Limit.VALUES)))
    return tree


def is_computed(source: SourceFile, tree: YamlMap) -> bool:
    """Whether anything in a file but its `x-` keys is computed or repeated; cached with the tree."""
    cached = _cache.find(source)
    return cached.is_computed if cached and cached.tree is tree else _is_computed(source, tree)


def _is_computed(source: SourceFile, tree: YamlMap) -> bool:
    if not (source.is_xml or may_compute(source.text)):
        return False
    own = {name: entry for name, entry in tree.entries.items() if not name.startswith("x-")}
    return ExpressionScan().is_computed(YamlMap(own, tree.span))


def _place(source: SourceFile) -> _Place:
    return source.name, source.path, source.order


class _WatchedSink(Diagnostics):
    """Pass all diagnostics on, and remember whether there was one."""

    def __init__(self, sink: Diagnostics) -> None:
        super().__init__()
        self.is_silent = True
        self._sink = sink

    def report(self, diagnostic: Diagnostic) -> None:
        self.is_silent = False
        self._sink.report(diagnostic)
