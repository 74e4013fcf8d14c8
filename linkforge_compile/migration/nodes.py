"""Nodes of a spec that is written."""

from __future__ import annotations

from collections.abc import Mapping

from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar, scalar_value


def scalar(value: str, where: Span, *, is_text: bool = True) -> YamlScalar:
    """Return a text, or what YAML reads in it."""
    return YamlScalar(value, value if is_text else scalar_value(value), where)


def map_of(entries: Mapping[str, YamlNode | None], where: Span) -> YamlMap:
    """Return a map of the entries that are not None."""
    made = {name: YamlEntry(scalar(name, where), node) for name, node in entries.items() if node is not None}
    return YamlMap(made, where)
