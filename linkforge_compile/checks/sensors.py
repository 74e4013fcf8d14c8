"""Sensors sit on links, publish on topics that there may be, and say in which frame they measure."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkforge_compile.checks.references import Use, unknown
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.names import (
    REFUSED_TOPIC,
    SHARED_TOPIC,
    UNKNOWN_COLLISION,
    UNKNOWN_FRAME,
    UNKNOWN_LINK,
)

_STRANGE = re.compile(r"[^A-Za-z0-9_/~{}]")
_SUBSTITUTION = re.compile(r"\{[A-Za-z_][A-Za-z0-9_]*\}")
_BRACE = re.compile(r"[{}]")
_NUMBERED = re.compile(r"(?:^|/)([0-9][^/]*)")


def check_sensor_links(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A sensor sits on a link of this robot.

    A simulator never makes a sensor whose link it does not know, and mostly says nothing. Correct the `link`.
    """
    links = (Use(sensor.link_name, f"sensor '{sensor.name}'", sensor.source, ("link",)) for sensor in robot.sensors)
    yield from unknown(links, UNKNOWN_LINK, robot.links.names, unresolved)


def check_sensor_frames(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The frame of a sensor's messages is a link of this robot.

    robot_state_publisher tells tf2 of links and of nothing else, so what is measured in another frame cannot be
    shown or used, unless somebody else publishes where that frame is. Correct the name, or add the frame under
    `frames`.
    """
    frames = (
        Use(sensor.frame, f"sensor '{sensor.name}'", sensor.source, ("frame",))
        for sensor in robot.sensors
        if sensor.frame
    )
    yield from unknown(frames, UNKNOWN_FRAME, robot.links.names, unresolved)


def check_contacts(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A contact sensor watches a collision of the robot, by that collision's name.

    Gazebo makes a sensor for a collision that it does not know, and it never reports a contact. On loading a URDF it
    also makes names of its own, of the link and `_collision`, and others where it merges fixed joints: names that may
    be such are not told.
    """
    names = [collision.name for link in robot.links for collision in link.collisions if collision.name]
    contacts = (
        Use(sensor.contact_info.collision, f"sensor '{sensor.name}'", sensor.contact_info.source, ("collision",))
        for sensor in robot.sensors
        if sensor.contact_info and not _may_be_made(sensor.contact_info.collision, robot)
    )
    yield from unknown(contacts, UNKNOWN_COLLISION, names, unresolved)


def _may_be_made(name: str, robot: Robot) -> bool:
    link, made, _ = name.partition("_collision")
    return "_lump__" in name or bool(made and link in robot.links)


def check_topics(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A topic of a sensor is one that ROS 2 takes.

    Names between slashes hold ASCII letters, digits and `_`, and do not begin with a digit; `~` stands at the
    very start, before a `/`; `{name}` is a substitution. Gazebo takes more (`front-camera`), but the bridge to
    ROS 2 then fails. A prefix that begins with a digit spoils the topics of its module.
    """
    for sensor in robot.sensors:
        if sensor.topic and (reason := _refusal(sensor.topic)):
            use = Use(sensor.name, f"sensor '{sensor.name}'", sensor.source, ("topic",))
            yield use.told(REFUSED_TOPIC, topic=sensor.topic, reason=reason)


def _refusal(topic: str) -> str | None:
    plain = _SUBSTITUTION.sub("x", topic)
    if strange := _STRANGE.search(topic) or _BRACE.search(plain):
        return f"'{strange[0]}' may not stand in one" if strange[0] not in "{}" else "its braces hold no name"
    if "~" in plain[1:] or (plain[0] == "~" and plain[1:2] not in {"", "/"}):
        return "'~' stands at its very start, before '/'"
    if "//" in plain:
        return "there is no name between '//'"
    if plain.endswith("/"):
        return "it ends with '/'"
    numbered = _NUMBERED.search(plain)
    return f"'{numbered[1]}' begins with a digit" if numbered else None


def check_shared_topics(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No two sensors publish on one topic.

    Readers get the messages of both in turn and cannot tell them apart; of two kinds of message one is lost.
    Give each sensor a topic of its own. A relative topic in a module takes the prefix of its use, an absolute
    one (`/camera`) does not, and is told as such where a module is used.
    """
    first: dict[str, Use] = {}
    for sensor in robot.sensors:
        if not sensor.topic:
            continue
        use = Use(sensor.name, f"sensor '{sensor.name}'", sensor.source, ("topic",))
        earlier = first.setdefault(sensor.topic.removeprefix("/"), use)
        if earlier is not use and (use.source is None or use.place != earlier.place):
            notes = earlier.notes(f"sensor '{earlier.name}' publishes here")
            yield use.told(SHARED_TOPIC, first=earlier.name, second=sensor.name, topic=sensor.topic, notes=notes)
