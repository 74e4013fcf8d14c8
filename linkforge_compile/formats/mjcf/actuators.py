"""Actuators in MJCF, from the command interfaces of ros2_control."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.joint import SINGLE_AXIS, Joint, JointType
from linkforge_compile.core.models.ros2_control import Interface, Ros2ControlJoint
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.mjcf.joint_class import JointClass, Settings, Values
from linkforge_compile.formats.mjcf.joints import is_locked, symmetric
from linkforge_compile.formats.xml_text import Xml

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

_TAGS = {"position": "position", "velocity": "velocity", "effort": "motor", "torque": "motor", "force": "motor"}
INTERFACES = tuple(_TAGS)
"""The command interfaces that MuJoCo has actuators for."""

GAINS: Mapping[str, Sequence[str]] = {"position": ("kp", "kv"), "velocity": ("kv",)}
"""The parameters of interfaces that are gains of their actuators, which need the first."""

Range = tuple[float, float]


class Drive(NamedTuple):
    """A joint that hardware commands, by the first of its command interfaces that MuJoCo has an actuator for.

    `others` are its further command interfaces. Two actuators of one joint would act against each other.
    """

    joint: Joint
    hardware: Ros2ControlJoint
    interface: Interface
    others: tuple[Interface, ...]


def drives(robot: Robot) -> Iterator[Drive]:
    """Yield each driven joint once; one that mimics another is moved by that one."""
    seen: set[str] = set()
    for hardware in (joint for system in robot.ros2_controls for joint in system.joints):
        interfaces = [Interface.of(name) for name in hardware.command_interfaces]
        known = next((one for one in interfaces if str(one) in INTERFACES), None)
        if known is None or hardware.name in seen or not robot.has_joint(hardware.name):
            continue
        joint = robot.joints[hardware.name]
        if joint.type in SINGLE_AXIS and not joint.mimic:
            seen.add(joint.name)
            yield Drive(joint, hardware, known, tuple(one for one in interfaces if one is not known))


def actuator_element(drive: Drive, joint_class: JointClass) -> Xml:
    """Return the actuator of a joint, with the range of its command; that of its force is the joint's."""
    tag, gains, source = actuator_settings(drive)
    name = drive.joint.name
    values = joint_class.attributes(tag, gains)
    return leaf_at(tag, source, name=name, joint=name, ctrlrange=_command_range(drive), **values)


def actuator_settings(drive: Drive) -> Settings:
    """Return the gains of the actuator of a joint."""
    interface = str(drive.interface)
    values: Values = {name: _gain(drive, name) for name in GAINS.get(interface, ())}
    return Settings(_TAGS[interface], values, drive.interface.source or drive.hardware.source)


def _command_range(drive: Drive) -> Range | None:
    """Return the range of the commands, which the interface states, or that of the joint."""
    parameters, limits = drive.interface.parameters, drive.joint.limits
    stated = _both(number_of(parameters.get("min")), number_of(parameters.get("max")))
    if stated or limits is None:
        return stated
    match _TAGS[str(drive.interface)]:
        case "velocity":
            return symmetric(limits.velocity)
        case "motor":
            return symmetric(limits.effort)
    has_range = drive.joint.type != JointType.CONTINUOUS and not is_locked(limits)
    return _both(limits.lower, limits.upper) if has_range else None


def has_gain(drive: Drive) -> bool:
    """Whether an actuator that needs a gain has one; MuJoCo's default is 1, too weak for most robots."""
    gains = GAINS.get(str(drive.interface))
    return not gains or _gain(drive, gains[0]) is not None


def _gain(drive: Drive, name: str) -> float | None:
    return number_of(drive.interface.parameters.get(name, drive.hardware.parameters.get(name)))


def number_of(text: str | None) -> float | None:
    """Return the number in a parameter; None without one, as for a text that is none."""
    try:
        number = float(text) if text is not None else math.nan
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def _both(lower: float | None, upper: float | None) -> Range | None:
    return (lower, upper) if lower is not None and upper is not None and lower < upper else None
