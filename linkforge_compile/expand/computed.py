"""Judges what an expression made by the schema, which saw only the expression when it judged the file."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.repetition import COMPUTED_REPETITION
from linkforge_compile.schema import validate_computed
from linkforge_compile.schema.shapes import FREE, Shape
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode

_REPETITION = ("for", "when")


def judge_computed(node: YamlNode, key: str, shape: Shape, sink: Diagnostics) -> YamlNode:
    """Return a computed node without what may not stand under `key`, which is reported.

    A scalar is for the one to judge who reads it, and what is in a free part for nobody.
    """
    if not isinstance(node, YamlMap | YamlList) or not shape.schema or shape.is_free_part:
        return node
    word = next(_repetition(node, shape), None)
    if word:
        sink.report(COMPUTED_REPETITION.at(node.span, name=word))
        return YamlFault(node.span)
    return validate_computed(node, key, shape, sink)


def _repetition(node: YamlNode, shape: Shape) -> Iterator[str]:
    """Yield each `for` and `when` that would be more than a key, had it been written out."""
    match node:
        case YamlList():
            for item in node:
                yield from _repetition(item, shape.item or (shape if shape.is_object else FREE))
        case YamlMap() if not shape.is_plain:
            for entry in node:
                if entry.name in _REPETITION and not shape.has_names:
                    yield entry.name
                yield from _repetition(entry.value, shape.under(entry.name))
