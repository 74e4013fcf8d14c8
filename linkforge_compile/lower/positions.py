"""Positions of joints that modules bring: in what each is measured shows once the robots are joined."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.models.joint import Joint
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import joints_of, position_type
from linkforge_compile.lower.numbers import Refusal, si_number
from linkforge_compile.syntax.nodes import YamlMap, YamlNode, YamlScalar


class _Position(NamedTuple):
    """A position of a joint, said by an object that is not the joint: which joint, and the object with the field."""

    joint: str
    fields: Fields
    key: str


def check_positions_of_module_joints(file: Fields, joints: Mapping[str, Joint | None]) -> None:
    """Report positions of joints that the file does not write, where they are no such position.

    They were read as of any joint: an angle or a length. `joints` are those of the whole robot.
    """
    own = joints_of(file.node)
    for position in (*_in_transmissions(file), *_in_gazebo_blocks(file)):
        said, joint = position.fields.node.get(position.key), joints.get(position.joint)
        if said is None or joint is None or position.joint in own:
            continue
        if not isinstance(si_number(said, position_type(None)), Refusal):
            position.fields.number_at(said, position.key, position_type(joint))


def _in_transmissions(file: Fields) -> Iterator[_Position]:
    for transmission in _maps(file.node.get("transmissions")):
        joints = transmission.get("joints")
        for entry in joints if isinstance(joints, YamlMap) else ():
            if isinstance(entry.value, YamlMap):
                owner = f"transmission joint '{entry.name}'"
                yield _Position(entry.name, Fields(entry.value, owner, file.sink, file.trail, entry.key), "offset")


def _in_gazebo_blocks(file: Fields) -> Iterator[_Position]:
    for node in file.items("gazebo"):
        about = node.get("reference") if isinstance(node, YamlMap) else None
        if isinstance(node, YamlMap) and isinstance(about, YamlScalar):
            yield _Position(
                about.text, Fields(node, file.owner, file.sink, file.trail, path="gazebo"), "springReference"
            )


def _maps(section: YamlNode | None) -> Iterator[YamlMap]:
    entries = section if isinstance(section, YamlMap) else ()
    yield from (entry.value for entry in entries if isinstance(entry.value, YamlMap))
