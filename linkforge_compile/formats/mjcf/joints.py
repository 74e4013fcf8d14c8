"""Joints in MJCF, and the equalities that hold some of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.core.models.geometry import IDENTITY, Vector3
from linkforge_compile.core.models.joint import AXES, Joint, JointLimits, JointType
from linkforge_compile.formats.element import leaf_at
from linkforge_compile.formats.kinematic_tree import WORLD
from linkforge_compile.formats.mjcf.joint_class import JointClass, Settings, Values
from linkforge_compile.formats.single_axis import leader_of
from linkforge_compile.formats.xml_text import Xml

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot

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
