"""`include`: files of the same schema laid into one, every entry with the place where its own file has it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Note
from linkforge_compile.diagnostics.codes.files import (
    ENTRY_IN_TWO_FILES,
    INCLUDE_CIRCLE,
    INCLUDE_NOT_PLAIN,
    INCLUDE_TOO_DEEP,
    INCLUDED_TWICE,
    SAID_BY_MAIN_FILE,
    TOO_MANY_INCLUDES,
)
from linkforge_compile.expand.paths import follow
from linkforge_compile.expand.whole import Whole
from linkforge_compile.roots import identity
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
)

MAX_DEPTH = 20
MAX_INCLUDES = 200
"""How many files one file may include, those of its includes among them."""

_OF_THE_MAIN_FILE = ("name", "version", "description", "mount", "variants")
_OF_EACH_FILE = ("linkforge", "include")
_NESTED_SECTIONS = ("group_states", "disabled_collisions", "enabled_collisions", "joint_properties")

ReadIncluded = Callable[[Path, YamlScalar], tuple[SourceFile, YamlMap] | None]
"""Reads the file at a path for an item of `include`; None where it cannot be had, which it reports."""


def lay_together(file: SourceFile, tree: YamlMap, folder: Path | None, read: ReadIncluded, sink: Diagnostics) -> Whole:
    """Lay what a file includes, and what that includes, into its tree; `folder` is where its paths start."""
    laying = _Laying(file, tree, read, sink)
    laying.add_includes(tree, _Chain((file,), folder))
    return Whole(file, laying.whole(), laying.ways)


class _Chain(NamedTuple):
    """The files between the main file and one that includes, and where the paths of the last one start."""

    files: tuple[SourceFile, ...]
    folder: Path | None
    way: tuple[str, ...] = ()


class _Laying:
    """One main file while others are laid into it."""

    def __init__(self, file: SourceFile, tree: YamlMap, read: ReadIncluded, sink: Diagnostics) -> None:
        self.ways: dict[SourceFile, tuple[str, ...]] = {}
        self._tree = tree
        self._read = read
        self._sink = sink
        self._known = {identity(file.path): file} if file.path else {}
        self._is_full = False
        self._lacks = isinstance(tree.get("include"), YamlFault)

    def whole(self) -> YamlMap:
        """Return the tree, whose `include` is a fault where any of the files is missing."""
        entries = dict(self._tree.entries)
        include = entries.pop("include")
        if self._lacks:
            entries["include"] = YamlEntry(include.key, YamlFault(include.value.span))
        return YamlMap(entries, self._tree.span)

    def add_includes(self, tree: YamlMap, chain: _Chain) -> None:
        """Lay the includes of one file of a chain into the whole, in the order written."""
        section = tree.get("include")
        for item in section if isinstance(section, YamlList) else ():
            if isinstance(item, YamlScalar) and self._is_bounded(item, chain):
                self._include(item, chain)
            else:
                self._lacks = True

    def _include(self, item: YamlScalar, chain: _Chain) -> None:
        path = follow(chain.folder or Path(), item.text)
        included = None if self._is_known(path, item, chain) else self._read(path, item)
        if included is None:
            self._lacks = True
            return
        file, tree = included
        way = (*chain.way, item.text)
        self._known[identity(path)], self.ways[file] = file, way
        self._lacks |= isinstance(tree.get("include"), YamlFault)
        own = self._without_the_main_files(tree)
        self._tree = _laid(self._tree, own, (), self._sink)
        self.add_includes(tree, _Chain((*chain.files, file), path.parent, way))

    def _is_known(self, path: Path, item: YamlScalar, chain: _Chain) -> bool:
        """Whether the file is laid in already, which is reported."""
        known = self._known.get(identity(path))
        if known is None:
            return False
        if known in chain.files:
            self._sink.report(_circle(chain.files[chain.files.index(known) :], item))
        else:
            notes = [Note("included here first", known.included)]
            self._sink.report(INCLUDED_TWICE.at(item.span, path=item.text, notes=notes))
        return True

    def _is_bounded(self, item: YamlScalar, chain: _Chain) -> bool:
        """Whether an item is a path that may be followed; reports why not."""
        reason = _why_not_plain(item.text, chain.folder)
        if reason:
            self._sink.report(INCLUDE_NOT_PLAIN.at(item.span, path=item.text, reason=reason))
        elif len(chain.files) > MAX_DEPTH:
            self._sink.report(INCLUDE_TOO_DEEP.at(item.span, limit=MAX_DEPTH))
        elif len(self.ways) < MAX_INCLUDES:
            return True
        elif not self._is_full:
            # Once is enough: every file behind this one is one too many as well.
            self._is_full = True
            self._sink.report(TOO_MANY_INCLUDES.at(item.span, limit=MAX_INCLUDES))
        return False

    def _without_the_main_files(self, tree: YamlMap) -> YamlMap:
        """Return an included tree without what only the main file says, which is reported, and what each says."""
        kept: dict[str, YamlEntry] = {}
        for name, entry in tree.entries.items():
            if name in _OF_THE_MAIN_FILE:
                self._sink.report(SAID_BY_MAIN_FILE.at(entry.key.span, key=name))
            elif name not in _OF_EACH_FILE and not name.startswith("x-"):
                kept[name] = entry
        return YamlMap(kept, tree.span)


def _laid(first: YamlMap, second: YamlMap, path: tuple[str, ...], sink: Diagnostics) -> YamlMap:
    """Return the entries of two maps that hold entries, the first's first; one that both have is reported."""
    entries = dict(first.entries)
    for entry in second:
        ours, inner = entries.get(entry.name), (*path, entry.name)
        if ours is None or (_holds_entries(inner) and is_null(ours.value)):
            entries[entry.name] = entry
        elif not (_holds_entries(inner) and is_null(entry.value)):
            entries[entry.name] = YamlEntry(ours.key, _both(ours, entry, inner, sink))
    return YamlMap(entries, first.span)


