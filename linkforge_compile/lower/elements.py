"""Lower an object of the tree to the element that its class describes (see core/fields.py), with its raw XML."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NotRequired, TypeAlias, TypedDict, TypeVar

from linkforge_compile.core.fields import (
    Child,
    Children,
    Choice,
    Data,
    Flag,
    Name,
    Noise,
    Number,
    Parameters,
    Pose,
    Reference,
    Spec,
    Text,
    Vector,
    field_specs,
    key_fields,
)
from linkforge_compile.core.models.geometry import IDENTITY, Transform
from linkforge_compile.core.part import Element, Inside, Part, SourcedText
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.free_parts import free_elements, free_texts, is_absent, texts_in, typed_data
from linkforge_compile.lower.numbers import ANGLE, LENGTH, number_type
from linkforge_compile.lower.object_context import report_duplicate
from linkforge_compile.source import SourceRef
from linkforge_compile.syntax.nodes import YamlEntry, YamlList, YamlMap, YamlScalar
from linkforge_compile.units import FieldUnit, Motion

P = TypeVar("P", bound=Part)
E = TypeVar("E", bound=Element)


def lower_element(
    kind: type[P], fields: Fields, motion: Motion = Motion.OTHER, unit: FieldUnit | None = None, **values: Any
) -> P | None:
    """Read an element; fields in `values` are taken from there. Returns None for a faulty one, which is reported.

    `motion` is that of the joint that its numbers are about. `unit` is the unit of its numbers where they are the
    noise on a value; None for the units that the class describes.
    """
    values = lower_fields(kind, fields, motion, unit, **values)
    specs = field_specs(kind).items()
    missing = [spec for name, spec in specs if values[name] is None]
    if any(spec.example or not spec.may_be_none for spec in missing):
        return None
    if hasattr(kind, "stated") and "stated" not in values:
        values["stated"] = [
            name for name, spec in specs if values[name] == spec.implied and fields.node.get(name) is not None
        ]
    extras: Any = extras_of(fields) if issubclass(kind, Element) else {}
    return fields.build(lambda: kind(**values, **extras).with_source(fields.ref))


def lower_fields(
    kind: type[Part], fields: Fields, motion: Motion = Motion.OTHER, unit: FieldUnit | None = None, **values: Any
) -> dict[str, Any]:
    """Read the fields of an element that are not in `values`, numbers in SI; return all of them.

    What is faulty is reported and replaced, by None where it has to be given.
    """
    is_faulty = fields.is_faulty
    for name, spec in field_specs(kind).items():
        if name in values:
            continue
        key = spec.key or name
        if key in fields.node.entries or spec.example or is_faulty:
            values[name] = _READ[type(spec)](spec, key, fields, motion, unit)
        else:
            values[name] = spec.implied
    return values


Lower: TypeAlias = Callable[..., E | None]
"""A function that reads an element of a class from an object, given the names that are keys around it, by field."""


def lower_children(kind: type[E], fields: Fields, key: str, lower: Lower[E] = lower_element) -> Iterator[E]:
    """Yield the elements under a key, without the faulty ones.

    They are in a map by name, in a map of maps by two names, in a list, or in a list of their names only.
    """
    names, node = key_fields(kind), fields.get(key)
    if len(names) == 2:
        for outer, entry in fields.nested(key):
            yield from _lower_entry(kind, fields, entry, lower, **dict(zip(names, (outer, entry.key), strict=True)))
    elif kind.SHORT_FORM:
        section = fields.map(key)
        for entry in section.node if section else ():
            yield from _lower_entry(kind, fields, entry, lower, **{names[0]: entry.key})
    elif isinstance(node, YamlMap):
        noun = kind.TAG.replace("_", " ")
        named = fields.each(key, noun, lambda each, name: lower(kind, each, **{names[0]: name}))
        yield from (child for _, child in named if child)
    else:
        yield from _lower_items(kind, fields, key, lower)


def _lower_entry(kind: type[E], fields: Fields, entry: YamlEntry, lower: Lower[E], **names: YamlScalar) -> Iterator[E]:
    """Read an element that may be in its short form; the `names` around it become fields of the object."""
    texts = {name: node.text for name, node in names.items()}
    owner, short = kind.TITLE.format(**texts), kind.SHORT_FORM
    if isinstance(entry.value, YamlMap):
        item = fields.arranged(owner, entry.key, *entry.value, **names)
    elif is_absent(entry.value) and field_specs(kind)[short].example:
        return
    else:
        item = fields.arranged(owner, entry.key, **names, **{short: entry.value})
    if child := lower(kind, item, **texts):
        yield child


def _lower_items(kind: type[E], fields: Fields, key: str, lower: Lower[E]) -> Iterator[E]:
    """Read elements from a list; an item that is no map is the name of one."""
    names, first = key_fields(kind), dict[str, SourceRef]()
    for node in fields.items(key):
        if isinstance(node, YamlMap) or not names:
            item = fields.map_at(node, key)
            if item and (child := lower(kind, item)):
                yield child
            continue
        item, name = fields.arranged(key, node, **{names[0]: node}), fields.text_at(node, key)
        if name is not None and name in first:
            report_duplicate(fields.sink, kind.TAG.replace("_", " "), name, item.ref, first[name])
        elif name is not None and (child := lower(kind, item, **{names[0]: name})):
            first[name] = item.ref
            yield child


def lower_pose(fields: Fields, key: str = "origin") -> Transform:
    """Read a pose in the parent's frame: `[x, y, z]` or `{xyz, rpy}`; an absent or faulty part is 0."""
    node = fields.get(key)
    if node is None:
        return IDENTITY
    if isinstance(node, YamlList):
        xyz = fields.vector3_at(node, key, LENGTH)
        source = SourceRef(node, None, fields.trail)
        return Transform(xyz, is_stated=True).with_source(source) if xyz else IDENTITY
    pose = fields.map_at(node, key)
    if pose is None:
        return IDENTITY
    xyz, rpy = pose.vector3("xyz", LENGTH), pose.vector3("rpy", ANGLE)
    is_stated = bool(xyz or rpy) or pose.get("xyz") is not None or pose.get("rpy") is not None
    transform = Transform(xyz or IDENTITY.xyz, rpy or IDENTITY.rpy, is_stated=is_stated, **extras_of(pose))
    return transform.with_source(pose.ref)


