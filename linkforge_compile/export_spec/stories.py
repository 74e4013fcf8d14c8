"""How the names of an expression got their values, in the words of `explain`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from linkforge_compile.expand.listing import as_written
from linkforge_compile.expand.origins import NameOrigin, Setting, names_behind
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlNode

_LONGEST_TEXT = 60


class NameStory(NamedTuple):
    """A name, its value, and what set it: "the default 0.8 m at arm.robot.yaml:6:11".

    `instead_of` is what would have set it otherwise, the next in line first. `names` are those that the value was
    computed from in turn.
    """

    name: str
    value: str
    setting: str
    instead_of: tuple[str, ...]
    names: tuple[NameStory, ...]


def stories(node: YamlNode) -> tuple[tuple[NameStory, ...], Span | None]:
    """Return how the names behind a computed node got their values.

    With it comes where the value itself was written that is handed on as it is, None where a story says so or it was
    made in between.
    """
    origins = names_behind(node)
    origin = node.span.origin
    is_told = origin is None or origin.span in _places(origins)
    return tuple(map(_story, origins)), None if is_told or origin is None else origin.span


def _story(origin: NameOrigin) -> NameStory:
    instead_of = tuple(map(_words, origin.setting.instead_of))
    return NameStory(origin.name, origin.value, _words(origin.setting), instead_of, tuple(map(_story, origin.names)))


def _words(setting: Setting) -> str:
    place = setting.node.span
    if setting.named_by is not None:
        return f"the content of {place.file.name}, named at {setting.named_by.span}"
    if setting.by == "the command line":
        return f"from {setting.by}: {place.file.text}"
    text = as_written(setting.node)
    return f"{setting.by} {text} at {place}" if text and len(text) <= _LONGEST_TEXT else f"{setting.by} at {place}"


def _places(names: tuple[NameOrigin, ...]) -> Iterator[Span]:
    for name in names:
        yield name.setting.node.span
        yield from _places(name.names)
