"""Two values of the same place, walked down to what differs: every field that a part has, so that none is forgotten."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from linkforge_compile.compare.difference import Difference, Kind
from linkforge_compile.compare.measures import BARE, Measure, change_told, is_near, measure_of, position_measure
from linkforge_compile.compare.orders import order_differences
from linkforge_compile.compare.pairing import key_of, paired
from linkforge_compile.compare.poses import pose_differences, tensor_differences
from linkforge_compile.compare.raw_parts import RawElement, by_tag
from linkforge_compile.compare.said import is_part, key_of_field, said_fields, said_value
from linkforge_compile.compare.words import as_json, plain, shortened, texts_told, told
from linkforge_compile.compare.xml_numbers import number_in, say_the_same
from linkforge_compile.core.models.gazebo import GazeboPlugin
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.interface import Interface
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import InertiaTensor, LinkPhysics
from linkforge_compile.core.models.material import Color, Material
from linkforge_compile.core.models.planning import GroupState
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import (
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)
from linkforge_compile.core.models.sensor import SensorNoise
from linkforge_compile.core.models.transmission import TransmissionActuator, TransmissionJoint

TOLERANCE = 1e-6
"""Below which a difference is not told, unless said: of poses in metres and radians, of other numbers as a share."""

_DIGITS = (6, 9, 13, 17)
"""How many of a number are shown, the more the less it changed."""

_LONGEST_STATE = 200
"""Characters of the positions of a state that come or go as a whole."""

_IN_XML = frozenset({"parameters", "properties", "extra_attributes", "extra_elements"})
"""The fields whose texts are those of an author's XML."""

_OF_STRANGERS = (GazeboPlugin, Ros2Control, Ros2ControlJoint, Ros2ControlGpio, Ros2ControlSensor)
"""Parts whose parameters a plugin reads as it likes: to its driver, firmware 1.10 is another one than 1.1."""

Path: TypeAlias = tuple[str, ...]


class How(NamedTuple):
    """What a place inherits from those around it.

    Of each pair, one is of the robot before and one of that after: `sliding` are the names of the prismatic joints,
    `slides` whether the values at hand are about one of them, `measures` what these measure, `palettes` the materials
    that the robots declare, whose differences are told at their declaration. `in_xml` is whether texts are those of an
    author's XML, in which numbers are spelt in many ways; `as_spelt` whether each spelling is another text.
    """

    tolerance: float = TOLERANCE
    sliding: tuple[Collection[str], Collection[str]] = ((), ())
    palettes: tuple[Mapping[str, Material], Mapping[str, Material]] = ({}, {})
    slides: tuple[bool, bool] = (False, False)
    measures: tuple[Measure, Measure] = (BARE, BARE)
    in_xml: bool = False
    as_spelt: bool = False

    def told(self, before: object, after: object) -> tuple[str, str]:
        """Return two different values at hand in a few words each, with as much as shows that they differ."""
        if type(before) is str and type(after) is str:
            return texts_told(before, after)
        if isinstance(before or after, GroupState):
            return self._state_told(before, self.sliding[0]), self._state_told(after, self.sliding[1])
        both = tuple(zip((before, after), self.measures, self.slides, strict=True))
        for digits in _DIGITS:
            one, other = (told(value, measure, slides=slides, digits=digits) for value, measure, slides in both)
            if one != other:
                return one, other
        return as_json(before), as_json(after)

    def _state_told(self, state: object, sliding: Collection[str]) -> str:
        if not isinstance(state, GroupState):
            return told(state)
        positions = (
            f"{joint} {told(values, position_measure(slides=joint in sliding))}"
            for joint, values in state.joint_values.items()
        )
        return shortened(", ".join(positions), _LONGEST_STATE) or told(state)

    def about_joint(self, name: str) -> How:
        """Return the same for values about the joint of a name."""
        before, after = (name in sliding for sliding in self.sliding)
        return self._replace(slides=(before, after))

    def about_field(self, field: str) -> How:
        """Return the same for what is in a field."""
        return self._replace(in_xml=True) if field in _IN_XML else self

    def about_tag(self, tag: str) -> How:
        """Return the same for what is in an element of an author's XML."""
        return self._replace(as_spelt=True) if tag == "plugin" else self


