"""Find what URDF readers refuse.

urdfdom refuses a whole robot for a faulty joint or a duplicate name, and skips the rest of a link after a fault in it;
MuJoCo refuses the robot for either. Readers read only the first element of a tag, except visuals and collisions.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.fields import Axis, Child, Number, Spec, Text, Vector, field_specs
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.joint import HAVE_NO_AXIS, NEED_LIMITS, Joint
from linkforge_compile.core.models.link import Collision, Inertial
from linkforge_compile.core.part import Element
from linkforge_compile.diagnostics import Diagnostic, Note
from linkforge_compile.diagnostics.codes.importing import LACKS_PART, NAME_IS_TAKEN, NO_NUMBERS, NO_TYPE_OF_JOINT
from linkforge_compile.importers.link import JOINT_TYPES, SHAPES
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.source.xml_tree import XmlAttribute, XmlElement

_UNBOUNDED = re.compile(r"[+-]?(?:inf|infinity|nan)", re.IGNORECASE)
"""Numbers that are not finite: older urdfdom and MuJoCo accept them, and vendors write such limits."""


class Refusal(NamedTuple):
    """A fault that readers refuse, and the elements around it, the robot's child first."""

    diagnostic: Diagnostic
    path: tuple[XmlElement, ...]


class _Part(NamedTuple):
    """What readers read of an element: how many numbers an attribute has, and the attributes they require."""

    numbers: Mapping[str, int] = {}
    required: tuple[str, ...] = ()


def _part_of(kind: type[Element]) -> _Part:
    """Return what readers read of the attributes of a class."""
    return _part({spec.xml[1:]: spec for spec in field_specs(kind).values() if spec.xml and spec.xml[0] == "@"})


def _part(attributes: Mapping[str, Spec]) -> _Part:
    counts = {Number: 1, Vector: 3, Axis: 3}
    numbers = {name: counts[type(spec)] for name, spec in attributes.items() if type(spec) in counts}
    return _Part(numbers, tuple(name for name, spec in attributes.items() if _is_required(spec)))


def _is_required(spec: Spec) -> bool:
    return spec.is_required_in_urdf or (bool(spec.example) and isinstance(spec, Text | Vector))


def _parts_of(kind: type[Element]) -> Mapping[str, _Part]:
    """Return what readers read of the children of a class that have attributes, by tag."""
    parts: dict[str, _Part] = {}
    for spec in field_specs(kind).values():
        tag, _, attribute = (spec.xml or "").partition("/@")
        if isinstance(spec, Child) and len(spec.kinds) == 1:
            parts[tag] = _part_of(spec.kinds[0])
        elif attribute:
            parts[tag] = _part({attribute: spec})
    return parts


_SHAPE, _JOINT, _INERTIAL = map(_parts_of, (Collision, Joint, Inertial))
_BODIES = {tag: _part_of(kind) for tag, kind in SHAPES.items()}
# For a scale that it cannot read, urdfdom drops the shape alone; it is reported as raw XML.
_BODIES[Mesh.TAG] = _BODIES[Mesh.TAG]._replace(numbers={})


def find_refusals(robot: XmlElement) -> Iterator[Refusal]:
    """Yield what readers refuse of a robot, in the order of its elements."""
    names: dict[tuple[str, str], XmlElement] = {}
    for element in robot.children:
        if element.tag in _FIND:
            yield from _inside(element, _in_name(element, names))
            yield from _inside(element, _FIND[element.tag](element))


def _in_name(element: XmlElement, names: dict[tuple[str, str], XmlElement]) -> Iterator[Refusal]:
    name = element.get("name")
    if name is None:
        # urdfdom ignores a material without a name.
        if element.tag != "material":
            yield _lacks(element, "'name'")
        return
    first = names.setdefault((element.tag, name), element)
    if first is not element:
        notes = [Note("the other is here", first.span)]
        where = element.attributes["name"].span
        yield Refusal(NAME_IS_TAKEN.at(where, tag=element.tag, name=name, notes=notes), ())


