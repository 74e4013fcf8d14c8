"""Actuators in MJCF, from the command interfaces of ros2_control."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.ros2_control import Interface, Ros2ControlJoint
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.mjcf.joints import SINGLE, is_locked, symmetric
from linkforge_compile.formats.xml_text import Xml

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

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
        known = next((one for one in interfaces if str(one) in _MAKERS), None)
        if known is None or hardware.name in seen or not robot.has_joint(hardware.name):
            continue
        joint = robot.joints[hardware.name]
        if joint.type in SINGLE and not joint.mimic:
            seen.add(joint.name)
            yield Drive(joint, hardware, known, tuple(one for one in interfaces if one is not known))


def actuator_element(drive: Drive) -> Xml:
    """Return the actuator of a joint, with the range of its command; that of its force is the joint's."""
    return _MAKERS[str(drive.interface)](drive)


def _position(drive: Drive) -> Xml:
    limits = drive.joint.limits
    reach = None
    if drive.joint.type != JointType.CONTINUOUS and limits and not is_locked(limits):
        reach = _both(limits.lower, limits.upper)
    return _element("position", drive, reach, kp=_gain(drive, "kp"), kv=_gain(drive, "kv"))


def _velocity(drive: Drive) -> Xml:
    limits = drive.joint.limits
    return _element("velocity", drive, symmetric(limits.velocity) if limits else None, kv=_gain(drive, "kv"))


def _effort(drive: Drive) -> Xml:
    limits = drive.joint.limits
    return _element("motor", drive, symmetric(limits.effort) if limits else None)


_MAKERS: Mapping[str, Callable[[Drive], Xml]] = {"position": _position, "velocity": _velocity, "effort": _effort}

INTERFACES = tuple(_MAKERS)
"""The command interfaces that MuJoCo has actuators for."""

GAINS = {"position": "kp", "velocity": "kv"}
"""The parameter that is the gain of an actuator."""


def _element(tag: str, drive: Drive, reach: Range | None, **gains: float | None) -> Xml:
    parameters = drive.interface.parameters
    stated = _both(number_of(parameters.get("min")), number_of(parameters.get("max")))
    source = drive.interface.source or drive.hardware.source
    name = drive.joint.name
    return leaf_at(tag, source, name=name, joint=name, ctrlrange=stated or reach, **gains)


def has_gain(drive: Drive) -> bool:
    """Whether an actuator that needs a gain has one; MuJoCo's default is 1, too weak for most robots."""
    needed = GAINS.get(str(drive.interface))
    return needed is None or _gain(drive, needed) is not None


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
