"""No two things of one kind bear one name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkforge_compile.checks.references import Use
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Gaps
from linkforge_compile.diagnostics.codes.names import DUPLICATE_NAME


def check_duplicates(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """No two sensors bear one name, and no two transmissions or ros2_control systems.

    Who loads the robot takes the first, the last or none of them. Rename one. Two modules keep apart what is in
    them by their prefixes. Links and joints of one name never get as far as this.
    """
    yield from _borne_twice("sensor", (Use(each.name, "", each.source) for each in robot.sensors))
    yield from _borne_twice("transmission", (Use(each.name, "", each.source) for each in robot.transmissions))
    yield from _borne_twice("ros2_control system", (Use(each.name, "", each.source) for each in robot.ros2_controls))


def check_semantic_duplicates(robot: Robot, _: Gaps) -> Iterator[Diagnostic]:
    """No two planning groups bear one name, and no two end effectors, virtual joints or states of a group.

    MoveIt takes the first group of a name and the last state, and says so in its log at best. Rename one.
    """
    semantic = robot.semantic
    yield from _borne_twice("planning group", (Use(each.name, "", each.source) for each in semantic.groups))
    yield from _borne_twice("end effector", (Use(each.name, "", each.source) for each in semantic.end_effectors))
    yield from _borne_twice("virtual joint", (Use(each.name, "", each.source) for each in semantic.virtual_joints))
    yield from _borne_twice("passive joint", (Use(each.name, "", each.source) for each in semantic.passive_joints))
    states: dict[str, list[Use]] = {}
    for state in semantic.group_states:
        states.setdefault(state.group, []).append(Use(state.name, f"planning group '{state.group}'", state.source))
    for uses in states.values():
        yield from _borne_twice("group state", uses)


def _borne_twice(kind: str, bearers: Iterable[Use]) -> Iterator[Diagnostic]:
    first: dict[str, Use] = {}
    for bearer in bearers:
        earlier = first.setdefault(bearer.name, bearer)
        if earlier is not bearer:
            notes = [earlier.note(f"the first {kind} '{bearer.name}'")] if earlier.source else []
            yield bearer.told(DUPLICATE_NAME, kind=kind, name=bearer.name, notes=notes)
