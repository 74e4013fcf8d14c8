"""What a module's prefix does not reach: names that plugins read in their parameters, and absolute topics."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.frozen_map import FreePart
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.model import ABSOLUTE_TOPIC, UNPREFIXED_NAME
from linkforge_compile.source import SourceRef, Span


class Text(NamedTuple):
    """A text that is passed on as it is, and where it was written."""

    text: str
    where: Span


class PassedOn(NamedTuple):
    """What a file itself says that takes no prefix: texts that plugins read, and absolute topics."""

    plugin_texts: tuple[Text, ...]
    absolute_topics: tuple[Text, ...]


def passed_on(robot: Robot) -> PassedOn:
    """Find what no prefix reaches in the robot of one file, before its modules join it."""
    texts = (
        Text(text, source.at("parameters", *path))
        for source, parameters in _parameters(robot)
        for path, text in _texts(parameters)
        if source
    )
    topics = (
        Text(sensor.topic, sensor.source.at("topic"))
        for sensor in robot.sensors
        if sensor.source and sensor.topic and sensor.topic.startswith("/")
    )
    return PassedOn(tuple(texts), tuple(topics))


def warnings_under_a_prefix(passed: PassedOn, robot: Robot) -> Iterator[Diagnostic]:
    """Yield what there is to tell once the file takes a prefix; the robot is the file with its modules."""
    for kind, names in (("link", robot.links), ("joint", robot.joints)):
        for text, where in passed.plugin_texts:
            if text in names:
                yield UNPREFIXED_NAME.at(where, name=text, kind=kind)
    for topic, where in passed.absolute_topics:
        yield ABSOLUTE_TOPIC.at(where, topic=topic)


def _parameters(robot: Robot) -> Iterator[tuple[SourceRef | None, FreePart]]:
    plugins = [plugin for block in robot.gazebo_elements for plugin in block.plugins]
    plugins += [sensor.plugin for sensor in robot.sensors if sensor.plugin]
    yield from ((plugin.source, plugin.parameters) for plugin in plugins)
    yield from ((transmission.source, transmission.parameters) for transmission in robot.transmissions)
    for control in robot.ros2_controls:
        yield control.source, control.parameters
        yield from ((joint.source, joint.parameters) for joint in control.joints)
        yield from ((sensor.source, sensor.parameters) for sensor in control.sensors)
        yield from ((gpio.source, gpio.parameters) for gpio in control.gpios)


def _texts(part: FreePart, *path: str | int) -> Iterator[tuple[tuple[str | int, ...], str]]:
    if isinstance(part, str):
        yield path, part
        return
    inner = part.items() if isinstance(part, Mapping) else enumerate(part)
    for key, value in inner:
        yield from _texts(value, *path, key)