def _both(first: YamlEntry, second: YamlEntry, path: tuple[str, ...], sink: Diagnostics) -> YamlNode:
    ours, theirs = first.value, second.value
    if isinstance(ours, YamlFault) or isinstance(theirs, YamlFault):
        return YamlFault(ours.span)
    if _holds_entries(path) and isinstance(ours, YamlMap) and isinstance(theirs, YamlMap):
        return _laid(ours, theirs, path, sink)
    if path == ("gazebo",) or (isinstance(ours, YamlList) and isinstance(theirs, YamlList)):
        return YamlList((*_items(ours), *_items(theirs)), ours.span)
    *sections, name = path
    entry = f"'{name}' of '{sections[-1]}'" if sections else f"'{name}'"
    notes = [Note("the other is here", first.key.span)]
    sink.report(ENTRY_IN_TWO_FILES.at(second.key.span, entry=entry, notes=notes))
    return ours


def _holds_entries(path: tuple[str, ...]) -> bool:
    """Whether the map at a path of keys is a section, whose entries may come from several files."""
    match path:
        case () | (_,) | ("semantic", _):
            return path not in {("extra",), ("gazebo",)}
        case ("semantic", section, _):
            return section in _NESTED_SECTIONS
    return False


def _items(node: YamlNode) -> Iterator[YamlNode]:
    """Yield the items of a list, or the one thing that stands for a list of one."""
    yield from node if isinstance(node, YamlList) else (node,)


def _why_not_plain(path: str, folder: Path | None) -> str | None:
    if has_expression(path):
        return "without expressions"
    if "://" in path:
        return "relative to this one"
    if not path or "\0" in path:
        return "and this is none"
    if folder is None and not Path(path).is_absolute():
        return "and this text lies in no folder that it could be relative to"
    return None


def _circle(files: tuple[SourceFile, ...], item: YamlScalar) -> Diagnostic:
    names = [Path(file.name).name for file in files]
    return INCLUDE_CIRCLE.at(item.span, path=" → ".join([*names, names[0]]))
