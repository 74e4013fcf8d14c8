"""Joints in a few words: axis, range of motion, and the joint that they follow, with angles in degrees."""

from __future__ import annotations

import math

from linkforge_compile.core.models.joint import AXES, SINGLE_AXIS, Joint, JointMimic
from linkforge_compile.units import POSITION, Dimension, number_text

_AXIS_NAMES = {vector.to_tuple(): name for name, vector in AXES.items()}


def short(value: float) -> str:
    """Return a number with six digits."""
    return number_text(float(f"{value:.6g}"))


def axis_text(joint: Joint) -> str:
    """Return an axis as a spec would write it, such as `-z` or `[0, 0.6, 0.8]`; "" for none."""
    if joint.axis is None:
        return ""
    name = _AXIS_NAMES.get(joint.axis.to_tuple())
    return name or f"[{', '.join(number_text(round(value, 3)) for value in joint.axis)}]"


def type_text(joint: Joint) -> str:
    """Return the type of a joint with its axis, such as `revolute -z`."""
    return f"{joint.type} {axis_text(joint)}".strip()


def edge_text(joint: Joint) -> str:
    """Return the type of a joint with its axis and what it follows, such as `revolute y, follows knuckle * 0.8`."""
    return f"{type_text(joint)}, {_mimic_text(joint, joint.mimic)}" if joint.mimic else type_text(joint)


def motion_text(joint: Joint) -> str:
    """Return the range of a joint, such as `-90 to 90 deg`, or the joint that it follows; "" without a single axis."""
    if joint.type not in SINGLE_AXIS:
        return ""
    if joint.mimic:
        return _mimic_text(joint, joint.mimic)
    lower = joint.limits.lower if joint.limits else None
    upper = joint.limits.upper if joint.limits else None
    if lower is not None and upper is not None:
        low, high = (_in_unit_of_people(joint, end)[0] for end in (lower, upper))
        return f"{short(low)} to {_position_text(joint, upper)}" if low != high else _position_text(joint, upper)
    if lower is not None:
        return f"from {_position_text(joint, lower)}"
    return "no limits" if upper is None else f"up to {_position_text(joint, upper)}"


def _mimic_text(joint: Joint, mimic: JointMimic) -> str:
    factor = f" * {short(mimic.multiplier)}" if mimic.multiplier != 1 else ""
    sign, offset = ("-" if mimic.offset < 0 else "+"), _position_text(joint, abs(mimic.offset))
    return f"follows {mimic.joint}{factor}" + (f" {sign} {offset}" if mimic.offset else "")


def _position_text(joint: Joint, position: float) -> str:
    """Return a position [rad] or [m] of a joint with its unit: angles in degrees."""
    value, unit = _in_unit_of_people(joint, position)
    return f"{short(value)} {unit}"


def _in_unit_of_people(joint: Joint, position: float) -> tuple[float, str]:
    if POSITION.dimension(joint.type.motion) is Dimension.ANGLE:
        return math.degrees(position), "deg"
    return position, "m"
