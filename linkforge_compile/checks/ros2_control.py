"""ros2_control and transmissions: the joints that they drive, and interfaces with their ranges."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sized
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.checks.joints import WITHIN_LIMITS, missed_range
from linkforge_compile.checks.names import Reference, report_unknown
from linkforge_compile.core.models.joint import JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Code, Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import PASSIVE_COMMANDED
from linkforge_compile.diagnostics.codes.names import UNKNOWN_JOINT
from linkforge_compile.diagnostics.codes.physics import (
    COMMANDED_TWICE,
    FIXED_JOINT_CONTROLLED,
    MIMIC_APART,
    MIMIC_COMMANDED,
    NO_INTERFACE,
    NO_MIMIC,
    PARAMETER_NO_NUMBER,
    RANGE_CROSSED,
    RANGE_FAR_BEYOND,
    RANGE_OUTSIDE_LIMITS,
    READ_TWICE,
    STARTS_OUTSIDE_LIMITS,
    UNKNOWN_INTERFACE,
)
from linkforge_compile.diagnostics.entry_fixes import leave_out
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.source import SourceRef

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.ros2_control import (
        Ros2Control,
        Ros2ControlGpio,
        Ros2ControlJoint,
        Ros2ControlSensor,
    )

    Component: TypeAlias = Ros2ControlJoint | Ros2ControlGpio | Ros2ControlSensor


def check_transmission_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A transmission moves joints of this robot.

    Controllers refuse to load a transmission with a joint that is not there. Correct the name.
    """
    joints = (
        Reference(joint.name, f"transmission '{transmission.name}'", joint.source or transmission.source)
        for transmission in robot.transmissions
        for joint in transmission.joints
    )
    yield from report_unknown(joints, UNKNOWN_JOINT, robot.joints.names, unresolved)


def check_ros2_control_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A ros2_control system drives joints of this robot.

    The controller manager refuses the whole robot for one unknown joint. Correct the name. Sensors and gpios of
    a system are names of the hardware, and need no counterpart in the robot.
    """
    yield from report_unknown(_driven_joints(robot), UNKNOWN_JOINT, robot.joints.names, unresolved)


def check_fixed_joints_driven(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A joint under ros2_control moves.

    Current controller managers refuse a robot that lists a fixed joint. Leave the joint out of the system, or
    give it the type that it has.
    """
    for ref in _driven_joints(robot):
        joint = robot.joints.get(ref.name)
        if joint and joint.type == JointType.FIXED:
            yield ref.report(FIXED_JOINT_CONTROLLED, joint=joint.name)


