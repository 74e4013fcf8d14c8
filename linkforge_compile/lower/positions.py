"""Positions of joints: the unit depends on the type of the joint, which may be written in another file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.lower.fields import Fields, by_word
from linkforge_compile.lower.joint import SUBSTITUTE_LIMITS
from linkforge_compile.lower.numbers import ANGLE_OR_LENGTH, NumberType, Refusal, number_type, si_number
from linkforge_compile.source.span import Located
from linkforge_compile.syntax.nodes import YamlMap, YamlScalar
from linkforge_compile.units import POSITION, Motion


def joints_of(file: YamlMap) -> Mapping[str, YamlMap]:
    """Return the joints that a file itself writes, by name: its `joints` and its `mount`."""
    sections = [section for name in ("joints", "mount") if isinstance(section := file.get(name), YamlMap)]
    entries = (entry for section in sections for entry in section)
    return {entry.name: entry.value for entry in entries if isinstance(entry.value, YamlMap)}


def position_type(joint: Joint | None) -> NumberType:
    """Return what a position of a joint may be: an angle, a length, or either for a joint of unknown type."""
    if joint is None or joint.limits == SUBSTITUTE_LIMITS:
        return ANGLE_OR_LENGTH
    return _position_type(joint.type)


def position_type_of_node(joint: Located | None) -> NumberType:
    """Return what a position may be of the joint that is written at a node."""
    node = joint.child("type") if joint else None
    return _position_type(by_word(JointType).get(node.text) if isinstance(node, YamlScalar) else None)


def _position_type(joint_type: JointType | None) -> NumberType:
    motion = joint_type.motion if joint_type else Motion.UNKNOWN
    return number_type(POSITION, None, Motion.UNKNOWN if motion is Motion.OTHER else motion)


class _Position(NamedTuple):
    """A position under a key of an object that belongs to a joint."""

    joint: str
    fields: Fields
    key: str


def check_positions_of_module_joints(file: Fields, joints: Mapping[str, Joint | None]) -> None:
    """Report positions in a file that are in a wrong unit for a joint of a module.

    They were read as angles or lengths, because the joint was not known yet. `joints` are those of the whole robot.
    """
    own = joints_of(file.node)
    for joint_name, fields, key in (*_in_transmissions(file), *_in_gazebo_blocks(file)):
        node, joint = fields.node.get(key), joints.get(joint_name)
        if node is None or joint is None or joint_name in own:
            continue
        if not isinstance(si_number(node, ANGLE_OR_LENGTH), Refusal):
            fields.number_at(node, key, position_type(joint))


def _in_transmissions(file: Fields) -> Iterator[_Position]:
    transmissions = file.node.get("transmissions")
    for transmission in transmissions if isinstance(transmissions, YamlMap) else ():
        joints = transmission.value.child("joints")
        for entry in joints if isinstance(joints, YamlMap) else ():
            if isinstance(entry.value, YamlMap):
                owner = f"transmission joint '{entry.name}'"
                yield _Position(entry.name, Fields(entry.value, owner, file.sink, file.trail, entry.key), "offset")


def _in_gazebo_blocks(file: Fields) -> Iterator[_Position]:
    for node in file.items("gazebo"):
        reference = node.get("reference") if isinstance(node, YamlMap) else None
        if isinstance(node, YamlMap) and isinstance(reference, YamlScalar):
            block = Fields(node, file.owner, file.sink, file.trail, path="gazebo")
            yield _Position(reference.text, block, "springReference")
