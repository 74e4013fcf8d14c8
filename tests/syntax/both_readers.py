"""What the quick reader and the one of libyaml's events make of one text."""

from __future__ import annotations

from linkforge_compile.bounds import Budget, Limit
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.source import SourceFile
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.event_reader import read_events
from linkforge_compile.syntax.marks import Marks
from linkforge_compile.syntax.quick_reader import read_quickly


def agree_on(text: str) -> bool:
    """Whether the quick reader reads a text, which the other must read alike: words, values, places, their count."""
    file = SourceFile("r", text)
    if FORBIDDEN_CHARACTER.search(file.counted):
        return False
    budget, sink = Budget(), Diagnostics()
    most = budget.left(Limit.VALUES)
    if (read := read_quickly(file, most)) is None:
        return False
    other = read_events(Marks(file), sink, budget, None)
    assert not list(sink)
    assert other is not None
    quick, size = read
    assert said(quick) == said(other)
    assert size == most - budget.left(Limit.VALUES)
    return True


def said(node: YamlNode) -> tuple[object, ...]:
    """Return all that a node says, of which any two that are equal are the same."""
    match node:
        case YamlMap():
            return node.span, [(name, said(entry.key), said(entry.value)) for name, entry in node.entries.items()]
        case YamlList():
            return node.span, [said(item) for item in node]
        case YamlScalar():
            return node.span, node.text, type(node.value), repr(node.value)
    raise AssertionError(f"a fault at {node.span}")
