"""Joints of URDF, in the units of their motion."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import NamedTuple

from linkforge_compile.diagnostics.codes.importing import ENDS_KEPT_RAW
from linkforge_compile.importers.draft import DeclinedError, number_of
from linkforge_compile.importers.reading import Reading
from linkforge_compile.importers.urdf.gazebo import Blocks
from linkforge_compile.importers.urdf.geometry import read_origin
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension


class _Motion(NamedTuple):
    """The dimensions of a joint's position and velocity, None where numbers are bare; what the joint has."""

    position: Dimension | None = None
    velocity: Dimension | None = None
    has_axis: bool = True
    has_limits: bool = True
    needs_limits: bool = False


_TURNING = _Motion(Dimension.ANGLE, Dimension.ANGULAR_VELOCITY)
_MOTIONS: Mapping[str, _Motion] = {
    "revolute": _TURNING._replace(needs_limits=True),
    "continuous": _TURNING,
    "prismatic": _Motion(needs_limits=True),
    "planar": _Motion(),
    "floating": _Motion(has_axis=False),
    "fixed": _Motion(has_axis=False, has_limits=False),
}
TYPES_OF_JOINTS = tuple(_MOTIONS)
_AXES: Mapping[tuple[float | None, ...], str] = {
    tuple(sign * (letter == name) for letter in "xyz"): f"{'-' if sign < 0 else ''}{name}"
    for name in "xyz"
    for sign in (1.0, -1.0)
}


def read_joint(joint: Reading, joints: Collection[str], blocks: Blocks) -> YamlMap:
    """Read a joint, whose name is taken; `blocks` has what a simulator is told about it.

    `joints` are the names of all joints: what names another cannot be said.
    """
    kind = joint.name("type")
    motion = _MOTIONS.get(kind.text)
    if motion is None:
        raise joint.declined(f"there is no type of joint named '{kind.text}'")
    parent, child = joint.needed("parent", _link), joint.needed("child", _link)
    return joint.map(
        type=kind,
        parent=parent,
        child=child,
        origin=joint.one("origin", read_origin),
        axis=_axis_of(joint) if motion.has_axis else None,
        limits=_limits_of(joint, motion) if motion.has_limits else None,
        dynamics=_part(joint, "dynamics", _dynamics, motion),
        mimic=joint.one("mimic", lambda mimic: _mimic(mimic, motion, joints)),
        safety_controller=_part(joint, "safety_controller", _safety_controller, motion),
        calibration=_part(joint, "calibration", _calibration, motion),
        gazebo=blocks.beside(joint.element.get("name") or ""),
    )


def _part(joint: Reading, tag: str, read: Callable[[Reading, _Motion], YamlNode], motion: _Motion) -> YamlNode | None:
    return joint.one(tag, lambda part: read(part, motion))


def _link(end: Reading) -> YamlNode:
    link = end.name("link")
    end.leave_rest()
    return link


def _axis_of(joint: Reading) -> YamlNode | None:
    """Read the axis; URDF's is x where nothing is said, and the language wants it said."""
    return joint.must("axis", _axis) if joint.has("axis") else joint.draft.text("x", joint.span)


def _axis(axis: Reading) -> YamlNode:
    xyz = axis.numbers("xyz", 3)
    axis.leave_rest()
    if xyz is None:
        return axis.draft.text("x", axis.span)
    letter = _AXES.get(tuple(map(number_of, (axis.element.get("xyz") or "").split())))
    return axis.draft.text(letter, xyz) if letter else xyz


def _limits_of(joint: Reading, motion: _Motion) -> YamlNode | None:
    take = joint.must if motion.needs_limits else joint.one
    return take("limit", lambda limit: _limits(limit, motion))


def _limits(limit: Reading, motion: _Motion) -> YamlNode:
    lower, upper = (number_of(limit.element.get(name) or "0") for name in ("lower", "upper"))
    if lower is not None and upper is not None and lower > upper:
        limit.draft.told.append(ENDS_KEPT_RAW.at(limit.span, lower=f"{lower:g}", upper=f"{upper:g}"))
        ends = {}
    else:
        ends = {name: limit.number(name, motion.position) for name in ("lower", "upper")}
    lacking = [name for name in ("effort", "velocity") if limit.element.get(name) is None]
    if lacking and not motion.needs_limits:
        raise limit.declined(f"it has no {' and no '.join(map(repr, lacking))}")
    # Limits that must be there are no better raw: the joint would have none. What they lack is told when compiled.
    return limit.map(
        **ends,
        effort=_not_negative(limit, "effort"),
        velocity=_not_negative(limit, "velocity", motion.velocity),
    )


def _not_negative(part: Reading, name: str, unit: Dimension | None = None) -> YamlScalar | None:
    node = part.number(name, unit)
    if node is None:
        return None
    if node.text.startswith("-") and number_of(part.element.get(name) or "") != 0:
        raise part.declined(f"{name} must be 0 or above, found {node.text}")
    return node


def _dynamics(dynamics: Reading, motion: _Motion) -> YamlNode:
    for name in ("damping", "friction"):
        if (number_of(dynamics.element.get(name) or "0") or 0) < 0:
            raise dynamics.declined(f"{name} must be 0 or above, found {dynamics.element.get(name)}")
    return dynamics.map(damping=dynamics.number("damping", default=0), friction=dynamics.number("friction", default=0))


def _mimic(mimic: Reading, motion: _Motion, joints: Collection[str]) -> YamlNode:
    joint = mimic.attribute("joint")
    if joint.value not in joints:
        raise DeclinedError(f"there is no joint named '{joint.value}'", joint.span)
    return mimic.map(
        joint=mimic.draft.text(joint.value, joint.span),
        multiplier=mimic.number("multiplier", default=1),
        offset=mimic.number("offset", motion.position, default=0),
    )


def _safety_controller(safety: Reading, motion: _Motion) -> YamlNode:
    if safety.element.get("k_velocity") is None:
        raise safety.declined("it has no 'k_velocity'")
    return safety.map(
        soft_lower_limit=safety.number("soft_lower_limit", motion.position),
        soft_upper_limit=safety.number("soft_upper_limit", motion.position),
        k_position=safety.number("k_position"),
        k_velocity=safety.number("k_velocity", default=0),
    )


def _calibration(calibration: Reading, motion: _Motion) -> YamlNode:
    return calibration.map(
        rising=calibration.number("rising", motion.position), falling=calibration.number("falling", motion.position)
    )