def _number(spec: Number, key: str, fields: Fields, motion: Motion, unit: FieldUnit | None) -> float | None:
    accepted = number_type(unit or spec.unit, spec.bound, motion, spec.may_be_far)
    read = fields.integer if spec.is_whole else fields.number
    value = read(key, accepted, required=spec.example_for(motion))
    if value is not None:
        return value
    is_faulty = spec.example or fields.get(key) is not None or fields.is_faulty
    number: float | None = spec.stand_in if is_faulty and spec.stand_in is not None else spec.implied
    return number


def _vector(spec: Vector, key: str, fields: Fields, motion: Motion, _unit: FieldUnit | None) -> object:
    accepted = number_type(spec.unit, spec.bound, motion)
    return _or_implied(spec, fields.vector3(key, accepted, required=spec.example_for(motion)))


def _text(spec: Text, key: str, fields: Fields, motion: Motion, _unit: FieldUnit | None) -> object:
    if spec.container:
        return fields.names(key)
    return _or_implied(spec, fields.text(key, required=spec.example_for(motion)))


def _flag(spec: Flag, key: str, fields: Fields, _motion: Motion, _unit: FieldUnit | None) -> object:
    return _or_implied(spec, fields.flag(key))


def _choice(spec: Choice, key: str, fields: Fields, motion: Motion, _unit: FieldUnit | None) -> object:
    word = fields.choice(key, spec.words, required=spec.example_for(motion))
    return spec.implied if word is None else str(word)