def walk(path: Path, before: object, after: object, how: How) -> Iterator[Difference]:
    """Yield what differs between the values at a path."""
    match before, after:
        case (bool(), _) | (_, bool()):
            yield from _leaf(path, before, after, how)
        case (int() | float(), int() | float()):
            if not is_near(before, after, how.tolerance):
                yield Difference(Kind.CHANGED, path, before, after, _number_told(before, after, how))
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
        case (tuple() | list(), tuple() | list()):
            yield from _members(path, before, after, how)
        case _ if type(before) is type(after) and is_part(before):
            yield from _part(path, before, after, how)
        case _:
            yield from _leaf(path, before, after, how)


def _leaf(path: Path, before: object, after: object, how: How) -> Iterator[Difference]:
    if before == after and isinstance(before, bool) == isinstance(after, bool):
        return
    if _is_other_spelling(before, after, how):
        return
    was, now = how.told(before, after)
    kind, text = Kind.CHANGED, _numbers_in_xml_told(before, after, how) or f"{was} → {now}"
    if before is None:
        kind, text = Kind.ADDED, now
    elif after is None:
        kind, text = Kind.REMOVED, was
    elif path[0] == "joints" and path[2:] == ("parent",):
        kind = Kind.MOVED
    yield Difference(kind, path, plain(before), plain(after), text)


def _is_other_spelling(before: object, after: object, how: How) -> bool:
    if not how.in_xml or how.as_spelt or not isinstance(before, str) or not isinstance(after, str):
        return False
    return say_the_same(before, after, how.tolerance)


def _numbers_in_xml_told(before: object, after: object, how: How) -> str:
    """Return how a number that is a text in XML changed, "" for what is none or the same number, spelt otherwise."""
    numbers = [number_in(text) for text in (before, after) if how.in_xml and isinstance(text, str)]
    match numbers:
        case [float() as one, float() as other] if one != other:
            return change_told(one, other, BARE)
    return ""


def _elements(path: Path, before: RawElement, after: RawElement, how: How) -> Iterator[Difference]:
    """Yield what differs in an element of raw XML; those of one tag have an order, which others need not keep."""
    how = how.about_tag(after.tag)
    yield from _mappings(path, before.attributes, after.attributes, how)
    if len(before.texts) == len(after.texts):
        for one, other in zip(before.texts, after.texts, strict=True):
            yield from _leaf(path, one, other, how)
    else:
        yield from _leaf(path, before.texts, after.texts, how)
    were, are = by_tag(before.inside), by_tag(after.inside)
    for tag in dict.fromkeys((*are, *were)):
        yield from _of_one_tag(path, were.get(tag, ()), are.get(tag, ()), how)


def _of_one_tag(
    path: Path, before: Sequence[RawElement], after: Sequence[RawElement], how: How
) -> Iterator[Difference]:
    """Yield what differs in the elements of one tag: by their names where each of several has one, else in order."""
    has_names = len(after) > 1 and all(one.name for one in (*before, *after))
    if len(before) != len(after) or has_names:
        yield from _members(path, before, after, how)
        return
    for place, (one, other) in enumerate(zip(before, after, strict=True)):
        key = key_of(other) if key_of(one) == key_of(other) else other.tag
        yield from walk((*path, key, *([str(place)] if len(after) > 1 and key == other.tag else [])), one, other, how)


def _part(path: Path, before: object, after: object, how: How) -> Iterator[Difference]:
    match before, after:
        case (Joint(), Joint()):
            how = how._replace(slides=(before.type is JointType.PRISMATIC, after.type is JointType.PRISMATIC))
        case (TransmissionJoint(), TransmissionJoint()):
            how = how.about_joint(after.name)
        case (Material(), Material()) if path[0] != "materials" and _is_declared(before, after, how):
            return
        case (RawElement(), RawElement()):
            yield from _elements(path, before, after, how)
            return
        case (GroupState(), GroupState()):
            yield from _positions(path, before, after, how)
            yield from _fields(path, before, after, how, ("joint_values",))
            return
    yield from order_differences(path, before, after)
    yield from _fields(path, before, after, how)


def _is_declared(before: Material, after: Material, how: How) -> bool:
    declared = tuple(palette.get(before.name) for palette in how.palettes)
    return before.name == after.name and declared == (before, after)


