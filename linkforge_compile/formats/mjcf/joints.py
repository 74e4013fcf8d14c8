"""Joints in MJCF, the equalities that hold some of them, and their actuators."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.models.geometry import IDENTITY, Vector3
from linkforge_compile.core.models.joint import AXES, SINGLE_AXIS, Joint, JointLimits, JointType
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface, Ros2ControlJoint
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.kinematic_tree import WORLD, leader_of
from linkforge_compile.formats.xml_text import Spellable, Xml
from linkforge_compile.source import SourceRef
from linkforge_compile.units import finite_number

Values: TypeAlias = Mapping[str, Spellable | None]
"""Attributes by name; None for none."""

NAME = "joint"


class Settings(NamedTuple):
    """The values of a joint, or of the actuator of one, by its tag, and where they are written."""

    tag: str
    values: Values
    source: SourceRef | None


class JointClass(NamedTuple):
    """By tag, the settings that more than half of its elements have, and two at least."""

    settings: Mapping[str, Settings]

    @classmethod
    def of(cls, all_settings: Sequence[Settings]) -> JointClass:
        elements = Counter(one.tag for one in all_settings)
        sharing = Counter(map(_key, all_settings))
        common: dict[str, Settings] = {}
        for one in all_settings:
            has_values = any(value is not None for value in one.values.values())
            if has_values and sharing[_key(one)] > max(1, elements[one.tag] / 2):
                common.setdefault(one.tag, one)
        return cls(common)

    def attributes(self, tag: str, values: Values) -> dict[str, Spellable | None]:
        """Return the reference to this class for the values that it has, other values themselves."""
        known = self.settings.get(tag)
        return {"class": NAME} if known and known.values == values else dict(values)

    def elements(self) -> Sequence[Xml]:
        """Return what `<default>` contains for this class."""
        return [leaf_at(tag, source, **values) for tag, values, source in self.settings.values()]


def _key(settings: Settings) -> tuple[str, tuple[tuple[str, Spellable | None], ...]]:
    return settings.tag, tuple(settings.values.items())


_X, _Y, _Z = (AXES[name] for name in "xyz")


def joint_elements(joint: Joint, joint_class: JointClass) -> tuple[Xml, ...]:
    """Return the joints of MuJoCo that let a body move as a joint does: none, one or several."""
    maker = _MAKERS.get(joint.type)
    return maker(joint, joint_class) if maker else ()


def joint_settings(joint: Joint) -> Settings:
    """Return the dynamics of a joint of one axis."""
    limits, dynamics = joint.limits, joint.dynamics
    values: Values = {
        "damping": (dynamics.damping or None) if dynamics else None,
        "frictionloss": (dynamics.friction or None) if dynamics else None,
        "actuatorfrcrange": symmetric(limits.effort) if limits else None,
    }
    return Settings("joint", values, (dynamics or limits or joint).source or joint.source)


def _single(joint: Joint, joint_class: JointClass) -> tuple[Xml, ...]:
    limits = joint.limits
    has_range = joint.type != JointType.CONTINUOUS and limits is not None and not is_locked(limits)
    return (
        leaf_at(
            "joint",
            joint.source,
            name=joint.name,
            type="slide" if joint.type == JointType.PRISMATIC else None,
            axis=joint.axis,
            range=range_of(limits) if limits and has_range else None,
            **joint_class.attributes("joint", joint_settings(joint).values),
        ),
    )


def symmetric(bound: float) -> tuple[float, float] | None:
    """Return the range of a limit in both directions; 0 in a URDF stands for no limit."""
    return (-bound, bound) if bound else None


def range_of(limits: JointLimits) -> tuple[float, float]:
    """Return the lower and upper limit; a missing one is 0, as to URDF readers."""
    return limits.lower or 0.0, limits.upper or 0.0


def is_locked(limits: JointLimits) -> bool:
    """Whether a joint has one position alone, which is no range for MuJoCo."""
    lower, upper = range_of(limits)
    return lower == upper


def _floating(joint: Joint, _: JointClass) -> tuple[Xml, ...]:
    """Return a free joint, or three slides and a ball, which are the same elsewhere."""
    if is_free_joint(joint):
        return (leaf_at("freejoint", joint.source, name=joint.name),)
    *slides, ball = part_names(joint)
    axes = zip(slides, (_X, _Y, _Z), strict=True)
    return (*(_part(joint, name, "slide", axis) for name, axis in axes), _part(joint, ball, "ball"))


def _planar(joint: Joint, _: JointClass) -> tuple[Xml, ...]:
    """Return two slides in the plane and a hinge about its normal."""
    normal = joint.axis or _Z
    first, second = _axes_of_plane(normal)
    x, y, yaw = part_names(joint)
    return (
        _part(joint, x, "slide", first),
        _part(joint, y, "slide", second),
        _part(joint, yaw, "hinge", normal),
    )


def _axes_of_plane(normal: Vector3) -> tuple[Vector3, Vector3]:
    """Return two axes that make a right-handed frame with a normal; x and y for z."""
    x, y, z = normal
    away = _X if abs(x) < 0.9 else _Y
    second = Vector3(y * away.z - z * away.y, z * away.x - x * away.z, x * away.y - y * away.x)
    first = Vector3(second.y * z - second.z * y, second.z * x - second.x * z, second.x * y - second.y * x)
    return first, second


def _part(joint: Joint, name: str, kind: str, axis: Vector3 | None = None) -> Xml:
    return leaf_at("joint", joint.source, name=name, type=kind, axis=axis)


_SUFFIXES: Mapping[str, tuple[str, ...]] = {
    JointType.FLOATING: ("_x", "_y", "_z", "_ball"),
    JointType.PLANAR: ("_x", "_y", "_yaw"),
}


def part_names(joint: Joint) -> Sequence[str]:
    """Return the names of MuJoCo's joints for a joint, whose own name only one of its kind has."""
    if joint.type not in _SUFFIXES or is_free_joint(joint):
        return () if joint.type == JointType.FIXED else (joint.name,)
    return [f"{joint.name}{suffix}" for suffix in _SUFFIXES[joint.type]]


