"""What drives and simulates the robot names links and joints that are there, and claims each once."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.checks.interfaces import COMMANDS, STATES, interfaces_of
from linkforge_compile.checks.references import Use, unknown
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Code, Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.names import UNKNOWN_GAZEBO_REFERENCE, UNKNOWN_JOINT
from linkforge_compile.diagnostics.codes.physics import COMMANDED_TWICE, FIXED_JOINT_CONTROLLED, READ_TWICE


def check_transmission_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A transmission moves joints of this robot.

    Controllers refuse to load a transmission with a joint that is not there. Correct the name.
    """
    joints = (
        Use(joint.name, f"transmission '{transmission.name}'", joint.source or transmission.source)
        for transmission in robot.transmissions
        for joint in transmission.joints
    )
    yield from unknown(joints, UNKNOWN_JOINT, robot.joints.names, unresolved)


def check_ros2_control_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A ros2_control system drives joints of this robot.

    The controller manager refuses the whole robot for one unknown joint. Correct the name. Sensors and gpios of
    a system are names of the hardware, and need no counterpart in the robot.
    """
    yield from unknown(_driven_joints(robot), UNKNOWN_JOINT, robot.joints.names, unresolved)


def check_fixed_joints_driven(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A joint under ros2_control moves.

    Current controller managers refuse a robot that lists a fixed joint. Leave the joint out of the system, or
    give it the type that it has.
    """
    for use in _driven_joints(robot):
        joint = robot.joints.get(use.name)
        if joint and joint.type == JointType.FIXED:
            yield use.told(FIXED_JOINT_CONTROLLED, joint=joint.name)


def check_interface_claims(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """Each command interface belongs to one ros2_control system, and so does each state interface.

    Of two systems that export one command interface the second is refused or never gets a command; of a state
    interface the second is refused or never read. Take the joint's interface out of one of them; different
    interfaces of one joint may belong to different systems.
    """
    yield from _claimed_twice(robot, COMMANDS, COMMANDED_TWICE)
    yield from _claimed_twice(robot, STATES, READ_TWICE)


def check_gazebo_references(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A Gazebo block with a reference is about a link or joint of this robot.

    Simulators drop other blocks in silence, and with them what they were to set. Correct the reference, or
    remove the block.
    """
    references = (
        Use(element.reference, "Gazebo block", element.source, ("reference",))
        for element in robot.gazebo_elements
        if element.reference is not None
    )
    known = (*robot.links.names, *robot.joints.names) if robot.gazebo_elements else ()
    yield from unknown(references, UNKNOWN_GAZEBO_REFERENCE, known, unresolved)


def _driven_joints(robot: Robot) -> Iterator[Use]:
    for control in robot.ros2_controls:
        for joint in control.joints:
            yield Use(joint.name, f"ros2_control '{control.name}'", joint.source or control.source)


def _claimed_twice(robot: Robot, key: str, code: Code) -> Iterator[Diagnostic]:
    first: dict[str, Use] = {}
    for control in robot.ros2_controls:
        for interface in interfaces_of(control, key):
            use = interface.use
            earlier = first.setdefault(use.name, use)
            if earlier.user != use.user:
                notes = earlier.notes(f"{earlier.user} has it here")
                yield use.told(code, interface=use.name, first=earlier.user, notes=notes)