def _pose(_spec: Pose, key: str, fields: Fields, _motion: Motion, _unit: FieldUnit | None) -> Transform:
    return lower_pose(fields, key)


def _child(spec: Child, key: str, fields: Fields, motion: Motion, _unit: FieldUnit | None) -> object:
    child = fields.map(key)
    return lower_element(spec.kinds[0], child, motion) if child else None


def _noise(spec: Noise, key: str, fields: Fields, _motion: Motion, _unit: FieldUnit | None) -> object:
    noise, kind = fields.map(key), spec.kinds[0]
    if noise is None:
        return None
    values = lower_fields(kind, noise, Motion.UNKNOWN, spec.unit)
    biases = ("bias_mean", "bias_stddev")
    values["stated"] = [name for name in biases if noise.get(name) is not None and values[name] == 0]
    return lower_element(kind, noise, **values)


def _children(spec: Children, key: str, fields: Fields, _motion: Motion, _unit: FieldUnit | None) -> list[Element]:
    return list(lower_children(spec.kinds[0], fields, key))


def _parameters(
    spec: Parameters, key: str, fields: Fields, _motion: Motion, _unit: FieldUnit | None
) -> Mapping[str, object]:
    return free_elements(fields, key) if spec.xml == "*" else free_texts(fields, key)


def _or_implied(spec: Spec, value: object) -> object:
    return spec.implied if value is None else value


_READ: Mapping[type[Spec], Callable[[Any, str, Fields, Motion, FieldUnit | None], object]] = {
    Number: _number,
    Vector: _vector,
    Text: _text,
    Name: _text,
    Reference: _text,
    Flag: _flag,
    Choice: _choice,
    Pose: _pose,
    Child: _child,
    Noise: _noise,
    Children: _children,
    Parameters: _parameters,
    Data: lambda _spec, key, fields, _motion, _unit: typed_data(fields, key),
}
"""How a field of each kind is read: its spec, its key, the object, and the motion and unit of `lower_element`."""


EXTRA_KEYS = frozenset({"extra", "extra_attributes", "extra_inside"})


class OuterExtras(TypedDict):
    """Raw XML of a link or a robot, which have no elements inside that are not parts."""

    extra_elements: tuple[str, ...]
    extra_attributes: tuple[tuple[str, str], ...]


class Extras(TypedDict):
    """Raw XML of an element, if it has any."""

    extra_elements: NotRequired[tuple[str, ...]]
    extra_attributes: NotRequired[tuple[tuple[str, str], ...]]
    extra_inside: NotRequired[tuple[Inside, ...]]


def extras_of(fields: Fields) -> Extras:
    """Read the raw XML of an element.

    Formats check the raw XML, because it depends on them how it is written.
    """
    if EXTRA_KEYS.isdisjoint(fields.node.entries):
        return {}
    return {**outer_extras_of(fields), "extra_inside": tuple(_insides(fields))}


def outer_extras_of(fields: Fields) -> OuterExtras:
    """Read the raw XML and the raw attributes of a link or a robot."""
    attributes = fields.map("extra_attributes")
    texts = ((fields.text_at(node, "extra"), SourceRef(node, None, fields.trail)) for node in fields.items("extra"))
    return {
        "extra_elements": tuple(SourcedText(text, source) for text, source in texts if text and text.strip()),
        "extra_attributes": tuple(
            (SourcedText(name, attributes.ref), text) for name, text in texts_in(attributes).items()
        )
        if attributes
        else (),
    }


def _insides(fields: Fields) -> Iterator[Inside]:
    """Read the raw XML of elements inside, by tag, or by tag and name with a space between them."""
    for key, inside in fields.each("extra_inside", "element", lambda inside, _: inside):
        tag, _, name = key.partition(" ")
        if inside:
            yield Inside(tag, name.strip() or None, **extras_of(inside)).with_source(inside.ref)
