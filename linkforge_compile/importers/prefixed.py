"""Names in what stays raw: they say `$(prefix)`, so that a robot can be used several times that way too.

Only where a name is certain. What plugins read may hold names too, which nobody but the plugin knows; the compiler
tells of those that it can tell.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

from linkforge_compile.source.xml_places import ATTRIBUTE, MARKUP
from linkforge_compile.syntax import YamlScalar

_PREFIX = "$(prefix)"

_NAMES: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(("link", "joint", "visual", "collision", "material", "transmission", "actuator"), ("name",)),
    **dict.fromkeys(("ros2_control", "sensor", "gpio", "plugin", "group", "passive_joint"), ("name",)),
    # Only raw XML has one, for HPP; of two uses each has its own, as of a group.
    "gripper": ("name",),
    "gazebo": ("reference",),
    "parent": ("link",),
    "child": ("link",),
    "mimic": ("joint",),
    "chain": ("base_link", "tip_link"),
    "group_state": ("name", "group"),
    "end_effector": ("name", "group", "parent_link", "parent_group"),
    "virtual_joint": ("name", "child_link"),
    "disable_collisions": ("link1", "link2"),
    "enable_collisions": ("link1", "link2"),
    "disable_default_collisions": ("link",),
    "joint_property": ("joint_name",),
    "link_sphere_approximation": ("link",),
}
"""The attributes that name parts of the robot, by the tag of the element; the prefix goes before them in the IR too."""

_INSIDE: Mapping[str, tuple[str, ...]] = {
    "robot": (
        *("link", "joint", "material", "transmission", "ros2_control", "gazebo"),
        *("group", "passive_joint", "group_state", "end_effector", "virtual_joint", "disable_collisions"),
        *("enable_collisions", "disable_default_collisions", "joint_property", "link_sphere_approximation"),
        "gripper",
    ),
    "link": ("visual", "collision"),
    "visual": ("material",),
    "joint": ("parent", "child", "mimic"),
    "transmission": ("joint", "actuator"),
    "ros2_control": ("joint", "sensor", "gpio", "transmission"),
    "gazebo": ("sensor", "plugin"),
    "sensor": ("plugin", "contact", "camera", "topic", "gz_frame_id", "ignition_frame_id"),
    "contact": ("collision", "topic"),
    "camera": ("optical_frame_id",),
    "group": ("link", "joint", "chain", "group", "passive_joint"),
    "gripper": ("link",),
    "group_state": ("joint",),
}
"""In which elements these stand. The same tag elsewhere, in a plugin say, is something else."""

_NAMES_BY_TEXT = (
    *(("contact", "collision"), ("sensor", "gz_frame_id"), ("sensor", "ignition_frame_id")),
    *(("camera", "optical_frame_id"), ("sensor", "topic"), ("contact", "topic")),
)
"""Elements whose text is the name, each with the tag around it."""

_SECTION = "<![CDATA["
_LINK_COLLISION = re.compile(r"(?P<link>.+)_collision(?:_[0-9]+)?")
"""How Gazebo calls the collisions of a link that have no name; those of links that it merges are called otherwise."""

_RESERVED = re.compile(r"__.*__")
"""What means something to Gazebo rather than naming a part, such as `__default_topic__`."""


class Shapes(NamedTuple):
    """The names of the links and collisions that a file has; a contact sensor's are certain by them alone."""

    links: frozenset[str] = frozenset()
    collisions: frozenset[str] = frozenset()

    def has_collision(self, name: str) -> bool:
        """Whether a name is that of a collision: its own, or the one that Gazebo makes from its link's."""
        made = _LINK_COLLISION.fullmatch(name)
        return name in self.collisions or (made is not None and made["link"] in self.links)


NO_SHAPES = Shapes()


def place_of(tag: str, around: str | None) -> str | None:
    """Return the place in which names may stand that an element makes, its tag; None where none can be certain."""
    return tag if around is not None and tag in _INSIDE.get(around, ()) else None


def names(place: str | None, attribute: str) -> bool:
    """Whether an attribute of an element names a part of the robot."""
    return place is not None and attribute in _NAMES.get(place, ())


def names_by_text(tag: str, around: str | None, text: str, shapes: Shapes) -> bool:
    """Whether the text of an element names a part of the robot, whose shapes these are."""
    return (around, tag) in _NAMES_BY_TEXT and (tag != "collision" or shapes.has_collision(text.strip()))


def with_prefix(node: YamlScalar) -> YamlScalar:
    """Return a name with the prefix before it."""
    text = _with_prefix(node.text)
    return node if text == node.text else YamlScalar(text, text, node.span)


def raw_with_prefix(raw: str, around: str, shapes: Shapes) -> str:
    """Return an element as it stands in a file, with the prefix before each name; `around` is the tag around it."""
    places: list[str | None] = [around]
    pieces: list[str] = []
    opened, text_begins = "", 0
    for found in MARKUP.finditer(raw):
        if opened and found.lastgroup in ("start", "end"):
            pieces[text_begins:] = _text_with_prefix(pieces[text_begins:], opened, places[-2], shapes)
            opened = ""
        if found.lastgroup == "end":
            places.pop()
        if found.lastgroup != "start":
            pieces.append(found[0])
            continue
        tag = found["tag"]
        place = place_of(tag, places[-1])
        pieces.append(_tag_with_prefix(found[0], place) if place in _NAMES else found[0])
        if not found[0].endswith("/>"):
            opened, text_begins = tag if (places[-1], tag) in _NAMES_BY_TEXT else "", len(pieces)
            places.append(place)
    return "".join(pieces)


def _text_with_prefix(pieces: list[str], tag: str, around: str | None, shapes: Shapes) -> list[str]:
    """Return the text at the start of an element, comments and sections with it, prefixed if it is a name."""
    texts = [_characters(piece) for piece in pieces]
    name = "".join(texts)
    if not names_by_text(tag, around, name, shapes) or _with_prefix(name) == name:
        return pieces
    first = next(number for number, text in enumerate(texts) if text.strip())
    section = _SECTION if pieces[first].startswith(_SECTION) else ""
    said = pieces[first].removeprefix(section)
    space = said[: len(said) - len(said.lstrip())]
    return [*pieces[:first], f"{section}{space}{_PREFIX}{said.lstrip()}", *pieces[first + 1 :]]


def _characters(piece: str) -> str:
    """Return what a text, a comment or a section of characters says."""
    if piece.startswith("<!--"):
        return ""
    return piece.removeprefix(_SECTION).removesuffix("]]>") if piece.startswith(_SECTION) else piece


def _tag_with_prefix(start: str, place: str | None) -> str:
    def named(found: re.Match[str]) -> str:
        if not names(place, found["name"]):
            return found[0]
        group = "single" if found["double"] is None else "double"
        before, behind = found.start(group) - found.start(), found.end(group) - found.start()
        return f"{found[0][:before]}{_with_prefix(found[group])}{found[0][behind:]}"

    return ATTRIBUTE.sub(named, start)


def _with_prefix(name: str) -> str:
    """Return a name with the prefix before it: an absolute or private topic is none, nor what is another's."""
    bare = name.lstrip()
    if not bare or bare[0] in "/~" or "::" in bare or _RESERVED.fullmatch(bare.rstrip()):
        return name
    return f"{name[: len(name) - len(bare)]}{_PREFIX}{bare}"
