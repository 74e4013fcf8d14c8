"""Ranges of joints, and joints that mimic other joints."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from linkforge_compile.checks.names import Reference, report_cycles, report_unknown
from linkforge_compile.core.constants import UNKNOWN
from linkforge_compile.core.models.joint import (
    SINGLE_AXIS,
    Joint,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import (
    EMPTY_RANGE,
    FAST_JOINT,
    IDLE_SOFT_LIMIT,
    MIMIC_CYCLE,
    MIMIC_FREEDOM,
    MIMIC_OUTSIDE_LIMITS,
    MIMIC_STANDS_STILL,
    NO_RANGE,
    POWERLESS_JOINT,
    RANGE_OF_ENDLESS_JOINT,
    SOFT_LIMITS_CROSSED,
)
from linkforge_compile.diagnostics.codes.names import UNKNOWN_JOINT
from linkforge_compile.diagnostics.entry_fixes import leave_out_all
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.source import Key

WITHIN_LIMITS: dict[str, str] = {JointType.REVOLUTE: "rad", JointType.PRISMATIC: "m"}
"""The joints whose limits bound their position, and its unit."""

ROUNDING = 1e-4
"""The tolerance on limits [rad] or [m]: 1.5708 for a quarter turn is no mistake."""

_SIZES = {"deg": math.pi / 180, "°": math.pi / 180, "mm": 0.001, "cm": 0.01}
"""Units in which positions are often written, in [rad] or [m]."""

_UNIT = re.compile(r"[0-9.]\s*(?P<unit>deg|°|mm|cm)['\"]?")

_HAS_UNIT = re.compile(r"[0-9]\.?\s*(?![eE][-+]?[0-9])[^\W\d_]|°|\$\(")


def has_unit(text: str | None) -> bool:
    """Return whether a number is written with a unit, or as an expression, which may have one; False for no text."""
    return bool(text and _HAS_UNIT.search(text))


def unit_in(text: str | None) -> str | None:
    """Return the unit in which a position is written; None for one in SI units, for an expression, and for no text."""
    found = _UNIT.search(text) if text and "$(" not in text else None
    return found["unit"] if found else None


def in_unit(position: float, unit: str | None) -> str:
    """Return the text of a position [rad] or [m] in a unit; None is SI, without the unit's name."""
    return f"{position:.6g}" if unit is None else f"{position / _SIZES[unit]:.6g} {unit}"


def is_known(*numbers: float | None) -> bool:
    """Return whether none of these replaces a number whose error is already reported."""
    return all(number is None or abs(number) < UNKNOWN for number in numbers)


def unit_at(joint: Joint, *paths: tuple[str | Key, ...]) -> str | None:
    """Return the unit of the first of some positions that is written with one."""
    places = (joint.source.at(*path) for path in paths) if joint.source else ()
    return next((unit for place in places if (unit := unit_in(place.text))), None)


def measured(joint: Joint, position: float, unit: str | None) -> str:
    """Return a position [rad] or [m] with its unit, the SI one for None."""
    return in_unit(position, unit) if unit else f"{in_unit(position, None)} {WITHIN_LIMITS[joint.type]}"


def missed_range(joint: Joint, lowest: float, highest: float, unit: str | None = None) -> str | None:
    """Return "from -1 to 1 rad" if the joint can be nowhere between two positions [rad] or [m]; None if it can.

    In another `unit` it is "from -90 deg to 90 deg".
    """
    limits = joint.limits
    if limits is None or joint.type not in WITHIN_LIMITS:
        return None
    lower, upper = limits.lower, limits.upper
    below = lower is not None and highest < lower - ROUNDING
    above = upper is not None and lowest > upper + ROUNDING
    return _range(joint, lower, upper, unit) if below or above else None


def passed_range(joint: Joint, lowest: float, highest: float) -> tuple[str, str] | None:
    """Return the range of a joint and the one in which it is driven [rad] or [m], in words, if that is not within.

    Both are in the unit in which the joint's limits are written.
    """
    limits = joint.limits
    if limits is None or joint.type not in WITHIN_LIMITS:
        return None
    below = limits.lower is not None and lowest < limits.lower - ROUNDING
    above = limits.upper is not None and highest > limits.upper + ROUNDING
    if not (below or above):
        return None
    unit = unit_at(joint, ("limits", "lower"), ("limits", "upper"))
    return _range(joint, limits.lower, limits.upper, unit), _range(joint, lowest, highest, unit)


def _range(joint: Joint, lower: float | None, upper: float | None, unit: str | None) -> str:
    ends = (("from", lower), ("to", upper))
    bounds = [f"{way} {in_unit(end, unit)}" for way, end in ends if end is not None and is_known(end)]
    return " ".join((*bounds, *(() if unit else (WITHIN_LIMITS[joint.type],))))


FASTEST: dict[str, float] = {JointType.REVOLUTE: 20 * math.pi, JointType.PRISMATIC: 20.0}
"""A faster joint has its speed in other units [rad/s] or [m/s]: fast legs have 40 rad/s."""

