"""Read an XML element into an object of a spec, as the specs of its class describe it; poses and geometry."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from types import MappingProxyType
from typing import TypeAlias

from linkforge_compile.core.fields import (
    Child,
    Choice,
    Flag,
    Number,
    Pose,
    Reference,
    Spec,
    Text,
    Vector,
    field_specs,
    number_fields,
)
from linkforge_compile.core.part import Element
from linkforge_compile.importers.element_reader import ElementReader, Read
from linkforge_compile.importers.spec_draft import CannotRepresentError, number_of
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension, Motion, number_text

Names: TypeAlias = Mapping[str, Collection[str]]
"""The names that references may have, by what they name: link, joint or group. Others are not checked."""

NO_NAMES: Names = MappingProxyType({})


def read_element(
    reader: ElementReader,
    kind: type[Element],
    motion: Motion = Motion.OTHER,
    /,
    *,
    names: Names = NO_NAMES,
    **readers: Read,
) -> YamlMap:
    """Read an element of a class; `readers` read the fields with their keys, and what else the language has.

    It cannot be represented without what its readers require, or with a reference to an unknown name.
    """
    require_numbers(reader, kind)
    entries: dict[str, YamlNode | None] = {}
    for spec in field_specs(kind).values():
        if spec.key and spec.key not in readers:
            entries[spec.key] = _read(reader, spec, motion, names)
        elif spec.key:
            entries[spec.key] = readers[spec.key](reader)
    others = {key: read(reader) for key, read in readers.items() if key not in entries}
    return reader.map(**entries, **others)


def _read(reader: ElementReader, spec: Spec, motion: Motion, names: Names) -> YamlNode | None:
    """Read a field; TypeError for one of a kind, or in a place, that only a reader of its own can read."""
    if isinstance(spec, Child):
        return _read_child(reader, spec, motion, names)
    tag, attribute = _place_of(spec)
    if not tag:
        return _read_attribute(reader, attribute, spec, motion, names)

    def read_only_attribute(child: ElementReader) -> YamlNode | None:
        node = _read_attribute(child, attribute, spec, motion, names)
        child.pass_rest_up()
        return node

    if spec.example and not reader.has_child(tag):
        raise reader.cannot_represent(f"it has no <{tag}>")
    return reader.child(tag, read_only_attribute)


def _read_child(reader: ElementReader, spec: Child, motion: Motion, names: Names) -> YamlNode | None:
    # The class itself, because kinds of children are subclasses of Child that have other forms.
    if type(spec) is Pose:
        return reader.child(spec.xml or "", read_pose)
    if type(spec) is Child and len(spec.kinds) == 1:
        [kind] = spec.kinds
        return reader.child(spec.xml or "", lambda child: read_element(child, kind, motion, names=names))
    raise _unreadable(spec)


def _place_of(spec: Spec) -> tuple[str, str]:
    """Return the tag of the child that has the attribute of a field, empty for the element itself, and its name."""
    tag, at, attribute = (spec.xml or "").rpartition("@")
    if not at or spec.container:
        raise _unreadable(spec)
    return tag.rstrip("/"), attribute


def _unreadable(spec: Spec) -> TypeError:
    return TypeError(f"'{spec.key}' is a {type(spec).__name__} at '{spec.xml}', which needs a reader of its own")


def _read_attribute(reader: ElementReader, name: str, spec: Spec, motion: Motion, names: Names) -> YamlNode | None:
    match spec:
        case Number():
            return _read_number(reader, name, spec, motion)
        case Vector():
            return _read_vector(reader, name, spec, motion)
        case Flag():
            return reader.flag(name, default=spec.implied)
        case Reference():
            is_given = spec.example or reader.element.get(name)
            return read_reference(reader, name, spec.to, names) if is_given else None
        case Text() | Choice():
            node = reader.required_text(name) if spec.example else reader.text(name)
            return None if node is not None and reader.element.get(name) == spec.implied else node
    raise _unreadable(spec)


def read_reference(reader: ElementReader, attribute: str, kind: str, names: Names) -> YamlScalar:
    """Take an attribute that names a link, joint or group; the element cannot be represented with an unknown name."""
    reference = reader.attribute(attribute)
    node = reader.draft.text(reference.value, reference)
    if node.text not in names.get(kind, (node.text,)):
        noun = "planning group" if kind == "group" else kind
        raise CannotRepresentError(f"there is no {noun} named '{node.text}'", reference.span)
    return node


def require_numbers(reader: ElementReader, kind: type[Element]) -> None:
    """Raise CannotRepresentError unless the element has the numbers that readers of URDF require."""
    required = [_place_of(spec) for spec in number_fields(kind).values() if spec.is_required_in_urdf]
    if missing := [name for tag, name in required if not tag and reader.element.get(name) is None]:
        raise reader.cannot_represent(f"it has no {' and no '.join(map(repr, missing))}")


def read_numbers(
    reader: ElementReader, kind: type[Element], motion: Motion, *, without: Collection[str] = ()
) -> dict[str, YamlNode | None]:
    """Read the numbers of a class by key, except the fields `without`; None for one missing or at its default."""
    specs = number_fields(kind).items()
    return {spec.key or name: _read(reader, spec, motion, NO_NAMES) for name, spec in specs if name not in without}


def _read_number(reader: ElementReader, name: str, spec: Number, motion: Motion) -> YamlScalar | None:
    written = reader.element.get(name) or ""
    node = reader.number(name, spec.unit.dimension(motion), default=spec.implied)
    _require_bound(reader, name, spec, written)
    return node


def _read_vector(reader: ElementReader, name: str, spec: Vector, motion: Motion) -> YamlList | None:
    written = (reader.element.get(name) or "").split()
    read = reader.required_numbers if spec.example else reader.numbers
    node = read(name, 3, spec.unit.dimension(motion))
    for number in written:
        _require_bound(reader, name, spec, number)
    default = spec.implied and tuple(spec.implied)
    return None if tuple(map(number_of, written)) == default else node


def _require_bound(reader: ElementReader, name: str, spec: Number | Vector, written: str) -> None:
    value = number_of(written)
    if spec.bound and value is not None and not spec.bound.holds(value):
        raise reader.cannot_represent(f"{name} must be {spec.bound.words}, found {written}")


_QUATERNION = "quat_xyzw"
"""The attribute of URDF 1.1 that replaces `rpy`; it is kept with the angles computed from it."""
_GIMBAL_LOCK = 1e-9
"""Below this cosine of the pitch, roll and yaw turn about the same axis, and all of the turn becomes yaw."""
_NOISE = 4e-16
"""How far a computed angle may be from the round angle in degrees that it replaces [rad]."""


def read_pose(origin: ElementReader) -> YamlNode | None:
    """Read a pose: `[x, y, z]` if it has no rotation, None for the identity."""
    xyz, rpy = origin.numbers("xyz", 3), origin.numbers("rpy", 3, Dimension.ANGLE)
    if rpy is None and origin.draft.has_quaternions:
        rpy = _rpy_of_quaternion(origin)
    xyz, rpy = _unless_zero(xyz), _unless_zero(rpy)
    node = origin.map(xyz=xyz, rpy=rpy)
    if not len(node):
        return None
    return xyz if xyz and len(node) == 1 else node


def _rpy_of_quaternion(origin: ElementReader) -> YamlList | None:
    """Return the rotation of a pose's quaternion as rpy; None without one, or if it is no rotation."""
    attribute = origin.element.attributes.get(_QUATERNION)
    numbers = [number_of(part) for part in attribute.value.split()] if attribute else []
    if attribute is None or len(numbers) != 4:
        return None
    x, y, z, w = (0.0 if number is None else number for number in numbers)
    if None in numbers or not 0 < math.hypot(x, y, z, w) < math.inf:
        return None
    nodes = [origin.draft.number(number_text(angle), attribute.span, Dimension.ANGLE) for angle in _rpy(x, y, z, w)]
    return YamlList(tuple(node for node in nodes if node is not None), attribute.span)


