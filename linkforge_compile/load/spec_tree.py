"""Read the tree of a spec: validate it, merge the files of its `include`, and cache faultless trees."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from threading import Lock
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import (
    ENTRY_IN_TWO_FILES,
    INCLUDE_CYCLE,
    INCLUDE_NOT_PLAIN,
    INCLUDE_TOO_DEEP,
    INCLUDED_TWICE,
    SET_BY_MAIN_FILE,
    TOO_MANY_INCLUDES,
)
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.paths import follow
from linkforge_compile.roots import identity
from linkforge_compile.schema import validate
from linkforge_compile.schema.json_schema import WORDS
from linkforge_compile.schema.misplaced_expressions import check_expressions
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import (
    YamlEntry,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    has_expression,
    is_null,
    read,
)

MAX_CACHED_CHARACTERS = 500_000
"""How many characters of text the cached trees may have together; the trees need up to 100 MB."""

MAX_DEPTH = 20
MAX_INCLUDES = 200
"""How many files one spec may include, directly and through other included files."""

_MAIN_FILE_ONLY = ("name", "version", "description", "mount", "variants")
_PER_FILE = ("linkforge", "include")
_NESTED_SECTIONS = ("group_states", "disabled_collisions", "enabled_collisions", "joint_properties")

Place: TypeAlias = tuple[str, Path | None, int]
"""The name of a file, its path, and how many files were read before it."""


class _CachedTree:
    """A text without faults, its tree, and how many values of the budget it took."""

    def __init__(self, source: SourceFile, tree: YamlMap, values: int) -> None:
        self.source, self.tree, self.values = source, tree, values
        self.place: Place = source.place

    @cached_property
    def is_computed(self) -> bool:
        return _is_computed(self.source, self.tree)


class _TreeCache:
    """The latest faultless tree of each place, the oldest dropped first; safe to share between threads."""

    def __init__(self) -> None:
        self._trees: dict[Place, _CachedTree] = {}
        self._characters = 0
        self._lock = Lock()

    def find(self, source: SourceFile) -> _CachedTree | None:
        """Return the cached tree of the same text at the same place, included by the same file."""
        with self._lock:
            cached = self._trees.get(source.place)
        return cached if cached and cached.source.has_text_of(source) else None

    def add(self, cached: _CachedTree) -> None:
        """Cache a tree in the place of the one before; drop the oldest if there are too many."""
        with self._lock:
            self._drop(cached.place)
            if len(cached.source.text) > MAX_CACHED_CHARACTERS:
                return
            self._trees[cached.place] = cached
            self._characters += len(cached.source.text)
            while self._characters > MAX_CACHED_CHARACTERS:
                self._drop(next(iter(self._trees)))

    def _drop(self, place: Place) -> None:
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
    values_before, faults = budget.left(Limit.VALUES), Diagnostics()
    try:
        tree = read(source, faults, budget)
        if tree is not None:
            tree = validate(tree, faults, is_included=source.included is not None)
            tree = check_expressions(source.text, tree, faults)
    finally:
        sink.report_all(faults)
    if tree is not None and not any(True for _ in faults):
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


ReadIncluded = Callable[[Path, YamlScalar], tuple[SourceFile, YamlMap] | None]
"""Reads the file at a path for an item of `include`; None after a reported error."""


class ComposedFile(NamedTuple):
    """A spec file with all that it includes.

    `include_paths` has, for each included file, the paths that lead to it as written: that of the main file's
    `include`, then that of the file it names, and so on. If a file could not be read, `include` of the tree is a
    YamlFault. `renamed` is that of `SpecFile`.
    """

    file: SourceFile
    tree: YamlMap
    include_paths: Mapping[SourceFile, tuple[str, ...]] = MappingProxyType({})
    renamed: Mapping[str, str] = MappingProxyType({})


def follow_includes(folder: Path, paths: tuple[str, ...]) -> Path:
    """Return where a chain of include paths leads from the folder of the main file."""
    path = folder
    for step in paths:
        path = follow(folder, step)
        folder = path.parent
    return path


def compose(
    file: SourceFile, tree: YamlMap, folder: Path | None, read: ReadIncluded, sink: Diagnostics
) -> ComposedFile:
    """Merge what a file includes, recursively, into its tree; `folder` is where its relative paths start."""
    composer = _Composer(file, tree, read, sink)
    composer.add_includes(tree, _Chain((file,), folder))
    return composer.result(file)


class _Chain(NamedTuple):
    """The files from the main file to one that includes others, and the folder and include paths of the last."""

    files: tuple[SourceFile, ...]
    folder: Path | None
    include_paths: tuple[str, ...] = ()


class _Composer:
    """Builds one ComposedFile."""

    def __init__(self, file: SourceFile, tree: YamlMap, read: ReadIncluded, sink: Diagnostics) -> None:
        self._tree = tree
        self._read = read
        self._sink = sink
        self._include_paths: dict[SourceFile, tuple[str, ...]] = {}
        self._known = {identity(file.path): file} if file.path else {}
        self._is_limit_reported = False
        self._is_incomplete = isinstance(tree.get("include"), YamlFault)

    def result(self, file: SourceFile) -> ComposedFile:
        entries = dict(self._tree.entries)
        include = entries.pop("include")
        if self._is_incomplete:
            entries["include"] = YamlEntry(include.key, YamlFault(include.value.span))
        return ComposedFile(file, YamlMap(entries, self._tree.span), self._include_paths)

    def add_includes(self, tree: YamlMap, chain: _Chain) -> None:
        """Merge the includes of the last file of a chain, in the order written."""
        section = tree.get("include")
        for item in section if isinstance(section, YamlList) else ():
            if isinstance(item, YamlScalar) and self._may_follow(item, chain):
                self._include(item, chain)
            else:
                self._is_incomplete = True

    def _include(self, item: YamlScalar, chain: _Chain) -> None:
        path = follow(chain.folder or Path(), item.text)
        included = None if self._is_known(path, item, chain) else self._read(path, item)
        if included is None:
            self._is_incomplete = True
            return
        file, tree = included
        include_paths = (*chain.include_paths, item.text)
        self._known[identity(path)], self._include_paths[file] = file, include_paths
        self._is_incomplete |= isinstance(tree.get("include"), YamlFault)
        self._tree = _merge_maps(self._tree, self._mergeable_part(tree), (), self._sink)
        self.add_includes(tree, _Chain((*chain.files, file), path.parent, include_paths))

    def _is_known(self, path: Path, item: YamlScalar, chain: _Chain) -> bool:
        """Whether the file was included before, which is reported."""
        known = self._known.get(identity(path))
        if known is None:
            return False
        if known in chain.files:
            names = [Path(file.name).name for file in (*chain.files[chain.files.index(known) :], known)]
            self._sink.report(INCLUDE_CYCLE.at(item.span, path=" → ".join(names)))
        else:
            notes = [Note("included here first", known.included)]
            self._sink.report(INCLUDED_TWICE.at(item.span, path=item.text, notes=notes))
        return True

    def _may_follow(self, item: YamlScalar, chain: _Chain) -> bool:
        """Whether an item is a usable path within the limits; reports why not."""
        reason = _why_not_plain(item.text, chain.folder)
        if reason:
            self._sink.report(INCLUDE_NOT_PLAIN.at(item.span, path=item.text, reason=reason))
        elif len(chain.files) > MAX_DEPTH:
            self._sink.report(INCLUDE_TOO_DEEP.at(item.span, limit=MAX_DEPTH))
        elif len(self._include_paths) < MAX_INCLUDES:
            return True
        elif not self._is_limit_reported:
            self._is_limit_reported = True
            self._sink.report(TOO_MANY_INCLUDES.at(item.span, limit=MAX_INCLUDES))
        return False

    def _mergeable_part(self, tree: YamlMap) -> YamlMap:
        """Return an included tree without the keys that belong to the main file, which are reported, or to each."""
        entries: dict[str, YamlEntry] = {}
        for name, entry in tree.entries.items():
            if name in _MAIN_FILE_ONLY:
                self._sink.report(SET_BY_MAIN_FILE.at(entry.key.span, key=name))
            elif name not in _PER_FILE and not name.startswith("x-"):
                entries[name] = entry
        return YamlMap(entries, tree.span)


def _merge_maps(first: YamlMap, second: YamlMap, path: tuple[str, ...], sink: Diagnostics) -> YamlMap:
    """Return the entries of two maps of entries, those of the first in front; duplicates are reported."""
    entries = dict(first.entries)
    for entry in second:
        ours, inner = entries.get(entry.name), (*path, entry.name)
        if ours is None or (_is_section(inner) and is_null(ours.value)):
            entries[entry.name] = entry
        elif not (_is_section(inner) and is_null(entry.value)):
            entries[entry.name] = YamlEntry(ours.key, _merge_entries(ours, entry, inner, sink))
    return YamlMap(entries, first.span)


def _merge_entries(first: YamlEntry, second: YamlEntry, path: tuple[str, ...], sink: Diagnostics) -> YamlNode:
    ours, theirs = first.value, second.value
    if isinstance(ours, YamlFault) or isinstance(theirs, YamlFault):
        return YamlFault(ours.span)
    if _is_section(path) and isinstance(ours, YamlMap) and isinstance(theirs, YamlMap):
        return _merge_maps(ours, theirs, path, sink)
    if path == ("gazebo",) or (isinstance(ours, YamlList) and isinstance(theirs, YamlList)):
        # A single block may be written for a list of one.
        both = [node.items if isinstance(node, YamlList) else (node,) for node in (ours, theirs)]
        return YamlList((*both[0], *both[1]), ours.span)
    *sections, name = path
    entry = f"'{name}' of '{sections[-1]}'" if sections else f"'{name}'"
    notes = [Note("the other is here", first.key.span)]
    sink.report(ENTRY_IN_TWO_FILES.at(second.key.span, entry=entry, notes=notes))
    return ours


def _is_section(path: tuple[str, ...]) -> bool:
    """Whether the map at a path of keys is a section, whose entries may come from several files."""
    match path:
        case () | (_,) | ("semantic", _):
            return path not in {("extra",), ("gazebo",)}
        case ("semantic", section, _):
            return section in _NESTED_SECTIONS
    return False


def _why_not_plain(path: str, folder: Path | None) -> str | None:
    if has_expression(path):
        return "without expressions"
    if "://" in path:
        return "relative to this one"
    if not path or "\0" in path:
        return "and this is none"
    if folder is None and not Path(path).is_absolute():
        return "and this text is not in a folder that it could be relative to"
    return None
