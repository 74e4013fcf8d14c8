"""No two things of one kind bear one name, and none bears one that ROS or Gazebo refuses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkforge_compile.checks.references import Use
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.names import DUPLICATE_NAME, FRAME_WITH_SLASH, LINK_AND_JOINT, RESERVED_NAME


def check_duplicates(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No two sensors bear one name, and no two transmissions or ros2_control systems.

    Who loads the robot takes the first, the last or none of them. Rename one. Two modules keep apart what is in
    them by their prefixes. Links and joints of one name never get as far as this.
    """
    yield from _borne_twice("sensor", (Use(each.name, "", each.source) for each in robot.sensors))
    yield from _borne_twice("transmission", (Use(each.name, "", each.source) for each in robot.transmissions))
    yield from _borne_twice("ros2_control system", (Use(each.name, "", each.source) for each in robot.ros2_controls))


def check_semantic_duplicates(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No two planning groups bear one name, and no two end effectors, virtual joints or states of a group.

    MoveIt takes the first group of a name and the last state, and says so in its log at best. Rename one.
    """
    semantic = robot.semantic
    yield from _borne_twice("planning group", (Use(each.name, "", each.source) for each in semantic.groups))
    yield from _borne_twice("end effector", (Use(each.name, "", each.source) for each in semantic.end_effectors))
    yield from _borne_twice("virtual joint", (Use(each.name, "", each.source) for each in semantic.virtual_joints))
    yield from _borne_twice("passive joint", (Use(each.name, "", each.source) for each in semantic.passive_joints))
    states: dict[str, list[Use]] = {}
    for state in semantic.group_states:
        states.setdefault(state.group, []).append(Use(state.name, f"planning group '{state.group}'", state.source))
    for uses in states.values():
        yield from _borne_twice("group state", uses)


def check_link_and_joint_names(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No joint bears the name of a link.

    URDF and ROS keep links and joints apart. In Gazebo both are frames of one model: it refuses the second, and
    with it all that hangs below. Rename the joint: `wrist_joint` beside the link `wrist`.
    """
    for joint in robot.joints:
        if link := robot.links.get(joint.name):
            notes = Use(link.name, "", link.source).notes("the link stands here") if link.source else ()
            yield Use(joint.name, "", joint.source).told(LINK_AND_JOINT, name=joint.name, notes=notes)


def check_reserved_names(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No link or joint bears a name that Gazebo keeps for itself.

    Those are `world`, unless it is the root link, which Gazebo takes for the world itself, and all that begin and
    end with two underscores, such as `__model__`.
    """
    hanging = {joint.child for joint in robot.joints}
    for link in robot.links:
        if _is_reserved(link.name) and (link.name != "world" or "world" in hanging):
            yield Use(link.name, "", link.source).told(RESERVED_NAME, kind="link", name=link.name)
    for joint in robot.joints:
        if _is_reserved(joint.name):
            yield Use(joint.name, "", joint.source).told(RESERVED_NAME, kind="joint", name=joint.name)


def _is_reserved(name: str) -> bool:
    return name == "world" or (len(name) >= len("____") and name.startswith("__") and name.endswith("__"))


def check_frame_names(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No link and no frame of a sensor begins with a slash.

    Each is a frame to tf2, which strips the slash where a transform is published and refuses it where one is
    asked for. Leave it out.
    """
    for link in robot.links:
        if link.name.startswith("/"):
            yield Use(link.name, "", link.source).told(FRAME_WITH_SLASH, name=link.name)
    for sensor in robot.sensors:
        if sensor.frame and sensor.frame.startswith("/"):
            yield Use(sensor.frame, "", sensor.source, ("frame",)).told(FRAME_WITH_SLASH, name=sensor.frame)


def _borne_twice(kind: str, bearers: Iterable[Use]) -> Iterator[Diagnostic]:
    first: dict[str, Use] = {}
    for bearer in bearers:
        earlier = first.setdefault(bearer.name, bearer)
        if earlier is not bearer:
            notes = earlier.notes(f"the first {kind} '{bearer.name}'") if earlier.source else []
            yield bearer.told(DUPLICATE_NAME, kind=kind, name=bearer.name, notes=notes)
