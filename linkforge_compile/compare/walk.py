"""Two values of the same place, walked down to what differs: every field that a part has, so that none is forgotten."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from linkforge_compile.compare.difference import Difference, Kind
from linkforge_compile.compare.measures import BARE, Measure, change_told, measure_of, position_measure
from linkforge_compile.compare.pairing import paired
from linkforge_compile.compare.poses import pose_differences, tensor_differences
from linkforge_compile.compare.words import is_part, key_of_field, plain, said_fields, told
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.index import Index
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import InertiaTensor
from linkforge_compile.core.models.material import Color, Material
from linkforge_compile.core.models.planning import GroupState
from linkforge_compile.core.models.transmission import Transmission, TransmissionJoint

TOLERANCE = 1e-6
"""Below which a difference is not told, unless said: of poses in metres and radians, of other numbers as a share."""

_FLOOR = 1e-6
"""Of the tolerance: what a number next to 0 may differ by, where a share means nothing."""

Path: TypeAlias = tuple[str, ...]


class How(NamedTuple):
    """What a place inherits from those around it.

    `sliding` are the names of the prismatic joints, `slides` whether the values at hand are about one of them,
    `palettes` the materials that the robots declare, whose differences are told at their declaration.
    """

    tolerance: float = TOLERANCE
    sliding: frozenset[str] = frozenset()
    palettes: tuple[Mapping[str, Material], Mapping[str, Material]] = ({}, {})
    slides: bool = False
    measure: Measure = BARE


def walk(path: Path, before: object, after: object, how: How) -> Iterator[Difference]:
    """Yield what differs between the values at a path."""
    match before, after:
        case (bool(), _) | (_, bool()):
            yield from _leaf(path, before, after, how)
        case (int() | float(), int() | float()):
            if not is_near(before, after, how.tolerance):
                yield Difference(Kind.CHANGED, path, before, after, change_told(before, after, how.measure))
        case (Transform(), Transform()):
            yield from pose_differences(path, before, after, how.tolerance)
            yield from _fields(path, before, after, how, ("xyz", "rpy"))
        case (InertiaTensor(), InertiaTensor()):
            yield from tensor_differences(path, before, after, how.tolerance)
            yield from _fields(path, before, after, how, ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
        case (Vector3() | Color(), Vector3() | Color()):
            yield from _vectors(path, before, after, how)
        case (Interface(), Interface()):
            yield from _fields(path, before, after, how)
        case (Mapping(), Mapping()):
            yield from _mappings(path, before, after, how)
        case (str(), _) | (_, str()):
            yield from _leaf(path, before, after, how)
        case (tuple() | list() | Index(), tuple() | list() | Index()):
            yield from _members(path, before, after, how)
        case _ if type(before) is type(after) and is_part(before):
            yield from _part(path, before, after, how)
        case _:
            yield from _leaf(path, before, after, how)


def is_near(before: float, after: float, tolerance: float) -> bool:
    """Whether two numbers differ by no more than the tolerance, as a share of the larger one."""
    return math.isclose(before, after, rel_tol=tolerance, abs_tol=tolerance * _FLOOR)


def _leaf(path: Path, before: object, after: object, how: How) -> Iterator[Difference]:
    if before == after and type(before) is type(after):
        return
    text = f"{told(before, how.measure, slides=how.slides)} → {told(after, how.measure, slides=how.slides)}"
    kind = Kind.CHANGED
    if before is None:
        kind, text = Kind.ADDED, told(after, how.measure, slides=how.slides)
    elif after is None:
        kind, text = Kind.REMOVED, told(before, how.measure, slides=how.slides)
    elif path[0] == "joints" and path[2:] == ("parent",):
        kind = Kind.MOVED
    yield Difference(kind, path, plain(before), plain(after), text)


def _part(path: Path, before: object, after: object, how: How) -> Iterator[Difference]:
    match before, after:
        case (Joint(), Joint()):
            how = how._replace(slides=after.type is JointType.PRISMATIC)
        case (TransmissionJoint(), TransmissionJoint()):
            how = how._replace(slides=after.name in how.sliding)
        case (Material(), Material()) if path[0] != "materials" and _is_declared(before, after, how):
            return
        case (Transmission(), Transmission()):
            yield from _order(path, before, after)
        case (GroupState(), GroupState()):
            yield from _positions(path, before, after, how)
            yield from _fields(path, before, after, how, ("joint_values",))
            return
    yield from _fields(path, before, after, how)


def _is_declared(before: Material, after: Material, how: How) -> bool:
    declared = tuple(palette.get(before.name) for palette in how.palettes)
    return before.name == after.name and declared == (before, after)


def _fields(path: Path, before: object, after: object, how: How, without: tuple[str, ...] = ()) -> Iterator[Difference]:
    for name in said_fields(before):
        if name in without:
            continue
        here = how._replace(measure=measure_of(type(before), name, slides=how.slides))
        read_as = _READ_AS.get(name, _as_it_is)
        old, new = read_as(getattr(before, name)), read_as(getattr(after, name))
        yield from walk((*path, _key(name, old, new)), old, new, here)


def _key(field: str, before: object, after: object) -> str:
    """Return the key of a field: of a shape, its own tag where both have the same."""
    if field == "geometry" and type(before) is type(after):
        return str(getattr(before, "type", field))
    return key_of_field(field)


def _as_it_is(value: object) -> object:
    return value


def _as_interfaces(names: object) -> object:
    assert isinstance(names, tuple)
    return tuple(map(Interface.of, names))


def _as_mapping(pairs: object) -> object:
    assert isinstance(pairs, Sequence)
    return dict(pairs)


_READ_AS: Mapping[str, Callable[[object], object]] = {
    "command_interfaces": _as_interfaces,
    "state_interfaces": _as_interfaces,
    "extra_attributes": _as_mapping,
}


def _members(path: Path, before: Sequence[object], after: Sequence[object], how: How) -> Iterator[Difference]:
    for key, one, other in paired(before, after):
        # A mere name, or raw XML, says at its list what it is.
        is_word = isinstance(one or other, str) and not isinstance(one or other, Interface)
        here = path if is_word else (*path, key)
        if one is None or other is None:
            yield from _leaf(here, one, other, how)
        else:
            yield from walk(here, one, other, how)


def _mappings(path: Path, before: Mapping[str, object], after: Mapping[str, object], how: How) -> Iterator[Difference]:
    for name in dict.fromkeys((*after, *before)):
        one, other, here = before.get(name), after.get(name), (*path, str(name))
        if isinstance(one, Mapping) and isinstance(other, Mapping):
            yield from _mappings(here, one, other, how)
        elif is_part(one) and is_part(other):
            yield from walk(here, one, other, how)
        elif name not in before or name not in after or one != other:
            yield from _leaf(here, one, other, how)


def _vectors(path: Path, before: Vector3 | Color, after: Vector3 | Color, how: How) -> Iterator[Difference]:
    pairs = zip(before.to_tuple(), after.to_tuple(), strict=True)
    if not all(is_near(one, other, how.tolerance) for one, other in pairs):
        text = f"{told(before, how.measure)} → {told(after, how.measure)}"
        yield Difference(Kind.CHANGED, path, plain(before), plain(after), text)
    yield from _fields(path, before, after, how, tuple("xyzrgba"))


def _positions(path: Path, before: GroupState, after: GroupState, how: How) -> Iterator[Difference]:
    """Yield what differs in a pose of a group: the positions of its joints."""
    for joint in dict.fromkeys((*after.joint_values, *before.joint_values)):
        here = how._replace(measure=position_measure(slides=joint in how.sliding))
        one, other = before.joint_values.get(joint), after.joint_values.get(joint)
        if one is None or other is None or len(one) != len(other):
            yield from _leaf((*path, joint), one, other, here)
        else:
            for place, positions in enumerate(zip(one, other, strict=True)):
                yield from walk((*path, joint, *([str(place)] if len(one) > 1 else [])), *positions, here)


def _order(path: Path, before: Transmission, after: Transmission) -> Iterator[Difference]:
    """Yield where the ends of a transmission changed places, which have different parts in it."""
    for what, one, other in (
        ("joints", before.joints, after.joints),
        ("actuators", before.actuators, after.actuators),
    ):
        were, are = [end.name for end in one], [end.name for end in other]
        if were != are and sorted(were) == sorted(are):
            text = f"in the order {', '.join(were)} → {', '.join(are)}"
            yield Difference(Kind.CHANGED, (*path, what), plain(were), plain(are), text)