def _fields(path: Path, before: object, after: object, how: How, without: tuple[str, ...] = ()) -> Iterator[Difference]:
    for name in said_fields(before):
        if name in without:
            continue
        here = _about_field(how, before, name)
        old, new = said_value(before, name), said_value(after, name)
        yield from walk((*path, _key(name, old, new)), old, new, here)
    yield from stated_differences(path, before, after, how)


def stated_differences(path: Path, before: object, after: object, how: How) -> Iterator[Difference]:
    """Yield the fields that one of two parts states while the other leaves it at that, their default."""
    were, are = _stated(before), _stated(after)
    for name in dict.fromkeys((*are, *were)):
        old, new = getattr(before, name, None), getattr(after, name, None)
        if (name in were) != (name in are) and old == new:
            here = (*path, key_of_field(name))
            yield from walk(
                here, old if name in were else None, new if name in are else None, _about_field(how, before, name)
            )


def _stated(part: object) -> tuple[str, ...]:
    """Return the fields that are written although they have their default, and may be others that are written."""
    match part:
        case LinkPhysics() | SensorNoise():
            return tuple(part.stated)
        case TransmissionJoint() | TransmissionActuator():
            return (*part.stated, "hardware_interfaces") if part.interfaces_stated else tuple(part.stated)
        case Robot():
            return ("version",) if part.version_stated else ()
    return ()


def _about_field(how: How, part: object, field: str) -> How:
    before, after = (measure_of(type(part), field, slides=slides) for slides in how.slides)
    as_spelt = how.as_spelt or (field == "parameters" and isinstance(part, _OF_STRANGERS))
    return how.about_field(field)._replace(measures=(before, after), as_spelt=as_spelt)


def _number_told(before: float, after: float, how: How) -> str:
    was, now = how.measures
    # What turned and slides now has no share of itself left.
    return change_told(before, after, now) if was == now else " → ".join(how.told(before, after))


def _key(field: str, before: object, after: object) -> str:
    """Return the key of a field: of a shape, its own tag where both have the same."""
    if field == "geometry" and type(before) is type(after):
        return str(getattr(before, "type", field))
    return key_of_field(field)


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
        here = (*path, str(name))
        if name not in before:
            yield Difference(Kind.ADDED, here, None, plain(after[name]), told(after[name]))
        elif name not in after:
            yield Difference(Kind.REMOVED, here, plain(before[name]), None, told(before[name]))
        else:
            yield from _held(here, before[name], after[name], how.about_tag(name))


def _held(path: Path, before: object, after: object, how: How) -> Iterator[Difference]:
    """Yield what differs between two values of a mapping; the order of a list in one means something."""
    match before, after:
        case (list() | tuple(), list() | tuple()) if len(before) == len(after):
            for place, (one, other) in enumerate(zip(before, after, strict=True)):
                yield from _held((*path, str(place)), one, other, how)
        case (list() | tuple(), _) | (_, list() | tuple()):
            yield from _leaf(path, before, after, how)
        case _:
            yield from walk(path, before, after, how)


def _vectors(path: Path, before: Vector3 | Color, after: Vector3 | Color, how: How) -> Iterator[Difference]:
    pairs = zip(before.to_tuple(), after.to_tuple(), strict=True)
    if not all(is_near(one, other, how.tolerance) for one, other in pairs):
        yield Difference(Kind.CHANGED, path, plain(before), plain(after), " → ".join(how.told(before, after)))
    yield from _fields(path, before, after, how, tuple("xyzrgba"))


def _positions(path: Path, before: GroupState, after: GroupState, how: How) -> Iterator[Difference]:
    """Yield what differs in a pose of a group: the positions of its joints."""
    for joint in dict.fromkeys((*after.joint_values, *before.joint_values)):
        before_, after_ = (position_measure(slides=slides) for slides in how.about_joint(joint).slides)
        here = how._replace(measures=(before_, after_))
        one, other = before.joint_values.get(joint), after.joint_values.get(joint)
        if one is None or other is None or len(one) != len(other):
            yield from _leaf((*path, joint), one, other, here)
        else:
            for place, positions in enumerate(zip(one, other, strict=True)):
                yield from walk((*path, joint, *([str(place)] if len(one) > 1 else [])), *positions, here)
