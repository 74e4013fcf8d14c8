"""From a spec's text to its validated tree; a text without a fault is remembered, for who compiles it again.

Whoever compiles a robot twice in one process, as launch files, editors and watchers do, changes one file of it at most.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple, TypeAlias

from linkforge_compile.bounds import Budget, Limit
from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.modules.places import judge_places
from linkforge_compile.schema import validate
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlMap, read

MOST_REMEMBERED = 500_000
"""How many characters of texts are remembered together: their trees take up to 100 MB."""

_Said: TypeAlias = tuple[str, str, Path | None, int, Span | None]


class _Read(NamedTuple):
    """A text that was read without a fault, its tree, and how much of the budget it took."""

    source: SourceFile
    tree: YamlMap
    values: int


_faultless: dict[_Said, _Read] = {}


def known_source(source: SourceFile) -> SourceFile:
    """Return the file of an earlier compile that says the same at the same place, so that its tree still holds."""
    known = _faultless.get(_said(source))
    return known.source if known else source


def tree_of(source: SourceFile, sink: Diagnostics, budget: Budget) -> YamlMap | None:
    """Return the tree of a spec, without what is faulty in it, which is reported; None where it cannot be read."""
    known = _faultless.get(_said(source))
    if known and known.source is source and known.values <= budget.left(Limit.VALUES):
        budget.spend(Limit.VALUES, known.values, source.whole)
        return known.tree
    before, watched = budget.left(Limit.VALUES), _Watched(sink)
    tree = read(source, watched, budget)
    if tree is None:
        return None
    whole = judge_places(validate(tree, watched, is_included=source.included is not None), watched)
    if watched.is_silent:
        _remember(_Read(source, whole, before - budget.left(Limit.VALUES)))
    return whole


def _remember(one: _Read) -> None:
    _faultless[_said(one.source)] = one
    while _faultless and sum(len(text) for _, text, *_ in tuple(_faultless)) > MOST_REMEMBERED:
        _faultless.pop(next(iter(_faultless)), None)


def _said(source: SourceFile) -> _Said:
    return source.name, source.text, source.path, source.order, source.included


class _Watched(Diagnostics):
    """Hands all faults on, and knows whether there was one."""

    def __init__(self, sink: Diagnostics) -> None:
        super().__init__()
        self.is_silent = True
        self._sink = sink

    def report(self, diagnostic: Diagnostic) -> None:
        self.is_silent = False
        self._sink.report(diagnostic)
