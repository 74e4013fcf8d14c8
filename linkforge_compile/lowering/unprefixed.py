"""What a module's prefix does not reach: names that plugins read in parameters or raw XML, and absolute topics."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.frozen_map import FreePart
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.model import ABSOLUTE_TOPIC, UNPREFIXED_NAME
from linkforge_compile.source import SourceFile, SourceRef, Span
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar

_RAW_NAME = re.compile(r"[\w:.-]+")
# It begins with the first character of a name only: tried from each, a long name would take quadratic time.
_RAW_VALUE = re.compile(r"""(?<![\w:.-])([\w:.-]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_NAMED_FOR_ITSELF = ("visual", "collision", "material")
"""Elements whose own name may well be that of their link."""

_FORMATS_WITHOUT_EXPRESSIONS = (".urdf", ".xacro")


class Text(NamedTuple):
    """A text that is passed on as it is, and where it was written."""

    text: str
    where: Span


class PassedOn(NamedTuple):
    """What a file itself says that takes no prefix: texts that plugins read, and absolute topics."""

    plugin_texts: tuple[Text, ...]
    absolute_topics: tuple[Text, ...]


def passed_on(robot: Robot, tree: YamlNode, users: Collection[SourceFile]) -> PassedOn:
    """Find what no prefix reaches in the robot of one file and in its tree, before its modules join it.

    What an override wrote in a file that uses this one (`users`) has the names of that file: final ones here.
    """
    texts = [
        Text(text, source.at("parameters", *path))
        for source, parameters in _parameters(robot)
        for path, text in _texts(parameters)
        if source
    ]
    topics = (
        Text(sensor.topic, sensor.source.at("topic"))
        for sensor in robot.sensors
        if sensor.source and sensor.topic and sensor.topic.startswith("/")
    )
    own = (text for text in (*texts, *_raw_texts(tree)) if text.where.file not in users)
    return PassedOn(tuple(own), tuple(topics))


def warnings_under_a_prefix(passed: PassedOn, robot: Robot) -> Iterator[Diagnostic]:
    """Yield what there is to tell once the file takes a prefix; the robot is the file with its modules."""
    for kind, names in (("link", robot.links), ("joint", robot.joints)):
        # A raw text may say one name often.
        for text, where in dict.fromkeys(passed.plugin_texts):
            if text in names:
                remedy = f"write '$({kind}('{text}'))'"
                if where.file.name.lower().endswith(_FORMATS_WITHOUT_EXPRESSIONS):
                    remedy = "change it with 'override' where this file is used"
                yield UNPREFIXED_NAME.at(where, name=text, kind=kind, remedy=remedy)
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


def _raw_texts(node: YamlNode) -> Iterator[Text]:
    """Yield what the raw XML of a tree says in attributes and elements."""
    if isinstance(node, YamlMap):
        for entry in node:
            if entry.name != "extra":
                yield from _raw_texts(entry.value)
                continue
            for item in entry.value.items if isinstance(entry.value, YamlList) else (entry.value,):
                if isinstance(item, YamlScalar):
                    yield from (Text(text, item.span) for text in _said_in(item.text))
    elif isinstance(node, YamlList):
        for inner in node:
            yield from _raw_texts(inner)


def _said_in(raw: str) -> Iterator[str]:
    """Yield the texts and attributes of raw XML, in time that grows with its length, whatever it is."""
    for piece in raw.split("<")[1:]:
        start, end, behind = piece.partition(">")
        tag = _RAW_NAME.match(start)
        if not (tag and end):
            continue
        yield behind.partition(">")[0].strip()
        for name, double, single in _RAW_VALUE.findall(start, tag.end()):
            if name != "name" or tag[0] not in _NAMED_FOR_ITSELF:
                yield double or single
