"""Names in what stays raw: they say `$(prefix)`, so that a robot can be used several times that way too.

Only where a name is certain. What plugins read may hold names too, which nobody but the plugin knows; the compiler
tells of those that it can tell.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from linkforge_compile.syntax import YamlScalar

_PREFIX = "$(prefix)"

_NAMES: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(("link", "joint", "visual", "collision", "material", "transmission", "actuator"), ("name",)),
    **dict.fromkeys(("ros2_control", "sensor", "gpio", "plugin", "group", "passive_joint"), ("name",)),
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
    "robot": tuple(tag for tag in _NAMES if tag not in ("visual", "collision", "actuator", "gpio", "plugin", "sensor")),
    "link": ("visual", "collision"),
    "visual": ("material",),
    "joint": ("parent", "child", "mimic"),
    "transmission": ("joint", "actuator"),
    "ros2_control": ("joint", "sensor", "gpio", "transmission"),
    "gazebo": ("sensor", "plugin"),
    "sensor": ("plugin", "contact", "camera", "topic", "gz_frame_id", "ignition_frame_id"),
    "contact": ("collision", "topic"),
    "camera": ("optical_frame_id",),
    "group": ("link", "joint", "chain", "group"),
    "group_state": ("joint",),
}
"""In which elements these stand. The same tag elsewhere, in a plugin say, is something else."""

_NAMES_BY_TEXT = (
    *(("contact", "collision"), ("sensor", "gz_frame_id"), ("sensor", "ignition_frame_id")),
    *(("camera", "optical_frame_id"), ("sensor", "topic"), ("contact", "topic")),
)
"""Elements whose text is the name, each with the tag around it."""

_MARKUP = re.compile(
    r"""<!--.*?-->|<!\[CDATA\[.*?\]\]>|<(?P<end>/?)(?P<tag>[^\s/<>!?"']+)(?:[^<>"']|"[^"]*"|'[^']*')*>""", re.DOTALL
)
"""A comment, a section of characters, or a tag whole: a `>` may stand in an attribute."""

_ATTRIBUTE = re.compile(r"""(?<=\s)(?P<name>[^\s=/>"']+)\s*=\s*(?:"(?P<double>[^"]*)"|'(?P<single>[^']*)')""")


def place_of(tag: str, around: str | None) -> str | None:
    """Return the place in which names may stand that an element makes, its tag; None where none can be certain."""
    return tag if around is not None and tag in _INSIDE.get(around, ()) else None


def names(place: str | None, attribute: str) -> bool:
    """Whether an attribute of an element names a part of the robot."""
    return place is not None and attribute in _NAMES.get(place, ())


def names_by_text(tag: str, around: str | None) -> bool:
    """Whether the text of an element names a part of the robot."""
    return (around, tag) in _NAMES_BY_TEXT


def with_prefix(node: YamlScalar) -> YamlScalar:
    """Return a name with the prefix before it."""
    text = _with_prefix(node.text)
    return node if text == node.text else YamlScalar(text, text, node.span)


def raw_with_prefix(raw: str, around: str) -> str:
    """Return an element as it stands in a file, with the prefix before each name; `around` is the tag around it."""
    places: list[str | None] = [around]
    text_before = 0
    is_name = False
    pieces: list[str] = []
    for found in _MARKUP.finditer(raw):
        text = raw[text_before : found.start()]
        pieces.append(_with_prefix(text) if is_name else text)
        text_before, is_name = found.end(), False
        tag = found["tag"]
        if tag is None or found["end"]:
            pieces.append(found[0])
            if tag is not None:
                places.pop()
            continue
        place = place_of(tag, places[-1])
        pieces.append(_tag_with_prefix(found[0], place) if place in _NAMES else found[0])
        if not found[0].endswith("/>"):
            is_name = names_by_text(tag, places[-1])
            places.append(place)
    return "".join((*pieces, raw[text_before:]))


def _tag_with_prefix(start: str, place: str | None) -> str:
    def named(found: re.Match[str]) -> str:
        if not names(place, found["name"]):
            return found[0]
        group = "single" if found["double"] is None else "double"
        before, behind = found.start(group) - found.start(), found.end(group) - found.start()
        return f"{found[0][:before]}{_with_prefix(found[group])}{found[0][behind:]}"

    return _ATTRIBUTE.sub(named, start)


def _with_prefix(name: str) -> str:
    """Return a name with the prefix before it: an absolute or private topic is none, nor what names another model."""
    bare = name.lstrip()
    if not bare or bare[0] in "/~" or "::" in bare:
        return name
    return f"{name[: len(name) - len(bare)]}{_PREFIX}{bare}"
