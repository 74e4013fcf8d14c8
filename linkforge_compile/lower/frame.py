"""Frames: named places on links, each an empty link and the fixed joint to it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.lower.elements import lower_origin
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import JointEnds, joint_between


class Frame(NamedTuple):
    """The link and the joint of a frame, None where one is lost; the names are those that it has in any case."""

    link_name: str
    joint_name: str
    link: Link | None = None
    joint: Joint | None = None


def lower_frames(file: Fields) -> Iterator[Frame]:
    """Lower the frames of a file."""
    for name, frame in file.each("frames", "frame", _frame):
        yield frame or Frame(name, f"{name}_joint")


def _frame(fields: Fields, name: str) -> Frame:
    valid = fields.name_is_valid(name, "frame")
    said = fields.text("joint")
    joint_name = f"{name}_joint" if said is None else said
    valid &= said is None or fields.name_is_valid(said, "joint", fields.node.get("joint"))
    ends = JointEnds(fields.text("parent", required="base"), name, lower_origin(fields))
    joint = joint_between(fields, joint_name if valid else None, JointType.FIXED, ends)
    return Frame(name, joint_name, Link(name, source=fields.ref) if joint else None, joint)
