"""Warn of names and prefixes in a module that do not get its prefix: of plugins, hardware, raw XML, and topics."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import takewhile
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2Control
from linkforge_compile.core.part import FreePart, SourcedText
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.model import (
    ABSOLUTE_TOPIC,
    UNPREFIXED_HARDWARE,
    UNPREFIXED_NAME,
    UNPREFIXED_TOPICS,
)
from linkforge_compile.source import Key, SourceFile, SourceRef, Span
from linkforge_compile.source.xml_tree import ATTRIBUTE, MARKUP
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar

_NAMED_ELEMENTS = ("visual", "collision", "material")
"""Elements with a name of their own, which may be the same as that of their link."""

_TOPIC_OR_FRAME_KEY = re.compile(
    r"(?:topic|frame|namespace|remapping)(?:_?(?:name|id|prefix))?s?$|^collision$", re.IGNORECASE
)
"""The end of a key, tag or attribute for a topic or frame: `imageTopicName`, `frame_id`; and the tag that names the
collision of a contact sensor."""

# In a force-torque sensor, `frame` is one of three words.
_NOT_A_NAME = re.compile(r"[-+.\d\s]*|true|false|child|parent|sensor|__.*__", re.IGNORECASE)
_MOST_SHOWN = 5

_PREFIX_KEY = re.compile(r"(?!.*(?:topic|namespace)).*prefix", re.IGNORECASE)
"""A hardware parameter for what the names of joints, sensors and gpios begin with: `tf_prefix`, `prefix`."""

_LIST_MARKS = " \t\r\n[](){}'\""
"""Characters around a list of names, and around each name."""

_FREE_PARTS = frozenset(("parameters", "properties"))
"""Keys of free parts; an override can replace a list in one only as a whole."""


Path: TypeAlias = tuple[str | int, ...]


class PassthroughText(NamedTuple):
    """A text that is written to the output unchanged, its place, and its key, tag or attribute."""

    text: str
    where: Span
    key: str = ""


class HardwarePrefix(NamedTuple):
    """A hardware parameter that the names of a ros2_control system begin with, in the file; one of them is `part`."""

    control: str
    key: str
    text: str
    where: Span
    part: str


class PassthroughTexts(NamedTuple):
    """The texts of a file, without its modules, that get no prefix: those that plugins read, and absolute topics."""

    plugin_texts: tuple[PassthroughText, ...]
    absolute_topics: tuple[PassthroughText, ...]
    hardware_prefixes: tuple[HardwarePrefix, ...]
    tree: YamlNode
    prefix: str
    """The prefix of this module, without those of the files that use it."""

    is_shared: bool
    """Whether the robot uses the file more than once."""


def passthrough_texts(
    robot: Robot, tree: YamlNode, prefix: str, users: Collection[SourceFile], *, is_shared: bool
) -> PassthroughTexts:
    """Find the texts without prefix in the robot of one file and its tree, before its modules are merged.

    Overrides in a file that uses this one (`users`) have names of that file, which are final already.
    """
    texts = [
        PassthroughText(text, source.at(*path), _key_of(path))
        for source, field, parameters in _parameters(robot)
        for path, text in _texts(parameters, field)
        if source
    ]
    texts += _texts_of_controllers(robot)
    topics = (
        PassthroughText(sensor.topic, sensor.source.at("topic"))
        for sensor in robot.sensors
        if sensor.source and sensor.topic and sensor.topic.startswith("/")
    )
    own = (text for text in (*texts, *_raw_texts(tree)) if text.where.file not in users)
    hardware = (one for control in robot.ros2_controls for one in _prefixes_of(control) if one.where.file not in users)
    return PassthroughTexts(tuple(own), tuple(topics), tuple(hardware), tree, prefix, is_shared)


def _prefixes_of(control: Ros2Control) -> Iterator[HardwarePrefix]:
    """Yield the parameters of a system that some of its names begin with; an empty one is where each name begins."""
    names = [
        *((sensor.name, f"sensor '{sensor.name}'") for sensor in control.sensors),
        *((gpio.name, f"gpio '{gpio.name}'") for gpio in control.gpios),
        *((joint.name, f"joint '{joint.name}'") for joint in control.joints),
    ]
    source = control.source
    for key, text in control.parameters.items():
        if source and _PREFIX_KEY.fullmatch(key):
            # Kinova's descriptions write quotes around it.
            part = next((part for name, part in names if name.startswith(text.strip(_LIST_MARKS))), None)
            if part:
                yield HardwarePrefix(control.name, key, text, source.at("parameters", key), part)


def prefix_warnings(texts: PassthroughTexts, robot: Robot) -> Iterator[Diagnostic]:
    """Yield the warnings that hold if the file gets a prefix; the robot has the file and its modules."""
    paths: dict[Span, Path] = {}
    # A text may have a name several times.
    names_in_texts = {
        (name, text.where): text.text for text in texts.plugin_texts for name in _named_in(text.text, robot)
    }
    for kind, names in (("link", robot.links), ("joint", robot.joints)):
        for (name, where), whole in names_in_texts.items():
            if name not in names:
                continue
            remedy = f"write '$({kind}('{name}'))'"
            if where.file.is_xml:
                paths = paths or dict(_paths(texts.tree))
                to_final = f" to '{texts.prefix}{name}'" if texts.prefix else ""
                remedy = f"change it{to_final} by {_override(paths.get(where, ()), is_name=whole == name)}"
            yield UNPREFIXED_NAME.at(where, name=name, kind=kind, remedy=remedy)
    yield from _hardware_prefixes(texts)
    for topic, where, _ in texts.absolute_topics:
        yield ABSOLUTE_TOPIC.at(where, topic=topic)
    yield from _topics_and_frames(texts, robot)


def _hardware_prefixes(texts: PassthroughTexts) -> Iterator[Diagnostic]:
    """Yield a warning for each prefix that hardware reads and its names no longer begin with."""
    for one in texts.hardware_prefixes:
        bare = one.text.strip(_LIST_MARKS)
        remedy = f"write '$(prefix){bare}'"
        if texts.prefix and one.text == texts.prefix:
            if not one.where.file.is_xml:
                # It is `$(prefix)`, and names of the file begin alike.
                continue
            remedy = "its names have it already: use this file with 'prefix: \"\"'"
        elif one.where.file.is_xml:
            # In quotes, the middle is where an empty prefix is.
            at = one.text.find(bare) if bare else len(one.text) // 2
            to_final = f" to '{one.text[:at]}{texts.prefix}{one.text[at:]}'" if texts.prefix else ""
            path = ("ros2_control", one.control, "parameters", one.key)
            remedy = f"change it{to_final} by {_override(path, is_name=True)}"
        value = f"'{bare}'" if bare else "empty"
        yield UNPREFIXED_HARDWARE.at(
            one.where, key=one.key, control=one.control, value=value, part=one.part, remedy=remedy, bare=bare
        )


def _named_in(text: str, robot: Robot) -> Sequence[str]:
    """Return the links and joints in a text: the whole text, or items of a list with commas, brackets or spaces.

    Words with spaces between them are prose unless all of them are names; other lists may have other names, too.
    """
    if text in robot.links or text in robot.joints:
        return (text,)
    words = text.strip(_LIST_MARKS).split()
    if len(words) > 1 and all(word in robot.links or word in robot.joints for word in words):
        return words
    if "," not in text and not text.startswith("["):
        return ()
    items = [item.strip(_LIST_MARKS) for item in text.split(",")]
    is_list = not any(len(item.split()) > 1 for item in items)
    return [item for item in items if item in robot.links or item in robot.joints] if is_list else ()


def _override(path: Path, *, is_name: bool) -> str:
    """Return the override that replaces the value under a path, for a message.

    `is_name` is whether the value is the name alone.
    """
    free = next((at for at, key in enumerate(path) if key in _FREE_PARTS), len(path))
    reached = (*path[:free], *takewhile(lambda key: isinstance(key, str), path[free:]))
    override = "..."
    for key in reversed(reached):
        override = f"{{{key}: {override}}}"
    whole = "element" if free == len(path) else "list" if reached != path else "" if is_name else "text"
    value = f", '...' being the whole {whole} with that name in it" if whole else ""
    return f"'override: {override}' where this file is used{value}"


def _paths(node: YamlNode, *path: str | int) -> Iterator[tuple[Span, Path]]:
    """Yield the place of each scalar with the keys and positions that lead to it."""
    if isinstance(node, YamlScalar):
        yield node.span, path
    elif isinstance(node, YamlMap):
        for entry in node:
            yield from _paths(entry.value, *path, entry.name)
    elif isinstance(node, YamlList):
        for number, item in enumerate(node):
            yield from _paths(item, *path, number)


def _topics_and_frames(texts: PassthroughTexts, robot: Robot) -> Iterator[Diagnostic]:
    """Yield one warning for the topics and frames of a file that is a URDF or used more than once."""
    found: dict[str, Span] = {}
    for text, where, key in texts.plugin_texts:
        if not (texts.is_shared or where.file.is_xml) or _named_in(text, robot):
            continue
        # An argument of a xacro file may have put the prefix there.
        has_prefix = bool(texts.prefix) and texts.prefix in text
        if _TOPIC_OR_FRAME_KEY.search(key) and not _NOT_A_NAME.fullmatch(text) and not has_prefix:
            found.setdefault(text, where)
    if found:
        shown = [f"'{name}'" for name in found][:_MOST_SHOWN]
        more = f" and {len(found) - _MOST_SHOWN} more" if len(found) > _MOST_SHOWN else ""
        yield UNPREFIXED_TOPICS.at(next(iter(found.values())), names=", ".join(shown) + more)


def _parameters(robot: Robot) -> Iterator[tuple[SourceRef | None, str, FreePart]]:
    """Yield what plugins read: the source of its owner, its key there, and the parameters."""
    yield from ((block.source, "properties", block.properties) for block in robot.gazebo_elements)
    plugins = [plugin for block in robot.gazebo_elements for plugin in block.plugins]
    plugins += [sensor.plugin for sensor in robot.sensors if sensor.plugin]
    yield from ((plugin.source, "parameters", plugin.parameters) for plugin in plugins)
    yield from ((transmission.source, "parameters", transmission.parameters) for transmission in robot.transmissions)
    for control in robot.ros2_controls:
        yield control.source, "parameters", control.parameters
        yield from ((joint.source, "parameters", joint.parameters) for joint in control.joints)
        yield from ((sensor.source, "parameters", sensor.parameters) for sensor in control.sensors)
        yield from ((gpio.source, "parameters", gpio.parameters) for gpio in control.gpios)


def _texts_of_controllers(robot: Robot) -> Iterator[PassthroughText]:
    """Yield the texts among the parameters of controllers, and their names: those of gains are names of joints.

    The names in the parameters of the manager take the prefix, or are no names of joints.
    """
    for controller in robot.controllers:
        if controller.source:
            for path, text in _texts_in_data(controller.parameters, "parameters"):
                if isinstance(text, SourcedText):
                    continue
                yield PassthroughText(text, controller.source.at(*path), _key_of(path))


def _texts_in_data(value: object, *path: str | int) -> Iterator[tuple[tuple[str | int, ...], str]]:
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield (*path, Key(key)), key
            yield from _texts_in_data(item, *path, key)
    elif isinstance(value, Sequence):
        for number, item in enumerate(value):
            yield from _texts_in_data(item, *path, number)


def _key_of(path: tuple[str | int, ...]) -> str:
    """Return the tag or attribute at the end of a path; for a text or an item of a list, that of its element."""
    return next((str(key) for key in reversed(path) if isinstance(key, str) and key != "_text"), "")


def _texts(part: FreePart, *path: str | int) -> Iterator[tuple[tuple[str | int, ...], str]]:
    if isinstance(part, str):
        yield path, part
        return
    inner = part.items() if isinstance(part, Mapping) else enumerate(part)
    for key, value in inner:
        yield from _texts(value, *path, key)


def _raw_texts(tree: YamlNode) -> Iterator[PassthroughText]:
    """Yield the texts and attributes in the raw XML of a tree."""
    extras: list[YamlNode] = []
    _find_extras(tree, extras)
    for extra in extras:
        for item in extra.items if isinstance(extra, YamlList) else (extra,):
            if isinstance(item, YamlScalar):
                yield from (PassthroughText(text, item.span, key) for key, text in _texts_in_xml(item.text))


def _find_extras(node: YamlNode, found: list[YamlNode]) -> None:
    if isinstance(node, YamlMap):
        for name, entry in node.entries.items():
            if name == "extra":
                found.append(entry.value)
            elif not isinstance(entry.value, YamlScalar):
                _find_extras(entry.value, found)
    elif isinstance(node, YamlList):
        for item in node.items:
            _find_extras(item, found)


def _texts_in_xml(raw: str) -> Iterator[tuple[str, str]]:
    """Yield the texts and attributes of raw XML by their names, as they are written."""
    for piece in MARKUP.finditer(raw):
        if tag := piece["tag"]:
            following = MARKUP.match(raw, piece.end())
            yield tag, ((following and following["text"]) or "").strip()
            for found in ATTRIBUTE.finditer(piece[0]):
                if found["name"] != "name" or tag not in _NAMED_ELEMENTS:
                    yield found["name"], found["double"] or found["single"] or ""
