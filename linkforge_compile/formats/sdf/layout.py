"""What becomes of links and joints in SDF: bodies and joints, or frames on a body that holds them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_down
from linkforge_compile.core.models.joint import SINGLE_AXIS, Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.sensor import ForceTorqueFrame, SensorType
from linkforge_compile.core.naming import unique_name
from linkforge_compile.core.poses import NO_TURN, Pose
from linkforge_compile.formats.kinematic_tree import WORLD, fixed_joints
from linkforge_compile.formats.sdf.raw_sensors import frames_of_forces
from linkforge_compile.formats.sdf.settings import LINK_ELEMENTS, OF_FRAME, Settings, settings_by_reference

MODEL = "__model__"
"""The frame of the model, where its root link is."""


@dataclass(frozen=True)
class Layout:
    """How the links and joints of a robot are laid out.

    A body of Gazebo has a mass. A link without one is a frame: on the link that a fixed joint holds it to, else on the
    first link with a mass that fixed joints hold to it. `frames` has the link below each frame. `weightless` are the
    links that need a body all the same, and have a minimal mass, such as that of a force-torque sensor, which is in a
    joint of two bodies. `own_settings` are those of Gazebo, as written.
    """

    robot: Robot
    own_settings: Mapping[str | None, Settings]
    above: Mapping[str, Joint]
    frames: Mapping[str, str]
    carriers: Mapping[str, str]
    weightless: frozenset[str]

    @classmethod
    def of(cls, robot: Robot) -> Layout:
        above, settings = parent_joints(robot.joints), settings_by_reference(robot)
        bodies, sensed = _links_that_need_bodies(robot, settings), _axes_of_forces(robot, settings)
        blocked = {*bodies, *sensed}
        holding = child_joints(joint for joint in fixed_joints(robot) if joint.child not in blocked)
        frames: dict[str, str] = {}
        carriers: dict[str, str] = {}
        weightless: set[str] = set()
        for link in robot.links:
            name, joint = link.name, above.get(link.name)
            if _has_mass(link) or (name == WORLD and joint is None):
                continue
            is_held = joint and joint.type == JointType.FIXED and not (joint.parent == WORLD and WORLD not in above)
            if name in bodies:
                weightless.add(name)
            elif joint and is_held and name not in sensed:
                frames[name] = joint.parent
            elif carrier := _carrier(name, robot, holding, above, sensed.get(name, frozenset())):
                frames[name] = carriers[name] = carrier
            else:
                weightless.add(name)
        return cls(robot, settings, above, frames, carriers, frozenset(weightless))

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

    @cached_property
    def settings(self) -> Mapping[str | None, Settings]:
        """The settings of Gazebo; sensors of a joint are those of the link below it, which has the frame of the joint.

        Force-torque sensors stay. SDF allows all others in joints as well, but Gazebo Sim moves only those of links.
        """
        settings = dict(self.own_settings)
        for joint in self.robot.joints:
            own = settings.get(joint.name, ())
            sensors = [one for one in own if one.tag == "sensor" and not any(frames_of_forces(one))]
            if sensors:
                settings[joint.name] = [one for one in own if one not in sensors]
                settings[joint.child] = [*settings.get(joint.child, ()), *sensors]
        return settings

    def is_body(self, link: Link) -> bool:
        """Whether a link is a link in SDF, and neither a frame nor the world."""
        return link.name not in self.frames and not self.is_world(link.name)


def _has_mass(link: Link) -> bool:
    return link.mass > 0


def _links_that_need_bodies(robot: Robot, settings: Mapping[str | None, Settings]) -> Set[str]:
    """Return the links that cannot be frames, as they have elements of a body."""
    of_bodies = LINK_ELEMENTS - OF_FRAME
    return {link.name for link in robot.links if any(one.tag in of_bodies for one in settings.get(link.name, ()))}


def _axes_of_forces(robot: Robot, settings: Mapping[str | None, Settings]) -> Mapping[str, Set[str]]:
    """Return the links in whose joint forces are sensed, with the frames of the axes: parent, child or sensor."""
    axes: dict[str, set[str]] = defaultdict(set)
    for sensor in robot.sensors:
        if sensor.type == SensorType.FORCE_TORQUE:
            info = sensor.force_torque_info
            axes[sensor.link_name].add(info.frame if info else ForceTorqueFrame.CHILD)
    for joint in robot.joints:
        for frame in chain.from_iterable(map(frames_of_forces, settings.get(joint.name, ()))):
            axes[joint.child].add(frame)
    return axes


def _carrier(
    link: str, robot: Robot, holding: Mapping[str, Sequence[Joint]], above: Mapping[str, Joint], axes: Set[str]
) -> str | None:
    """Return the first link with a mass that fixed joints hold to a link, by links without one.

    Gazebo turns a force in the axes of the child into those of the carrier, which must be parallel to them.
    """
    carrier = next((one.child for one in walk_down((link,), holding) if _has_mass(robot.links[one.child])), None)
    is_turned = carrier and relative_pose(carrier, link, above).turn != NO_TURN
    return None if is_turned and ForceTorqueFrame.CHILD in axes else carrier


_HERE = Pose((0.0, 0.0, 0.0), NO_TURN)


def relative_pose(link: str, base: str, above: Mapping[str, Joint]) -> Pose:
    """Return the pose of a link in the frame of another one of its tree, while all joints are at zero."""
    pose, top = _pose_below(base, link, above)
    return pose if top == base else _pose_below(top, base, above)[0].inverse.times(pose)


def _pose_below(base: str, link: str, above: Mapping[str, Joint]) -> tuple[Pose, str]:
    """Return the pose of a link in the frame of one above it, and that link: the root if the base is not above it."""
    pose, seen = _HERE, {base}
    while link not in seen and link in above:
        seen.add(link)
        pose, link = Pose.of(above[link].origin).times(pose), above[link].parent
    return pose, link