def _rpy(x: float, y: float, z: float, w: float) -> tuple[float, ...]:
    """Return the rotations about the fixed axes x, y, z, in this order [rad]."""
    length = math.hypot(x, y, z, w)
    x, y, z, w = x / length, y / length, z / length, w / length
    cos_pitch = math.hypot(1 - 2 * (y * y + z * z), 2 * (x * y + w * z))
    pitch = math.atan2(2 * (w * y - x * z), cos_pitch)
    if cos_pitch < _GIMBAL_LOCK:
        roll, yaw = 0.0, math.atan2(2 * (w * z - x * y), 1 - 2 * (x * x + z * z))
    else:
        roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return tuple(map(_rounded, (roll, pitch, yaw)))


def _rounded(angle: float) -> float:
    degrees = math.radians(round(math.degrees(angle), 3))
    return degrees + 0.0 if abs(angle - degrees) <= _NOISE else angle


def read_geometry(geometry: ElementReader) -> YamlMap:
    """Read the shape of a visual or collision as a map with the shape's tag as its only key."""
    shapes = geometry.remaining()
    if len(shapes) != 1:
        raise geometry.cannot_represent(f"a geometry is one shape, found {len(shapes) or 'none'}")
    [shape] = shapes
    read = _READERS.get(shape.tag)
    if read is None:
        raise geometry.cannot_represent(f"there is no shape named '{shape.tag}'")
    node = geometry.read(shape, read)
    geometry.pass_rest_up()
    return geometry.draft.map_of({shape.tag: node}, shape)