def check_interface_claims(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """Each command interface belongs to one ros2_control system, and so does each state interface.

    Of two systems that export one command interface the second is refused or never gets a command; of a state
    interface the second is refused or never read. Take the joint's interface out of one of them; different
    interfaces of one joint may belong to different systems.
    """
    yield from _claimed_twice(robot, COMMANDS, COMMANDED_TWICE)
    yield from _claimed_twice(robot, STATES, READ_TWICE)


def check_passive_joints(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A passive joint has no command interface.

    MoveIt never plans for a passive joint, so its command interface in ros2_control waits for ever. Drop the
    command interface, or the joint from `passive_joints`.
    """
    passive = {joint.name: joint for joint in robot.semantic.passive_joints}
    for control in robot.ros2_controls if passive else ():
        for driven in control.joints:
            joint = passive.get(driven.name)
            if joint and driven.command_interfaces:
                command = Reference(
                    joint.name, f"ros2_control '{control.name}'", driven.source, ("command_interfaces",)
                )
                notes = [command.note(f"{command.user} commands it")]
                yield PASSIVE_COMMANDED.at(joint.source, joint=joint.name, control=control.name, notes=notes)


def _driven_joints(robot: Robot) -> Iterator[Reference]:
    for control in robot.ros2_controls:
        for joint in control.joints:
            yield Reference(joint.name, f"ros2_control '{control.name}'", joint.source or control.source)


def _claimed_twice(robot: Robot, key: str, code: Code) -> Iterator[Diagnostic]:
    first: dict[str, Reference] = {}
    for control in robot.ros2_controls:
        parts: tuple[Component, ...] = (*control.joints, *control.gpios, *control.sensors)
        for ref in [interface.ref for part in parts for interface in _interfaces_of(control, part, key)]:
            earlier = first.setdefault(ref.name, ref)
            if earlier.user != ref.user:
                notes = earlier.notes(f"{earlier.user} has it here")
                yield ref.report(code, interface=ref.name, first=earlier.user, notes=notes)


MOTIONS = ("position", "velocity", "acceleration", "effort")
"""The interfaces of joints that controllers ask for by these names."""

KNOWN_INTERFACES = (*MOTIONS, "jerk", "torque", "force", "current", "temperature")
"""All that ros2_control has a name for."""

BOUNDED_BOTH_WAYS = ("position", "velocity", "effort")
"""The interfaces whose `min` and `max` are the ends of one range; of an acceleration they are two amounts."""

FAR, UNBOUNDED = 10.0, 1e4
"""How many times the limit of its joint a range reaches that is in another unit; beyond, it is no limit."""

COMMANDS, STATES = "command_interfaces", "state_interfaces"


class Interface(NamedTuple):
    """An interface of a joint, a sensor or a gpio with its parameters, texts by name."""

    name: str
    ref: Reference
    parameters: Mapping[str, str]


def _interfaces_of(control: Ros2Control, part: Component, key: str) -> Iterator[Interface]:
    """Yield the command or the state interfaces of a part, referred to by their full names: `shoulder/position`."""
    for interface in getattr(part, key, ()):
        source: SourceRef | None = getattr(interface, "source", None)  # a plain string has neither
        parameters: Mapping[str, str] = getattr(interface, "parameters", {})
        full = f"{part.name}/{interface}"
        ref = Reference(full, f"ros2_control '{control.name}'", source or part.source, () if source else (key,))
        yield Interface(str(interface), ref, parameters)


def check_interface_names(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The interface of a joint has one of ros2_control's names, if its own name is similar.

    Controllers ask for `position`, `velocity`, `acceleration` or `effort`, and refuse to start where hardware
    offers a `postion`. Correct the name. What is like none of these is an interface of the hardware's own, and
    is not reported.
    """
    for control in robot.ros2_controls:
        for joint in control.joints:
            for key in (COMMANDS, STATES):
                for name, ref, _parameters in _interfaces_of(control, joint, key):
                    if name.isalpha() and name not in KNOWN_INTERFACES and nearest(name, MOTIONS):
                        yield ref.report(UNKNOWN_INTERFACE, name=name, near=MOTIONS)


def check_interface_parameters(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """`min`, `max` and `initial_value` of an interface are numbers that go with one another and with the joint.

    ros2_control reads plain numbers in SI units, [rad] or [m] and their rates: the parameters of hardware are
    passed on as they are written, so `-90 deg` stays text, which it skips. Write `$(radians(-90))`. Of the
    range here and the limits of the joint it takes the narrower one, so that a range beyond the limits leaves no
    position, and one that reaches ten times as far as the joint, in degrees or millimetres, bounds nothing; and mock
    hardware starts at the initial value, from where MoveIt plans nothing if that is outside.
    """
    for control in robot.ros2_controls:
        for driven in control.joints:
            joint = robot.joints.get(driven.name)
            for key in (COMMANDS, STATES):
                for interface in _interfaces_of(control, driven, key):
                    if interface.parameters and interface.name in MOTIONS:
                        yield from _faults_of_parameters(interface, joint)


def _faults_of_parameters(interface: Interface, joint: Joint | None) -> Iterator[Diagnostic]:
    numbers: dict[str, float] = {}
    for parameter in ("min", "max", "initial_value"):
        text = interface.parameters.get(parameter, "").strip()
        number = _number(text) if text else None
        if number is not None:
            numbers[parameter] = number
        elif text:
            yield _at(interface, parameter).report(PARAMETER_NO_NUMBER, parameter=parameter, found=text)
    lowest, highest, start = (numbers.get(parameter) for parameter in ("min", "max", "initial_value"))
    if lowest is not None and highest is not None and interface.name in BOUNDED_BOTH_WAYS:
        place, low, high = _at(interface, "min"), f"{lowest:.6g}", f"{highest:.6g}"
        if lowest > highest:
            yield place.report(RANGE_CROSSED, min=low, max=high)
        elif joint and interface.name == "position" and (span := missed_range(joint, lowest, highest)):
            yield place.report(RANGE_OUTSIDE_LIMITS, joint=joint.name, range=span, min=low, max=high)
        elif joint:
            yield from _far_beyond(interface, joint, lowest, highest)
    if joint and start is not None and interface.name == "position" and (span := missed_range(joint, start, start)):
        place = _at(interface, "initial_value")
        yield place.report(STARTS_OUTSIDE_LIMITS, joint=joint.name, range=span, found=f"{start:.6g}")


def _far_beyond(interface: Interface, joint: Joint, lowest: float, highest: float) -> Iterator[Diagnostic]:
    """Report a range that is far wider than the joint's limit, probably in a wrong unit."""
    reach, units = max(abs(lowest), abs(highest)), _SI.get(joint.type)
    limit = _limit(interface.name, joint)
    if not units or not limit or not FAR <= reach / limit < UNBOUNDED:
        return
    parameter, found = ("max", highest) if abs(highest) >= abs(lowest) else ("min", lowest)
    shown = f"{found:.6g}"
    new = ""
    if interface.name == "effort":
        remedy = in_si = "correct one of them"
    elif units is _SLIDING:
        new = f"$({shown} / 1000)"
        remedy = f"write '{new}' if you mean millimetres"
        in_si = f"write '{found / 1000:.6g}' if you mean millimetres"
    else:
        new = f"$(radians({shown}))"
        remedy = f"write '{new}' if you mean degrees"
        in_si = f"write '{math.radians(found):.6g}' if you mean degrees"
    fault = _at(interface, parameter).report(
        RANGE_FAR_BEYOND,
        interface=f"interface '{interface.name}'",
        joint=joint.name,
        found=shown,
        limit=f"{limit:.6g}",
        si=units[interface.name],
        remedy=remedy,
        in_si=in_si,
    )
    yield fault.replacing(shown, new) if new else fault


_TURNING = {"position": "rad", "velocity": "rad/s", "effort": "N*m"}
_SLIDING = {"position": "m", "velocity": "m/s", "effort": "N"}
_SI: dict[str, Mapping[str, str]] = {
    JointType.REVOLUTE: _TURNING,
    JointType.CONTINUOUS: _TURNING,
    JointType.PRISMATIC: _SLIDING,
}
"""The units of the interfaces in BOUNDED_BOTH_WAYS, by the type of a joint that goes along or about one axis."""


def _limit(interface: str, joint: Joint) -> float | None:
    """Return how far, how fast or how hard a joint moves at most [SI]; None without such a limit."""
    limits = joint.limits
    if limits is None or interface != "position":
        return getattr(limits, interface, None)
    ends = (limits.lower, limits.upper) if joint.type in WITHIN_LIMITS else ()
    return max((abs(end) for end in ends if end is not None), default=None)


def _at(interface: Interface, parameter: str) -> Reference:
    return interface.ref._replace(path=(*interface.ref.path, parameter))


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def check_mimics_in_hardware(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A joint in ros2_control that mimics another has no command interface, and its leader is in the same system.

    Since ROS 2 Jazzy the controller manager takes the mimic from the robot's description, and refuses the robot
    if such a joint has a command interface, or if its leader is not in the same system. Where the hardware drives
    both joints by itself, write `extra_attributes: {mimic: "false"}` on the joint in `ros2_control`. In turn
    `mimic: "true"` wants a joint with `mimic`. A leader is not reported while a joint of the system could not be read.
    """
    for control in robot.ros2_controls:
        listed = {joint.name for joint in control.joints}
        for driven in control.joints:
            joint = robot.joints.get(driven.name)
            mimic = dict(driven.extra_attributes).get("mimic")
            has_mimic = mimic in {"true", "True"}
            ref = Reference(driven.name, f"ros2_control '{control.name}'", driven.source)
            if joint is None or (mimic is not None and not has_mimic):
                continue
            if joint.mimic is None:
                if has_mimic:
                    yield ref._replace(path=("extra_attributes", "mimic")).report(NO_MIMIC, joint=joint.name)
            elif driven.command_interfaces:
                ref = ref._replace(path=(COMMANDS,))
                fault = ref.report(MIMIC_COMMANDED, joint=joint.name, leader=joint.mimic.joint)
                yield fault.with_fix(leave_out(driven.source, COMMANDS))
            elif (
                joint.mimic.joint not in listed
                and robot.has_joint(joint.mimic.joint)
                and not _has_dropped_joint(control)
            ):
                yield ref.report(MIMIC_APART, joint=joint.name, leader=joint.mimic.joint)


def _has_dropped_joint(control: Ros2Control) -> bool:
    """Return whether a joint of a system was dropped because of an error."""
    written = control.source.node.child("joints") if control.source else None
    return isinstance(written, Sized) and len(written) > len(control.joints)


def check_hardware_is_used(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A sensor, a gpio or a whole system in ros2_control has an interface.

    Controllers reach hardware by its interfaces alone. Add `state_interfaces` or `command_interfaces`; nothing
    is wrong if the hardware's plugin makes its interfaces by itself. A gpio with nothing in it is not reported: it is
    what is left of a vendor's where no pin is configured.
    """
    for control in robot.ros2_controls:
        parts = ("joints", "gpios", "sensors")
        idle = [
            *((f"ros2_control '{control.name}'", each.source) for each in (control,) if _lacks(each, *parts)),
            *(
                (f"gpio '{each.name}'", each.source)
                for each in control.gpios
                if _lacks(each, COMMANDS, STATES) and each.parameters
            ),
            *((f"sensor '{each.name}'", each.source) for each in control.sensors if _lacks(each, STATES)),
        ]
        for owner, source in idle:
            yield Reference("", f"ros2_control '{control.name}'", source).report(NO_INTERFACE, owner=owner)


def _lacks(part: Ros2Control | Ros2ControlGpio | Ros2ControlSensor, *keys: str) -> bool:
    """Return whether nothing is written under the keys, not even what was dropped because of an error."""
    node = part.source.node if part.source else None
    return not any(getattr(part, key) or (node and node.child(key)) for key in keys)
