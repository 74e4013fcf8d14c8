"""What becomes of links and joints in SDF: bodies and joints, or frames on a body that holds them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_down
from linkforge_compile.core.models.joint import SINGLE_AXIS, Joint, JointType
from linkforge_compile.core.models.sensor import SensorType
from linkforge_compile.formats.kinematic_tree import WORLD, fixed_joints
from linkforge_compile.formats.sdf.settings import LINK_ELEMENTS, OF_FRAME, settings_by_reference
from linkforge_compile.formats.unique_name import unique_name

if TYPE_CHECKING:
    from linkforge_compile.core.models.link import Link
    from linkforge_compile.core.models.robot import Robot

MODEL = "__model__"
"""The frame of the model, where its root link is."""


@dataclass(frozen=True)
class Layout:
    """How the links and joints of a robot are laid out.

    A body of Gazebo has a mass. A link without one is a frame: on the link that a fixed joint holds it to, else on the
    first link with a mass that fixed joints hold to it. `frames` has the link below each frame. `weightless` are the
    links that need a body all the same, and have a minimal mass.
    """

    robot: Robot
    above: Mapping[str, Joint]
    frames: Mapping[str, str]
    carriers: Mapping[str, str]
    weightless: frozenset[str]

    @classmethod
    def of(cls, robot: Robot) -> Layout:
        above, bodies = parent_joints(robot.joints), _links_that_need_bodies(robot)
        holding = child_joints(joint for joint in fixed_joints(robot) if joint.child not in bodies)
        frames: dict[str, str] = {}
        carriers: dict[str, str] = {}
        weightless: set[str] = set()
        for link in robot.links:
            joint = above.get(link.name)
            if _has_mass(link) or (link.name == WORLD and joint is None):
                continue
            if link.name in bodies:
                weightless.add(link.name)
            elif joint and joint.type == JointType.FIXED and not (joint.parent == WORLD and WORLD not in above):
                frames[link.name] = joint.parent
            elif carrier := _first_with_mass(link.name, robot, holding):
                frames[link.name] = carriers[link.name] = carrier
            else:
                weightless.add(link.name)
        return cls(robot, above, frames, carriers, frozenset(weightless))

    def is_world(self, link: str) -> bool:
        """Whether a link is the world itself."""
        return link == WORLD and WORLD not in self.above

    def body_of(self, link: str) -> str:
        """Return the link whose body holds a link: itself, unless that is a frame."""
        return self._bodies.get(link, link)

    @cached_property
    def _bodies(self) -> Mapping[str, str]:
        """The link whose body holds each frame; a long chain of frames is walked once."""
        bodies: dict[str, str] = {}
        for name in self.frames:
            trail: dict[str, None] = {}
            link = name
            while link in self.frames and link not in trail and link not in bodies:
                trail[link] = None
                link = self.frames[link]
            bodies |= dict.fromkeys(trail, bodies.get(link, link))
        return bodies

    @cached_property
    def held(self) -> Mapping[str, Sequence[Link]]:
        """The links that each body holds: itself, and its frames."""
        held: dict[str, list[Link]] = {}
        for link in self.robot.links:
            if not self.is_world(link.name):
                held.setdefault(self.body_of(link.name), []).append(link)
        return held

    def is_joint(self, joint: Joint) -> bool:
        """Whether a joint is one in SDF, where it moves or holds two bodies; any other is a frame."""
        if joint.type == JointType.FIXED:
            return self.body_of(joint.child) != self.body_of(joint.parent)
        return joint.type in SINGLE_AXIS

    @cached_property
    def joint_names(self) -> Mapping[str, str]:
        """The name of each joint: its own, unless a link has it, since links, joints and frames share their names."""
        taken = {link.name for link in self.robot.links}
        names: dict[str, str] = {}
        for joint in self.robot.joints:
            name = f"{joint.name}_joint" if joint.name in taken else joint.name
            names[joint.name] = unique_name(name, taken)
            taken.add(names[joint.name])
        return names

    def is_body(self, link: Link) -> bool:
        """Whether a link is a link in SDF, and neither a frame nor the world."""
        return link.name not in self.frames and not self.is_world(link.name)


def _has_mass(link: Link) -> bool:
    return link.mass > 0


def _links_that_need_bodies(robot: Robot) -> set[str]:
    """Return the links that cannot be frames: a force is sensed in their joint, or they have elements of a body."""
    needed = {one.link_name for one in robot.sensors if one.type == SensorType.FORCE_TORQUE}
    for name, settings in settings_by_reference(robot).items():
        tags = {one.tag for one in settings}
        if name and robot.has_link(name):
            needed |= {name} if tags & LINK_ELEMENTS - OF_FRAME else set()
        elif name and robot.has_joint(name) and "sensor" in tags:
            needed.add(robot.joints[name].child)
    return needed


def _first_with_mass(link: str, robot: Robot, holding: Mapping[str, Sequence[Joint]]) -> str | None:
    """Return the first link with a mass that fixed joints hold to a link, by links without one."""
    return next((one.child for one in walk_down((link,), holding) if _has_mass(robot.links[one.child])), None)
