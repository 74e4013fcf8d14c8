"""What raw XML writes a second time of which there can be one: beside the field that writes it, or beside raw XML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from linkforge_compile.core.models.geometry import Transform
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Collision, Inertial, Link, Visual
from linkforge_compile.core.models.material import Material
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.models.transmission import Transmission
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import SECOND_OF_ONE
from linkforge_compile.formats.element import raw_texts
from linkforge_compile.formats.parts import Held, Part
from linkforge_compile.source import SourceRef, Span

_ONE_OF: Mapping[type[Part], Mapping[str, str]] = {
    Link: {"inertial": "inertial"},
    Inertial: {"origin": "origin", "mass": "mass", "inertia": "inertia"},
    Visual: {"origin": "origin", "geometry": "geometry", "material": "material"},
    Collision: {"origin": "origin", "geometry": "geometry"},
    Material: {"color": "color", "texture": "texture"},
    Joint: {
        "origin": "origin",
        "parent": "parent",
        "child": "child",
        "axis": "axis",
        "limit": "limits",
        "dynamics": "dynamics",
        "mimic": "mimic",
        "safety_controller": "safety_controller",
        "calibration": "calibration",
    },
    Ros2Control: {"hardware": "hardware_plugin"},
    Transmission: {"type": "type"},
}
"""The tags of which a part has one at most, and the field that writes it."""


def written_twice(parts: Iterable[Held]) -> Iterator[Diagnostic]:
    """Yield a warning for each such element that raw XML of parts says again."""
    for part, where, *_ in parts:
        if part.extra_elements and (fields := _ONE_OF.get(type(part))):
            yield from _written_again(part, where, fields)


def _written_again(part: Part, where: SourceRef | None, fields: Mapping[str, str]) -> Iterator[Diagnostic]:
    from linkforge_compile.formats.raw import well_formed_nodes

    first = {tag: _place(where, field) for tag, field in fields.items() if _is_written(part, field, where)}
    for text, source, path in raw_texts(part, where):
        for tag in (node.tag for node in well_formed_nodes(text)):
            if tag not in fields:
                continue
            if tag not in first:
                first[tag] = _place(source, *path)
                continue
            place = first[tag]
            yield SECOND_OF_ONE.at(source, *path, tag=tag, notes=[Note("the first is here", place)] if place else [])


def _is_written(part: Part, field: str, where: SourceRef | None) -> bool:
    value = getattr(part, field)
    if isinstance(part, Joint) and where and where.at(field) == where.span:
        return False  # what a joint lacks has a stand-in, and is told
    return value.is_written if isinstance(value, Transform) else value is not None


def _place(source: SourceRef | None, *path: str | int) -> Span | None:
    return source.at(*path) if source else None
