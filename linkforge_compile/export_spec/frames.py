"""Frames: which links of a robot, with the joints to them, a spec can write as frames."""

from __future__ import annotations

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.geometry import written_origin
from linkforge_compile.syntax import YamlMap


def frames_of(robot: Robot) -> list[tuple[Link, Joint]]:
    """Return the empty links at the end of the robot, each with the fixed joint to it and nothing else to say.

    Frames come out behind all other links and joints: an empty link among them stays a link, for it is the order
    that is kept. So does one that a simulator is told something about.
    """
    spoken_of = {element.reference for element in robot.gazebo_elements}
    frames: list[tuple[Link, Joint]] = []
    for link, joint in zip(reversed(tuple(robot.links)), reversed(tuple(robot.joints)), strict=False):
        if not _is_frame(link, joint) or spoken_of & {link.name, joint.name}:
            break
        frames.append((link, joint))
    return frames[::-1]


def written_frame(builder: SpecBuilder, link: Link, joint: Joint) -> YamlMap:
    name = builder.text(joint.name, default=f"{link.name}_joint")
    node = builder.map_of(
        {"parent": builder.text(joint.parent), "origin": written_origin(builder, joint.origin), "joint": name}
    )
    return builder.located(node, link.source or joint.source)


def _is_frame(link: Link, joint: Joint) -> bool:
    if link.name != joint.child or link != Link(link.name):
        return False
    return joint == Joint(joint.name, JointType.FIXED, joint.parent, joint.child, joint.origin)
