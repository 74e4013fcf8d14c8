"""Validate the tree of a spec and the places of its expressions; cache faultless trees."""

from __future__ import annotations

import re
from functools import cached_property
from pathlib import Path
from threading import Lock
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.schema import validate
from linkforge_compile.schema.json_schema import WORDS
from linkforge_compile.schema.misplaced_expressions import check_expressions
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression, read

MAX_CACHED_CHARACTERS = 500_000
"""How many characters of text the cached trees may have together; the trees need up to 100 MB."""

_CacheKey: TypeAlias = tuple[str, Path | None, int]
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
        self._trees: dict[_CacheKey, _CachedTree] = {}
        self._characters = 0
        self._lock = Lock()

    def find(self, source: SourceFile) -> _CachedTree | None:
        """Return the cached tree of the same text at the same place, included by the same file."""
        with self._lock:
            cached = self._trees.get(_cache_key(source))
        is_same = cached and (cached.source.text, cached.source.included) == (source.text, source.included)
        return cached if is_same else None

    def add(self, cached: _CachedTree) -> None:
        """Cache a tree in the place of the one before; drop the oldest if there are too many."""
        with self._lock:
            self._drop(_cache_key(cached.source))
            if len(cached.source.text) > MAX_CACHED_CHARACTERS:
                return
            self._trees[_cache_key(cached.source)] = cached
            self._characters += len(cached.source.text)
            while self._characters > MAX_CACHED_CHARACTERS:
                self._drop(next(iter(self._trees)))

    def _drop(self, place: _CacheKey) -> None:
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
    tree = check_expressions(source.text, tree, watched)
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


def _cache_key(source: SourceFile) -> _CacheKey:
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


_FOR = re.compile(r"for\b")  # a word, because "effort" is in nearly every robot
_COMPUTED_MARKERS = ("$(", "\\", *(word for word in WORDS if word != "for"))  # a backslash may escape any of them


def may_compute(text: str) -> bool:
    """Return False if a spec with this YAML text has neither expressions nor `for`, `when` or `value`."""
    return any(marker in text for marker in _COMPUTED_MARKERS) or _FOR.search(text) is not None


class ExpressionScan:
    """Tell which parts of a tree hold expressions or repetition; visits each node once."""

    def __init__(self) -> None:
        self._computed: dict[YamlList | YamlMap, bool] = {}

    def is_computed(self, node: YamlNode) -> bool:
        """Whether a node or anything in it, keys included, holds an expression or a word of repetition."""
        if isinstance(node, YamlScalar):
            return has_expression(node.text)
        if isinstance(node, YamlFault):
            return False
        found = self._computed.get(node)
        if found is None:
            found = any(map(self.is_computed, node.items)) if isinstance(node, YamlList) else self._in_map(node)
            self._computed[node] = found
        return found

    def _in_map(self, node: YamlMap) -> bool:
        return any(
            name in WORDS or has_expression(name) or self.is_computed(entry.value)
            for name, entry in node.entries.items()
        )
