"""The names by which others know a robot's parts, and which of them a newer robot no longer answers to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.compare.renames import Renames, find_renames
from linkforge_compile.core.models.robot import Robot


class _Name(NamedTuple):
    """A name that launch files, controllers and programs may hold; `kind` says of what."""

    kind: str
    name: str


class Vanished(NamedTuple):
    """A name that is gone; `now` is what the same thing is called instead, None for what has no successor."""

    kind: str
    name: str
    now: str | None


def vanished(before: Robot, after: Robot, *, semantic: bool = True) -> tuple[Vanished, ...]:
    """Return the public names of a robot that another one lacks, in its order.

    They are those of links, joints, sensors and their topics, of hardware and its interfaces and, with `semantic`, of
    groups, their states and end effectors.
    """
    renames = find_renames(before, after)
    left = frozenset(_public(after, semantic))
    gone = [name for name in dict.fromkeys(_public(before, semantic)) if name not in left]
    states = {f"{group}/{was}": f"{group}/{now}" for (group, was), now in renames.states.items()}
    return tuple(Vanished(*name, _successor(name, renames, states, left)) for name in gone)


def _successor(name: _Name, renames: Renames, states: Mapping[str, str], left: frozenset[_Name]) -> str | None:
    if name.kind == "link":
        return renames.links.get(name.name)
    if name.kind == "group state":
        return states.get(name.name)
    owner, slash, interface = name.name.rpartition("/")
    new = _Name(name.kind, f"{renames.joints.get(owner if slash else name.name)}{slash}{interface if slash else ''}")
    return new.name if new in left and name.kind in _OF_JOINTS else None


_OF_JOINTS = ("joint", "command interface", "state interface")


def _public(robot: Robot, semantic: bool) -> Iterator[_Name]:
    yield from (_Name("link", link.name) for link in robot.links)
    yield from (_Name("joint", joint.name) for joint in robot.joints)
    for sensor in robot.sensors:
        yield _Name("sensor", sensor.name)
        if sensor.topic:
            yield _Name("topic", sensor.topic)
    for hardware in robot.ros2_controls:
        yield _Name("hardware", hardware.name)
        for commanded in (*hardware.joints, *hardware.gpios):
            yield from (_Name("command interface", f"{commanded.name}/{one}") for one in commanded.command_interfaces)
            yield from (_Name("state interface", f"{commanded.name}/{one}") for one in commanded.state_interfaces)
        for read in hardware.sensors:
            yield from (_Name("state interface", f"{read.name}/{one}") for one in read.state_interfaces)
    if semantic:
        yield from (_Name("group", group.name) for group in robot.semantic.groups)
        yield from (_Name("group state", f"{state.group}/{state.name}") for state in robot.semantic.group_states)
        yield from (_Name("end effector", end.name) for end in robot.semantic.end_effectors)
