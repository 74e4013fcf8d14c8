"""The option `--pose`: states of planning groups, and positions of single joints."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from linkforge_compile.cli import UsageError
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import GroupState
from linkforge_compile.diagnostics.grouping import join_names
from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.formats.groups import actuated_joints


def states_by_name(robot: Robot) -> dict[str, GroupState]:
    """Return the states of all groups by GROUP/STATE."""
    return {f"{state.group}/{state.name}": state for state in robot.semantic.group_states}


def states_of(robot: Robot, poses: Iterable[str], accepted: str) -> dict[str, GroupState]:
    """Return the states that `--pose` names, by GROUP/STATE; a STATE alone is that of every group that has it.

    `accepted` are the forms of the option, for the message of the UsageError about an unknown state.
    """
    known = states_by_name(robot)
    found: dict[str, GroupState] = {}
    for pose in poses:
        named = {name: state for name, state in known.items() if pose in {name, state.name}}
        if not named:
            hint = did_you_mean(pose, (*known, *(state.name for state in known.values())))
            hint = hint or (f"; there are {join_names(known)}" if known else "")
            raise UsageError(f"--pose takes {accepted}; the robot has no state '{pose}'{hint}")
        found |= named
    return found


def positions_of(robot: Robot, poses: Iterable[str]) -> dict[str, float]:
    """Return the positions [rad] or [m] of joints that `--pose` names by states and by JOINT=VALUE, the last one wins.

    UsageError for an unknown state or joint, and for a value that is none of the joint's.
    """
    positions: dict[str, float] = {}
    for pose in poses:
        name, separator, value = pose.partition("=")
        if separator:
            positions[name] = _position(_joint(robot, name), value, pose)
            continue
        for state in states_of(robot, [pose], "GROUP/STATE, STATE or JOINT=VALUE").values():
            positions |= dict(_single_positions(state))
    return positions


def _single_positions(state: GroupState) -> Iterator[tuple[str, float]]:
    for joint, values in state.joint_values.items():
        if len(values) == 1 and isinstance(values[0], int | float):
            yield joint, float(values[0])


def movable_joints(robot: Robot) -> dict[str, Joint]:
    """Return the joints with one position of their own, by name."""
    return {joint.name: joint for joint in actuated_joints(robot)}


def _joint(robot: Robot, name: str) -> Joint:
    movable = movable_joints(robot)
    if name not in movable:
        why = f"is not a joint of the robot{did_you_mean(name, movable)}"
        if robot.has_joint(name):
            joint = robot.joint(name)
            what = f"follows joint '{joint.mimic.joint}'" if joint.mimic else f"is {joint.type}"
            why = f"{what}, and has no position of its own"
        raise UsageError(f"--pose {name}=…: '{name}' {why}")
    return movable[name]


def _position(joint: Joint, text: str, pose: str) -> float:
    from linkforge_compile.units import POSITION, parse_quantity

    unit = POSITION.text(joint.type.motion)
    value = _number(text, unit)
    if value is None:
        what = "an angle such as 0.5 or '30 deg'" if unit == "rad" else "a length such as 0.2 or '20 cm'"
        raise UsageError(f"--pose {pose}: joint '{joint.name}' takes {what}, found '{text}'")
    lower, upper = joint.bounds or (value, value)
    if not lower <= value <= upper:
        in_degrees = parse_quantity(text) is not None and unit == "rad"
        shown, factor = ("deg", math.degrees(1)) if in_degrees else (unit, 1.0)
        limits = " to ".join(f"{bound * factor:.6g} {shown}" for bound in (lower, upper))
        is_angle = unit == "rad" and not in_degrees and lower <= math.radians(value) <= upper
        hint = f"; did you mean '{joint.name}={text}deg'?" if is_angle else ""
        raise UsageError(f"--pose {pose}: joint '{joint.name}' is from {limits}{hint}")
    return value


def _number(text: str, unit: str) -> float | None:
    """Return a number in an SI unit, of a text with or without a unit; None for any other text."""
    from linkforge_compile.units import finite_number, parse_quantity

    if quantity := parse_quantity(text):
        return quantity.value if quantity.dimension.si_unit == unit else None
    return finite_number(text)