def is_free_joint(joint: Joint) -> bool:
    """Whether a joint is MuJoCo's free joint, which a body has in the world alone, without a pose of its own."""
    return joint.type == JointType.FLOATING and joint.parent == WORLD and joint.origin == IDENTITY


def free_joint_name(base: str) -> str:
    """Return the name of the free joint of a base."""
    return f"{base}_free"


_MAKERS: Mapping[str, Callable[[Joint, JointClass], tuple[Xml, ...]]] = {
    JointType.REVOLUTE: _single,
    JointType.CONTINUOUS: _single,
    JointType.PRISMATIC: _single,
    JointType.FLOATING: _floating,
    JointType.PLANAR: _planar,
}

_WITH_RANGE = (JointType.REVOLUTE, JointType.PRISMATIC)


def equality_elements(robot: Robot) -> Sequence[Xml]:
    """Return the constraints on joints: those that mimic another one, and those with one position alone."""
    return [element for joint in robot.joints for element in _equalities(joint, robot)]


def _equalities(joint: Joint, robot: Robot) -> Sequence[Xml]:
    mimic, limits = joint.mimic, joint.limits
    if mimic and leader_of(joint, robot):
        coefficients = (mimic.offset, mimic.multiplier, 0, 0, 0)
        return (leaf_at("joint", mimic.source, joint1=joint.name, joint2=mimic.joint, polycoef=coefficients),)
    if limits and joint.type in _WITH_RANGE and is_locked(limits):
        coefficients = (limits.lower or 0.0, 0, 0, 0, 0)
        return (leaf_at("joint", limits.source, joint1=joint.name, polycoef=coefficients),)
    return ()


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
    stated = _both(finite_number(parameters.get("min")), finite_number(parameters.get("max")))
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
    return finite_number(drive.interface.parameters.get(name, drive.hardware.parameters.get(name)))


def _both(lower: float | None, upper: float | None) -> Range | None:
    return (lower, upper) if lower is not None and upper is not None and lower < upper else None
