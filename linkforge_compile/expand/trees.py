"""From a spec's text to its validated tree; a text without a fault is remembered, for who compiles it again.

Whoever compiles a robot twice in one process, as launch files, editors and watchers do, changes one file of it at most.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from threading import Lock
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.expand.changing import Changing, may_change
from linkforge_compile.expand.telltale import SIGNS, TELLTALE
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.schema import validate
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlMap, read

MOST_REMEMBERED = 500_000
"""How many characters of texts are remembered together: their trees take up to 100 MB."""

_Place: TypeAlias = tuple[str, Path | None, int]
"""The name of a file, its path, and how many were read before it."""


class _Read:
    """A text that was read without a fault, its tree, and how much of the budget it took."""

    def __init__(self, source: SourceFile, tree: YamlMap, values: int) -> None:
        self.source, self.tree, self.values = source, tree, values

    @cached_property
    def is_computed(self) -> bool:
        return _is_computed(self.source, self.tree)


class _Whole:
    """A file that stands by itself, and what was read of it and of the files that it includes.

    A part knows the very file that included it, so none of them outlives the text of that one.
    """

    def __init__(self, file: SourceFile) -> None:
        self.file = file
        self.characters = len(file.text)
        self.read: dict[_Place, _Read] = {}

    def put(self, one: _Read) -> None:
        before = self.read.get(_place(one.source))
        self.read[_place(one.source)] = one
        if one.source is not self.file:
            self.characters += len(one.source.text) - (len(before.source.text) if before else 0)


class _Memory:
    """The trees of faultless texts, one a place, as many as there is room for; threads may share it."""

    def __init__(self) -> None:
        self._wholes: dict[_Place, _Whole] = {}
        self._characters = 0
        self._lock = Lock()

    def find(self, source: SourceFile) -> _Read | None:
        """Return what was read of a text that says the same at the same place."""
        with self._lock:
            whole = self._wholes.get(_place(source.outermost))
            known = whole.read.get(_place(source)) if whole else None
        is_same = known and (known.source.text, known.source.included) == (source.text, source.included)
        return known if is_same else None

    def keep(self, one: _Read) -> None:
        """Remember one more; what was remembered first makes room for it."""
        file = one.source.outermost
        with self._lock:
            whole = self._wholes.pop(_place(file), None)
            self._characters -= whole.characters if whole else 0
            if whole is None or whole.file is not file:
                whole = _Whole(file)
            whole.put(one)
            if whole.characters > MOST_REMEMBERED:
                return
            self._wholes[_place(file)] = whole
            self._characters += whole.characters
            while self._characters > MOST_REMEMBERED:
                self._characters -= self._wholes.pop(next(iter(self._wholes))).characters


_faultless = _Memory()


def known_source(source: SourceFile) -> SourceFile:
    """Return the file of an earlier compile that says the same at the same place, so that its tree still holds."""
    known = _faultless.find(source)
    return known.source if known else source


def tree_of(source: SourceFile, sink: Diagnostics, budget: Budget) -> YamlMap | None:
    """Return the tree of a spec, without what is faulty in it, which is reported; None where it cannot be read."""
    known = _faultless.find(source)
    if known and known.source is source and known.values <= budget.left(Limit.VALUES):
        budget.spend(Limit.VALUES, known.values, source.whole)
        return known.tree
    before, watched = budget.left(Limit.VALUES), _Watched(sink)
    tree = read(source, watched, budget)
    if tree is None:
        return None
    whole = validate(tree, watched, is_included=source.included is not None)
    # What is judged has one of these signs; the pattern is slow on a long text.
    if any(sign in source.text for sign in SIGNS) and TELLTALE.search(source.text):
        from linkforge_compile.expand.places import judge_places

        whole = judge_places(whole, watched)
    if watched.is_silent:
        _faultless.keep(_Read(source, whole, before - budget.left(Limit.VALUES)))
    return whole


def is_computed(source: SourceFile, tree: YamlMap) -> bool:
    """Whether what a file says is computed or repeated, its author's own keys aside; remembered with its text."""
    known = _faultless.find(source)
    return known.is_computed if known and known.tree is tree else _is_computed(source, tree)


def _is_computed(source: SourceFile, tree: YamlMap) -> bool:
    # To look at the text takes no time at all beside the walk through its tree.
    if not (source.is_xml or may_change(source.text)):
        return False
    said = {name: entry for name, entry in tree.entries.items() if not name.startswith("x-")}
    return Changing().change(YamlMap(said, tree.span))


def _place(source: SourceFile) -> _Place:
    return source.name, source.path, source.order


class _Watched(Diagnostics):
    """Hands all faults on, and knows whether there was one."""

    def __init__(self, sink: Diagnostics) -> None:
        super().__init__()
        self.is_silent = True
        self._sink = sink

    def report(self, diagnostic: Diagnostic) -> None:
        self.is_silent = False
        self._sink.report(diagnostic)
