"""Find the values of a robot that replaced others: those of overrides and those in place of defaults."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.robot import spec_of
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode


class Replacement(NamedTuple):
    """The key of a value, and the places of that value and of the one that it replaced."""

    key: str
    value: Span
    replaced: Span


def replacements_in(robot: Robot) -> Iterator[Replacement]:
    """Yield the replacements in what a compiled robot was written in, each once."""
    builder = SpecBuilder(full=True)
    spec_of(robot, builder)
    seen: set[int] = set()
    for written in builder.written.values():
        if isinstance(written.source.node, YamlNode):
            yield from _replacements_at(written.source.node, seen)


def _replacements_at(node: YamlNode, seen: set[int]) -> Iterator[Replacement]:
    if id(node) in seen:
        return
    seen.add(id(node))
    if isinstance(node, YamlMap):
        for entry in node:
            if entry.replaced:
                yield Replacement(entry.name, entry.value.span, entry.replaced.value.span)
            yield from _replacements_at(entry.value, seen)
    elif isinstance(node, YamlList):
        for item in node:
            yield from _replacements_at(item, seen)
