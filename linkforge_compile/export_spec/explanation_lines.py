"""The lines in which an explanation of a value reads, for `linkforge explain` and for editors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TypeAlias

from linkforge_compile.expand.values import NameOrigin, Setting
from linkforge_compile.export_spec.explain import ComputedFrom, Explanation
from linkforge_compile.listing import as_written
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import WORDS, Kind, Provenance

_LONGEST_TEXT = 60

PlaceLines: TypeAlias = Callable[[str, Span], Iterable[str]]
"""Returns the lines of what is written at a place, for a person to read."""


def explanation_lines(explanation: Explanation, place_lines: PlaceLines) -> Iterator[str]:
    """Yield the value, and who wrote it and what it replaced or was computed from, from the inside out."""
    yield explanation.text
    yield from origin_lines(explanation, place_lines)


def origin_lines(explanation: Explanation, place_lines: PlaceLines) -> Iterator[str]:
    """Yield where a value comes from, without the value."""
    chain = explanation.provenance
    if chain is None:
        yield "written in no file"
        return
    if explanation.is_written:
        yield from place_lines(chain.sentence, chain.span)
    elif explanation.computed_from is None:
        yield "no line of the spec wrote this; it has its default"
        yield from place_lines(f"what it belongs to is {chain.sentence}", chain.span)
    links = [link for link in chain.outer or () if link.sentence]
    of_value = [link for link in links if link.kind in {Kind.EXPRESSION, Kind.VALUE}]
    for link in of_value:
        yield from _link(link, place_lines, explanation.names)
    if explanation.computed_from:
        yield from computed_lines(explanation.computed_from, place_lines)
    for link in links:
        if link not in of_value:
            yield from _link(link, place_lines)


def _link(link: Provenance, place_lines: PlaceLines, names: Sequence[NameOrigin] = ()) -> Iterator[str]:
    if link.kind is not Kind.EXPRESSION:
        yield from place_lines(link.sentence, link.span)
        return
    yield link.sentence
    for name in names:
        yield from name_lines(name, "  ")


def computed_lines(inertial: ComputedFrom, place_lines: PlaceLines) -> Iterator[str]:
    """Yield what an inertial was computed from."""
    yield f"computed from the {inertial.quantity}, spread evenly over the link's shapes"
    yield from place_lines(f"the {inertial.quantity} is {inertial.place.sentence}", inertial.place.span)
    for shape in inertial.shapes:
        yield f"{shape.path}, a {shape.geometry}" + (f", is written at {shape.place}" if shape.place else "")


def name_lines(name: NameOrigin, indent: str = "") -> Iterator[str]:
    """Yield the value of a name of expressions and what set it, then the same of the names that it uses."""
    yield f"{indent}{name.name} is {name.value}, {_setting(name.setting)}"
    yield from (f"{indent}  instead of {_setting(other)}" for other in name.setting.instead_of)
    for inner in name.names:
        yield from name_lines(inner, f"{indent}  ")


def _setting(setting: Setting) -> str:
    """Return what set a name: "the default 0.8 m at arm.robot.yaml:6:11"."""
    words, place = WORDS[setting.kind].sentence.format(name=setting.name), setting.node.span
    if setting.kind is Kind.COMMAND_LINE:
        return words
    if setting.named_by is not None:
        return f"{words} at {setting.named_by.span}"
    text = as_written(setting.node)
    return f"{words} {text} at {place}" if text and len(text) <= _LONGEST_TEXT else f"{words} at {place}"