def _read_box(box: ElementReader) -> YamlNode:
    size = box.required_numbers("size", 3)
    if any(_value(item) <= 0 for item in size):
        raise box.cannot_represent(f"every side must be above 0, found '{box.element.get('size')}'")
    box.pass_rest_up()
    return size


def _read_sphere(sphere: ElementReader) -> YamlNode:
    radius = sphere.required_number("radius", above=0)
    return radius if sphere.is_used_up() else sphere.map(radius=radius)


def _read_cylinder(cylinder: ElementReader) -> YamlNode:
    radius = cylinder.required_number("radius", above=0)
    return cylinder.map(radius=radius, length=cylinder.required_number("length", above=0))


def _read_mesh(mesh: ElementReader) -> YamlNode:
    file, scale = mesh.required_text("filename"), mesh.numbers("scale", 3)
    if not file.text.strip():
        raise mesh.cannot_represent("it names no file")
    node = mesh.map(file=file, scale=_short_scale(mesh, scale) if scale else None)
    return file if len(node) == 1 else node


def _short_scale(mesh: ElementReader, scale: YamlList) -> YamlNode | None:
    """Return one number for three equal ones, None for 1."""
    factors = {_value(item) for item in scale}
    if 0 in factors:
        raise mesh.cannot_represent(f"no scale may be 0, found '{mesh.element.get('scale')}'")
    if len(factors) > 1:
        return scale
    return None if factors == {1.0} else scale.items[0]


def _unless_zero(numbers: YamlList | None) -> YamlList | None:
    return numbers if numbers and any(_value(item) for item in numbers) else None


def _value(node: YamlNode) -> float:
    """Return the value of a number; 1 for an angle in degrees, which is never 0."""
    return (number_of(node.text) or 0.0) if isinstance(node, YamlScalar) and not isinstance(node.value, str) else 1.0


_READERS: Mapping[str, Callable[[ElementReader], YamlNode]] = {
    "box": _read_box,
    "sphere": _read_sphere,
    "cylinder": _read_cylinder,
    "capsule": _read_cylinder,
    "mesh": _read_mesh,
}