def _in_link(link: XmlElement) -> Iterator[Refusal]:
    if inertial := _first(link, "inertial"):
        yield from _inside(inertial, _in_inertial(inertial))
    for shape in link.children:
        if shape.tag in ("visual", "collision"):
            yield from _inside(shape, _in_shape(shape))


def _in_inertial(inertial: XmlElement) -> Iterator[Refusal]:
    for tag, part in _INERTIAL.items():
        if part.required and _first(inertial, tag) is None:
            yield _lacks(inertial, f"<{tag}>")
    yield from _in_parts(inertial, _INERTIAL)


def _in_shape(shape: XmlElement) -> Iterator[Refusal]:
    yield from _in_parts(shape, _SHAPE)
    geometry = _first(shape, "geometry")
    if geometry is None:
        yield _lacks(shape, "<geometry>")
    elif body := next(iter(geometry.children), None):
        if part := _BODIES.get(body.tag):
            yield from _inside(geometry, _inside(body, _in_part(body, part)))
    else:
        yield from _inside(geometry, [_lacks(geometry, "shape, such as <box size='1 1 1'/>")])


def _in_joint(joint: XmlElement) -> Iterator[Refusal]:
    kind = joint.get("type")
    if kind is None:
        yield _lacks(joint, "'type'")
    elif kind not in JOINT_TYPES:
        where = joint.attributes["type"].span
        yield Refusal(NO_TYPE_OF_JOINT.at(where, name=kind, near=JOINT_TYPES), ())
    for tag in ("parent", "child"):
        if _first(joint, tag) is None:
            yield _lacks(joint, f"<{tag} link='...'>")
    parts = dict(_JOINT)
    if kind in HAVE_NO_AXIS:
        del parts["axis"]
    if kind in NEED_LIMITS:
        # Compiling the spec reports what the limits of such a joint lack.
        parts["limit"] = _JOINT["limit"]._replace(required=())
    yield from _in_parts(joint, parts)


def _in_parts(owner: XmlElement, parts: Mapping[str, _Part]) -> Iterator[Refusal]:
    for tag, part in parts.items():
        if element := _first(owner, tag):
            yield from _inside(element, _in_part(element, part))


def _in_part(element: XmlElement, part: _Part) -> Iterator[Refusal]:
    missing = [repr(name) for name in part.required if element.get(name) is None]
    if missing:
        yield _lacks(element, " and no ".join(missing))
    for name, count in part.numbers.items():
        text = element.get(name)
        if text is not None and not _are_numbers(text, count):
            yield _no_numbers(element, element.attributes[name], count)


def _are_numbers(text: str, count: int) -> bool:
    words = text.split()
    return len(words) == count and all(number_of(word) is not None or _UNBOUNDED.fullmatch(word) for word in words)


def _no_numbers(element: XmlElement, attribute: XmlAttribute, count: int) -> Refusal:
    text = attribute.value
    expected = "one number" if count == 1 else f"{count} numbers with spaces between them"
    without_commas = [" ".join(text.replace(",", other).split()) for other in ". " if "," in text]
    way_out = next((f"; write '{one}'" for one in without_commas if _are_numbers(one, count)), "")
    diagnostic = NO_NUMBERS.at(
        attribute.span, name=attribute.name, tag=element.tag, expected=expected, text=text, way_out=way_out
    )
    return Refusal(diagnostic, ())


def _lacks(element: XmlElement, what: str) -> Refusal:
    return Refusal(LACKS_PART.at(element.span, tag=element.tag, what=what), ())


def _first(element: XmlElement, tag: str) -> XmlElement | None:
    return next((child for child in element.children if child.tag == tag), None)


def _inside(element: XmlElement, refusals: Iterable[Refusal]) -> Iterator[Refusal]:
    """Yield the refusals of what is in an element, with the element in their paths."""
    for refusal in refusals:
        yield refusal._replace(path=(element, *refusal.path))


_FIND: Mapping[str, Callable[[XmlElement], Iterator[Refusal]]] = {
    "material": lambda _: iter(()),  # readers refuse no robot for a faulty one
    "link": _in_link,
    "joint": _in_joint,
}