WHEEL = 20 * math.pi
"""A revolute joint that turns further may be a wheel [rad]: exporters give one limits of 1e16."""

NO_SPEED, UNBOUNDED = 100.0, 1000.0
"""The speed that exporters write by default, and that from which on there is no limit [SI]."""


def check_mimic_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A joint mimics a joint of this robot.

    Readers refuse the robot or leave the joint free to dangle. Correct the name; a joint of a module bears
    the module's prefix.
    """
    yield from report_unknown(_mimics(robot).values(), UNKNOWN_JOINT, robot.joints.names, unresolved)


def check_mimic_cycles(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A joint may mimic one that mimics another, but at the end of the row one must be free.

    In a cycle none leads: MoveIt drops every mimic of the robot, other readers never end. Let one joint of
    the cycle lead, without `mimic`, and the others mimic that.
    """
    yield from report_cycles({name: (use,) for name, use in _mimics(robot).items()}, MIMIC_CYCLE)


def check_mimic_freedom(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """Both joints of a mimic move along or about one axis.

    A mimic multiplies one number. A fixed joint has none, a planar or floating one several, and readers drop
    the mimic. A prismatic joint may well mimic a revolute one; its `multiplier` is then [m/rad].
    """
    for joint in robot.joints:
        if joint.mimic is None:
            continue
        leader = robot.joints.get(joint.mimic.joint)
        if leader and leader is not joint and not {joint.type, leader.type}.issubset(SINGLE_AXIS):
            ref = _mimic(joint, joint.mimic)
            yield ref.report(MIMIC_FREEDOM, joint=joint.name, type=joint.type, leader=leader.name, led=leader.type)


def check_mimic_motion(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A joint that mimics another moves with it.

    With a `multiplier` of 0 it stays at its `offset` whatever its leader does. Write the ratio of the two, below 0
    for the other direction; or make the joint `fixed`.
    """
    for joint in robot.joints:
        if joint.mimic and joint.mimic.multiplier == 0:
            leader = joint.mimic.joint
            yield MIMIC_STANDS_STILL.at(joint.source, "mimic", "multiplier", joint=joint.name, leader=leader)


def check_mimic_range(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A joint that mimics another can follow it as far as it goes.

    Where the leader's range, times `multiplier` plus `offset`, passes a limit of the follower, simulators stop one of
    the two, or let the follower pass its limit, and planners find states that no robot can reach. Correct the sign of
    the `multiplier` or of the `axis`, or the limits of one of the two.
    """
    for joint in robot.joints:
        leader = robot.joints.get(joint.mimic.joint) if joint.mimic else None
        if joint.mimic and leader and {joint.type, leader.type}.issubset(WITHIN_LIMITS):
            driven = _driven_range(joint.mimic, leader)
            if driven and (own := passed_range(joint, *driven)):
                own_range, found = own
                yield MIMIC_OUTSIDE_LIMITS.at(
                    joint.source, "mimic", joint=joint.name, range=own_range, leader=leader.name, found=found
                )


def _driven_range(mimic: JointMimic, leader: Joint) -> tuple[float, float] | None:
    """Return the range in which a leader drives its follower [rad] or [m]; None if its own range is not known."""
    if leader.limits is None or leader.limits.lower is None or leader.limits.upper is None:
        return None
    if not is_known(leader.limits.lower, leader.limits.upper, mimic.multiplier, mimic.offset):
        return None
    ends = [mimic.multiplier * end + mimic.offset for end in (leader.limits.lower, leader.limits.upper)]
    return min(ends) + 0.0, max(ends) + 0.0  # no -0, which a person would not write


def check_joint_range(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A revolute or prismatic joint has a range to move in.

    URDF reads a missing `lower` or `upper` as 0, so a joint with neither, or with one on the wrong side of 0,
    cannot move; nor can one that has the same position for both. Write both, make the joint `continuous` if it
    turns without end, or `fixed` if it is not to move.
    """
    for joint in robot.joints:
        limits = joint.limits
        if joint.type not in WITHIN_LIMITS or limits is None:
            continue
        if None in (limits.lower, limits.upper):
            if (limits.lower or 0.0) >= (limits.upper or 0.0):
                missing = " and ".join(side for side in ("lower", "upper") if getattr(limits, side) is None)
                yield NO_RANGE.at(joint.source, "limits", joint=joint.name, missing=missing)
        elif limits.lower == limits.upper:
            found = f"{limits.lower:.6g}"
            yield EMPTY_RANGE.at(joint.source, "limits", "upper", joint=joint.name, found=found)


def check_endless_joints(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A continuous joint has no `lower` and `upper`.

    Simulators and planners let it turn beyond them. Make it `revolute` if it stops there, or leave them out; `effort`
    and `velocity` stay. Exporters write 0 for both, which is no stop.
    """
    for joint in robot.joints:
        limits = joint.limits
        if joint.type != JointType.CONTINUOUS or limits is None:
            continue
        written = [side for side in ("lower", "upper") if getattr(limits, side) is not None]
        if any(getattr(limits, side) for side in written):
            sides = " and ".join(written)
            fault = RANGE_OF_ENDLESS_JOINT.at(joint.source, "limits", written[0], joint=joint.name, limits=sides)
            type_ = joint.source.at("type") if joint.source else None
            out = leave_out_all(joint.source, [("limits", side) for side in written], f"remove {sides}")
            yield fault.with_fix(Replacement("", JointType.REVOLUTE).within(type_), out)


def check_joint_power(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The `effort` and `velocity` of a joint are above 0.

    A limit of 0 is a limit: no motor of a simulator moves a joint without effort, and ros2_control commands no speed to
    a joint without velocity. Drivers of position-controlled arms read neither, so that vendors leave `effort="0"`;
    write the motor's, even a guess, before the robot is simulated. Reported once for all such joints. A joint that
    mimics another is moved by it.
    """
    for joint in robot.joints:
        limits = joint.limits
        if joint.type not in SINGLE_AXIS or limits is None or joint.mimic:
            continue
        none = [field for field in ("effort", "velocity") if getattr(limits, field) == 0]
        if none:
            yield POWERLESS_JOINT.at(joint.source, "limits", none[0], joint=joint.name, fields=" and ".join(none))


def check_joint_speed(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A revolute joint makes at most ten turns a second, and a prismatic one 20 m/s.

    Data sheets give degrees a second and millimetres a second; a bare number is in rad/s or m/s, and only such a
    number is reported. Write the unit, such as `180 deg/s`. A wheel may turn at any speed: a continuous joint, or a
    revolute one without a range, or with one of more than ten turns.
    """
    for joint in robot.joints:
        fastest = None if _may_be_wheel(joint) else FASTEST.get(joint.type)
        velocity = joint.limits.velocity if joint.limits else None
        if fastest is None or velocity is None or velocity == NO_SPEED or not fastest < velocity < UNBOUNDED:
            continue
        if joint.source and has_unit(joint.source.at("limits", "velocity").text):
            continue  # a written unit is no mistake
        found, is_turning = f"{velocity:.6g}", joint.type == JointType.REVOLUTE
        also = f", {velocity / math.tau:.3g} turns a second" if is_turning else ""
        si, unit, units = ("rad/s", "deg/s", "degrees") if is_turning else ("m/s", "mm/s", "millimetres")
        in_other_unit = f"{math.radians(velocity) if is_turning else velocity / 1000:.6g}"
        yield FAST_JOINT.at(
            joint.source,
            "limits",
            "velocity",
            joint=joint.name,
            found=found,
            also=also,
            si=si,
            unit=unit,
            units=units,
            expected=in_other_unit,
        )


def _may_be_wheel(joint: Joint) -> bool:
    """Return whether a revolute joint has no end, or none that it reaches within WHEEL."""
    if joint.type != JointType.REVOLUTE or joint.limits is None:
        return False
    lower, upper = joint.limits.lower, joint.limits.upper
    return lower is None or upper is None or upper - lower > WHEEL


def check_soft_limits(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The soft limits of a safety controller lie within the limits of its joint, the lower one below the upper one.

    A controller begins to brake there. A soft limit beyond the stop never acts; with the two crossed, or a missing
    one that URDF reads as 0, the joint cannot move. Without `k_position` nothing acts on positions.
    """
    for joint in robot.joints:
        safety, limits = joint.safety_controller, joint.limits
        if safety is None or not safety.k_position or joint.type not in WITHIN_LIMITS or limits is None:
            continue
        if not is_known(safety.soft_lower_limit, safety.soft_upper_limit):
            continue
        lower, upper = safety.soft_lower_limit or 0.0, safety.soft_upper_limit or 0.0
        if lower >= upper:
            unit = unit_at(joint, *(("safety_controller", f"soft_{side}_limit") for side in ("lower", "upper")))
            yield SOFT_LIMITS_CROSSED.at(
                joint.source,
                "safety_controller",
                joint=joint.name,
                lower=measured(joint, lower, unit),
                upper=measured(joint, upper, unit),
            )
        else:
            yield from _idle_soft_limits(joint, safety, limits)


def _idle_soft_limits(joint: Joint, safety: JointSafetyController, limits: JointLimits) -> Iterator[Diagnostic]:
    for side, sign in (("lower", 1.0), ("upper", -1.0)):
        soft: float | None = getattr(safety, f"soft_{side}_limit")
        hard: float | None = getattr(limits, side)
        if soft is not None and hard is not None and sign * soft < sign * hard - ROUNDING:
            where = ("safety_controller", f"soft_{side}_limit")
            unit = unit_at(joint, where, ("limits", side))
            yield IDLE_SOFT_LIMIT.at(
                joint.source,
                *where,
                joint=joint.name,
                side=side,
                hard=measured(joint, hard, unit),
                soft=measured(joint, soft, unit),
            )


def _mimics(robot: Robot) -> dict[str, Reference]:
    return {joint.name: _mimic(joint, joint.mimic) for joint in robot.joints if joint.mimic}


def _mimic(joint: Joint, mimic: JointMimic) -> Reference:
    return Reference(mimic.joint, f"joint '{joint.name}'", joint.source, ("mimic", "joint"))
