"""What keeps MoveIt from planning for a robot, or from executing a plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

from linkforge_compile.core.models.controller import Controller
from linkforge_compile.core.models.controller_kinds import KINDS, OTHER_CLASSES, STATES, kind_of, lift_parameters
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.collisions import ADJACENT_CHECKED
from linkforge_compile.diagnostics.codes.formats import (
    NO_GROUP_TO_PLAN,
    NO_JOINT_STATES,
    NO_SOLVER,
    NOTHING_EXECUTES,
    UNKNOWN_OF_SOLVER,
)
from linkforge_compile.diagnostics.enumerations import listed
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.formats.groups import chain_groups, faulty_groups, joints_by_group
from linkforge_compile.formats.moveit.view import SOLVER_PARAMETERS, executing_controllers, moveit_view
from linkforge_compile.formats.ros2_controllers.complete import (
    commanded_joints,
    complete_controllers,
    has_faulty_names,
    misspelled_class,
)
from linkforge_compile.source import Key


def missing_groups(robot: Robot) -> Diagnostic | None:
    """Return why a robot has no configuration; None if it has one."""
    if any(joints_by_group(robot).values()):
        return None
    return NO_GROUP_TO_PLAN.at(robot.source, "name", robot=robot.name)


def check_solvers(robot: Robot) -> Iterator[Diagnostic]:
    """Names of a solver's parameters are spelled as MoveIt reads them, and chains of several joints have a solver."""
    joints, with_solver = joints_by_group(robot), {view.name for view in moveit_view(robot).groups}
    chains = chain_groups(robot)
    for group in robot.semantic.groups if joints else ():
        for name in group.kinematics:
            if name not in SOLVER_PARAMETERS and nearest(name, SOLVER_PARAMETERS):
                place = ("kinematics", Key(name))
                yield UNKNOWN_OF_SOLVER.at(group.source, *place, name=name, near=SOLVER_PARAMETERS)
        if group.name not in with_solver and group.name in chains and len(joints[group.name]) > 1:
            yield NO_SOLVER.at(group.source, group=group.name)


def check_joint_states(robot: Robot) -> Iterator[Diagnostic]:
    """A controller publishes the states of the joints; one of a class that is not known may do so."""
    types = {one.type for one in complete_controllers(robot)}
    if robot.ros2_controls and STATES not in types and types <= {*KINDS, *OTHER_CLASSES}:
        yield NO_JOINT_STATES.at(robot.source, "controllers")


def check_execution(robot: Robot) -> Iterator[Diagnostic]:
    """The joints of each planning group are those of controllers that MoveIt can send motions to."""
    if any(map(partial(_is_faulty, robot), map(lift_parameters, robot.controllers))):
        return
    controlled = {name for one in executing_controllers(robot) for name in one.joints}
    groups, faulty, hardware = joints_by_group(robot), faulty_groups(robot), commanded_joints(robot)
    for group in robot.semantic.groups if groups else ():
        joints = [joint.name for joint in groups[group.name]]
        missing = [name for name in joints if name not in controlled]
        if missing and group.name not in faulty:
            yield NOTHING_EXECUTES.at(group.source, group=group.name, reason=_reason(robot, joints, missing, hardware))


def _is_faulty(robot: Robot, controller: Controller) -> bool:
    """Return whether the joints of a controller are not known, because of its names, its class or its parameters."""
    is_misread = not controller.joints and kind_of(controller.type).parameters.get("joints") in controller.parameters
    return is_misread or has_faulty_names(robot, controller) or misspelled_class(controller.type) is not None


def _reason(robot: Robot, joints: list[str], missing: list[str], hardware: Mapping[str, object]) -> str:
    """Return why no controllers have the joints of a group."""
    if not robot.ros2_controls:
        return "the robot has no `ros2_control`; add it"
    if hardware.keys().isdisjoint(joints):
        return "none of its joints has a command interface in `ros2_control`"
    uncommanded = [name for name in missing if name not in hardware]
    if uncommanded:
        verb = "has" if len(uncommanded) == 1 else "have"
        return f"{listed(uncommanded, 'and')} {verb} no command interface in `ros2_control`"
    return f"no controller of trajectories has {listed(missing, 'and')}"


def check_adjacent_links(robot: Robot) -> Iterator[Diagnostic]:
    """Two links with collisions that a joint connects are a pair of the self-collision matrix.

    Neighbors usually touch, so that every state of the robot would be in collision. A pair in `enabled_collisions`, and
    links without default collisions, are decided already.
    """
    if not robot.has_semantic:
        return
    semantic = robot.semantic
    decided = {
        frozenset((pair.link1, pair.link2)) for pair in (*semantic.disabled_collisions, *semantic.enabled_collisions)
    }
    off = frozenset(semantic.no_default_collision_links)
    with_shapes = {link.name for link in robot.links if link.collisions}
    for parent, child in _adjacent_links(robot, with_shapes):
        if frozenset((parent, child)) not in decided and off.isdisjoint((parent, child)):
            place = (robot.source, "semantic", "disabled_collisions")
            yield ADJACENT_CHECKED.at(*place, pair=f"{parent} and {child}")


def _adjacent_links(robot: Robot, with_shapes: set[str]) -> Iterator[tuple[str, str]]:
    """Yield each link with collisions after the nearest one above it that has some, unless it can float away."""
    above = {joint.child: joint for joint in robot.joints}
    for link in robot.links:
        joint = above.get(link.name) if link.name in with_shapes else None
        while joint and joint.type not in (JointType.FLOATING, JointType.PLANAR):
            if joint.parent in with_shapes:
                yield joint.parent, link.name
                break
            joint = above.get(joint.parent)
