"""Nodes of a spec that is written."""

from __future__ import annotations

from collections.abc import Mapping

from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, scalar_value


def scalar(value: str, where: Span, *, is_text: bool = True) -> YamlScalar:
    """Return a text, or what YAML reads in it."""
    return YamlScalar(value, value if is_text else scalar_value(value), where)


def map_of(entries: Mapping[str, YamlNode | None], where: Span) -> YamlMap:
    """Return a map of the entries that are not None."""
    made = {name: YamlEntry(scalar(name, where), node) for name, node in entries.items() if node is not None}
    return YamlMap(made, where)


def data_of(value: object, where: Span) -> YamlNode:
    """Return data, such as that of a YAML file, as a node."""
    match value:
        case dict():
            return map_of({str(name): data_of(item, where) for name, item in value.items()}, where)
        case list() | tuple():
            return YamlList(tuple(data_of(item, where) for item in value), where)
        case bool():
            return scalar(str(value).lower(), where, is_text=False)
        case None:
            return scalar("null", where, is_text=False)
        case str():
            return scalar(value.replace("$(", "$$("), where)
    return scalar(str(value), where, is_text=False)
