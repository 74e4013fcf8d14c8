"""What a module's prefix does not reach: names that plugins read, in parameters or raw XML, and absolute topics."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import takewhile
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.frozen_map import FreePart
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.model import ABSOLUTE_TOPIC, UNPREFIXED_NAME, UNPREFIXED_TOPICS
from linkforge_compile.source import SourceFile, SourceRef, Span
from linkforge_compile.source.xml_places import ATTRIBUTE, MARKUP
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar

_NAMED_FOR_ITSELF = ("visual", "collision", "material")
"""Elements whose own name may well be that of their link."""

_SAYS_TOPIC_OR_FRAME = re.compile(
    r"(?:topic|frame|namespace|remapping)(?:_?(?:name|id|prefix))?s?$|^collision$", re.IGNORECASE
)
"""The end of a key, a tag or an attribute that plugins give topics and frames by: `imageTopicName`, `frame_id`; and
the tag by which a contact sensor names what it feels."""

# In a force-torque sensor, `frame` is one of three words.
_IS_NO_NAME = re.compile(r"[-+.\d\s]*|true|false|child|parent|sensor|__.*__", re.IGNORECASE)
_MOST_SHOWN = 5

_AROUND_A_LIST = " \t\r\n[](){}'\""
"""What stands around the names of a list, and around each."""

_WRITTEN_WHOLE = frozenset(("parameters", "properties"))
"""Free parts: a list in one can only be written anew as a whole."""


Path: TypeAlias = tuple[str | int, ...]


class Text(NamedTuple):
    """A text that is passed on as it is, where it was written, and the key, tag or attribute that it is said by."""

    text: str
    where: Span
    key: str = ""


class PassedOn(NamedTuple):
    """What a file itself says that takes no prefix: texts that plugins read, and absolute topics."""

    plugin_texts: tuple[Text, ...]
    absolute_topics: tuple[Text, ...]
    tree: YamlNode
    prefix: str
    """Of this use alone, without those of the files around it."""

    is_shared: bool
    """Whether the robot has the file more than once."""


def passed_on(robot: Robot, tree: YamlNode, prefix: str, users: Collection[SourceFile], *, is_shared: bool) -> PassedOn:
    """Find what no prefix reaches in the robot of one file and in its tree, before its modules join it.

    What an override wrote in a file that uses this one (`users`) has the names of that file: final ones here.
    """
    texts = [
        Text(text, source.at(*path), _key_of(path))
        for source, field, parameters in _parameters(robot)
        for path, text in _texts(parameters, field)
        if source
    ]
    topics = (
        Text(sensor.topic, sensor.source.at("topic"))
        for sensor in robot.sensors
        if sensor.source and sensor.topic and sensor.topic.startswith("/")
    )
    own = (text for text in (*texts, *_raw_texts(tree)) if text.where.file not in users)
    return PassedOn(tuple(own), tuple(topics), tree, prefix, is_shared)


def warnings_under_a_prefix(passed: PassedOn, robot: Robot) -> Iterator[Diagnostic]:
    """Yield what there is to tell once the file takes a prefix; the robot is the file with its modules."""
    paths: dict[Span, Path] = {}
    # A raw text may say one name often.
    said = {(name, text.where): text.text for text in passed.plugin_texts for name in _named_in(text.text, robot)}
    for kind, names in (("link", robot.links), ("joint", robot.joints)):
        for (name, where), whole in said.items():
            if name not in names:
                continue
            remedy = f"write '$({kind}('{name}'))'"
            if where.file.is_xml:
                paths = paths or dict(_paths(passed.tree))
                to_final = f" to '{passed.prefix}{name}'" if passed.prefix else ""
                remedy = f"change it{to_final} by {_override(paths.get(where, ()), is_name=whole == name)}"
            yield UNPREFIXED_NAME.at(where, name=name, kind=kind, remedy=remedy)
    for topic, where, _ in passed.absolute_topics:
        yield ABSOLUTE_TOPIC.at(where, topic=topic)
    yield from _topics_and_frames(passed, robot)


def _named_in(text: str, robot: Robot) -> Sequence[str]:
    """Return the links and joints that a text names: as a whole, or as a list with commas, brackets or spaces.

    Words with spaces between them may be prose, unless all of them are names; a list may have names of other files.
    """
    if text in robot.links or text in robot.joints:
        return (text,)
    words = text.strip(_AROUND_A_LIST).split()
    if len(words) > 1 and all(word in robot.links or word in robot.joints for word in words):
        return words
    if "," not in text and not text.startswith("["):
        return ()
    items = [item.strip(_AROUND_A_LIST) for item in text.split(",")]
    is_list = not any(len(item.split()) > 1 for item in items)
    return [item for item in items if item in robot.links or item in robot.joints] if is_list else ()


def _override(path: Path, *, is_name: bool) -> str:
    """Say the override that reaches what stands under a path, and what takes the place of its value.

    `is_name` is whether the name is all that stands there.
    """
    free = next((at for at, key in enumerate(path) if key in _WRITTEN_WHOLE), len(path))
    reached = (*path[:free], *takewhile(lambda key: isinstance(key, str), path[free:]))
    said = "..."
    for key in reversed(reached):
        said = f"{{{key}: {said}}}"
    whole = "element" if free == len(path) else "list" if reached != path else "" if is_name else "text"
    value = f", '...' being the whole {whole} with that name in it" if whole else ""
    return f"'override: {said}' where this file is used{value}"


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


def _topics_and_frames(passed: PassedOn, robot: Robot) -> Iterator[Diagnostic]:
    """Yield once for a file that was written elsewhere, or is used again, which topics and frames its plugins name."""
    found: dict[str, Span] = {}
    for text, where, key in passed.plugin_texts:
        is_told = bool(_named_in(text, robot))
        # An argument of a xacro may have put it there.
        has_prefix = bool(passed.prefix) and passed.prefix in text
        is_judged = passed.is_shared or where.file.is_xml
        if is_judged and _names_topic_or_frame(key, text) and not (is_told or has_prefix):
            found.setdefault(text, where)
    if found:
        shown = [f"'{name}'" for name in found][:_MOST_SHOWN]
        more = f" and {len(found) - _MOST_SHOWN} more" if len(found) > _MOST_SHOWN else ""
        yield UNPREFIXED_TOPICS.at(next(iter(found.values())), names=", ".join(shown) + more)


def _names_topic_or_frame(key: str, text: str) -> bool:
    return bool(_SAYS_TOPIC_OR_FRAME.search(key)) and not _IS_NO_NAME.fullmatch(text)


def _parameters(robot: Robot) -> Iterator[tuple[SourceRef | None, str, FreePart]]:
    """Yield what plugins read: where its owner was written, and under which key of that it stands."""
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


def _key_of(path: tuple[str | int, ...]) -> str:
    """Return the tag or attribute at the end of a path; that of the element for its text, or one of several."""
    return next((str(key) for key in reversed(path) if isinstance(key, str) and key != "_text"), "")


def _texts(part: FreePart, *path: str | int) -> Iterator[tuple[tuple[str | int, ...], str]]:
    if isinstance(part, str):
        yield path, part
        return
    inner = part.items() if isinstance(part, Mapping) else enumerate(part)
    for key, value in inner:
        yield from _texts(value, *path, key)


def _raw_texts(tree: YamlNode) -> Iterator[Text]:
    """Yield what the raw XML of a tree says in attributes and elements."""
    extras: list[YamlNode] = []
    _find_extras(tree, extras)
    for extra in extras:
        for item in extra.items if isinstance(extra, YamlList) else (extra,):
            if isinstance(item, YamlScalar):
                yield from (Text(text, item.span, key) for key, text in _said_in(item.text))


def _find_extras(node: YamlNode, found: list[YamlNode]) -> None:
    # Each use of each file is walked through: a generator would hand what it yields up through all that are around it.
    if isinstance(node, YamlMap):
        for name, entry in node.entries.items():
            if name == "extra":
                found.append(entry.value)
            elif not isinstance(entry.value, YamlScalar):
                _find_extras(entry.value, found)
    elif isinstance(node, YamlList):
        for item in node.items:
            _find_extras(item, found)


def _said_in(raw: str) -> Iterator[tuple[str, str]]:
    """Yield the texts and attributes of raw XML by their names, as they are written."""
    for piece in MARKUP.finditer(raw):
        if tag := piece["tag"]:
            following = MARKUP.match(raw, piece.end())
            yield tag, ((following and following["text"]) or "").strip()
            for found in ATTRIBUTE.finditer(piece[0]):
                if found["name"] != "name" or tag not in _NAMED_FOR_ITSELF:
                    yield found["name"], found["double"] or found["single"] or ""
