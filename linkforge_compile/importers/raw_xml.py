"""Raw XML as a spec keeps it: without its indentation, and with `$(prefix)` before the names of the robot's parts.

The prefix makes a module with raw XML usable several times in one robot. It is added where a text is certainly a
name; what plugins read may contain other names, which the compiler warns about where it can.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.core.fields import Name, Reference, field_specs
from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.geometry import Material
from linkforge_compile.core.models.joint import Joint, JointMimic
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.ros2_control import Ros2Control, Ros2ControlGpio, Ros2ControlSensor
from linkforge_compile.core.models.sensor import Sensor
from linkforge_compile.core.models.srdf import (
    Chain,
    EndEffector,
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    VirtualJoint,
)
from linkforge_compile.core.models.srdf_collisions import LinkSphereApproximation
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator
from linkforge_compile.core.part import Element
from linkforge_compile.source.xml_tree import ATTRIBUTE, MARKUP
from linkforge_compile.syntax import YamlScalar

_PREFIX = "$(prefix)"

_ELEMENTS: tuple[type[Element | Link], ...] = (
    *(Link, Visual, Collision, Material, Joint, JointMimic, Transmission, TransmissionActuator),
    *(Ros2Control, Ros2ControlSensor, Ros2ControlGpio, GazeboElement, GazeboPlugin, Sensor),
    *(PlanningGroup, Chain, GroupState, EndEffector, VirtualJoint, PassiveJoint, JointProperty),
    LinkSphereApproximation,
)


def _named_attributes() -> Iterator[tuple[str, str]]:
    """Yield each tag of the formats with an attribute that names a part of the robot."""
    for kind in _ELEMENTS:
        for spec in field_specs(kind).values():
            path, at, attribute = (spec.xml or "").rpartition("@")
            if isinstance(spec, Name | Reference) and at and not path.startswith(".."):
                yield path.rstrip("/") or kind.TAG, attribute
    yield from (("disable_collisions", "link1"), ("disable_collisions", "link2"))
    yield from (("enable_collisions", "link1"), ("enable_collisions", "link2"))
    yield "disable_default_collisions", "link"
    yield "gripper", "name"  # of HPP, which has it in an SRDF; the language does not


_NAMES = frozenset(_named_attributes())
"""The attributes that name parts of the robot, with their tags."""

_TAGS_WITH_NAMES = frozenset(tag for tag, _ in _NAMES)

_CHILDREN: Mapping[str, tuple[str, ...]] = {
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
"""The tags that mean what they do in `_NAMES`, by the tag around them; in a plugin they mean something else."""

_NAMES_AS_TEXT = (
    *(("contact", "collision"), ("sensor", "gz_frame_id"), ("sensor", "ignition_frame_id")),
    *(("camera", "optical_frame_id"), ("sensor", "topic"), ("contact", "topic")),
)
"""Elements whose text is a name, as (tag around it, tag)."""

_SECTION = "<![CDATA["
_LINK_COLLISION = re.compile(r"(?P<link>.+)_collision(?:_[0-9]+)?")
"""The name that Gazebo gives a link's unnamed collision; collisions of merged links have other names."""

_RESERVED = re.compile(r"__.*__")
"""A word with a meaning to Gazebo, such as `__default_topic__`."""

_LINE_END = "\x01"  # no XML contains it
_BROKEN_VALUE = re.compile(r"""=\s*(?:"[^"<]*[\r\n][^"]*"|'[^'<]*[\r\n][^']*')""")
_INDENT = re.compile(r"^[ \t]+")


class Shapes(NamedTuple):
    """The names of a robot's links and collisions, which tell whether a contact sensor names one of them."""

    links: frozenset[str] = frozenset()
    collisions: frozenset[str] = frozenset()

    def has_collision(self, name: str) -> bool:
        """Whether a collision has this name: its own, or the one that Gazebo derives from its link's."""
        derived = _LINK_COLLISION.fullmatch(name)
        return name in self.collisions or (derived is not None and derived["link"] in self.links)


NO_SHAPES = Shapes()


def without_instructions(raw: str) -> str:
    """Remove processing instructions from raw XML; the reader reports them, and a spec cannot contain them."""
    return "".join(found[0] for found in MARKUP.finditer(raw) if found.lastgroup != "instruction")


def tidy(raw: str) -> str:
    """Remove the indentation that an element has in its file, where that changes only space between tags."""
    has_lines = any(found["text"] and "\n" in found[0] and found[0].strip() for found in MARKUP.finditer(raw))
    if has_lines or _SECTION in raw or _BROKEN_VALUE.search(raw):
        return raw
    lines = MARKUP.sub(_tidy_piece, raw.replace("\r\n", "\n").replace("\r", "\n"))
    first, *others = [line.rstrip() for line in lines.split("\n")]
    others = [_INDENT.sub(lambda space: space[0].expandtabs(2), line) for line in others if line]
    margin = min((len(line) - len(line.lstrip(" ")) for line in others), default=0)
    return "\n".join((first, *(line[margin:] for line in others))).replace(_LINE_END, "\n")


def _tidy_piece(found: re.Match[str]) -> str:
    """Return `<tag />` as `<tag/>`, a comment as one line, so that its indentation stays, and others as they are."""
    piece = found[0]
    if found["start"] and piece.endswith("/>"):
        return f"{piece[:-2].rstrip()}/>"
    return piece.replace("\n", _LINE_END) if found["comment"] else piece


def known_tag(tag: str, around: str | None) -> str | None:
    """Return the tag of an element in which names are certain; None in elements whose meaning is unknown."""
    return tag if around is not None and tag in _CHILDREN.get(around, ()) else None


def is_name(tag: str | None, attribute: str) -> bool:
    """Whether an attribute of an element with a known tag names a part of the robot."""
    return (tag, attribute) in _NAMES


def is_name_as_text(tag: str, around: str | None, text: str, shapes: Shapes) -> bool:
    """Whether the text of an element names a part of the robot with these shapes."""
    return (around, tag) in _NAMES_AS_TEXT and (tag != "collision" or shapes.has_collision(text.strip()))


def with_prefix(node: YamlScalar) -> YamlScalar:
    """Return a name with `$(prefix)` before it."""
    text = _with_prefix(node.text)
    return node if text == node.text else YamlScalar(text, text, node.span)


def raw_with_prefix(raw: str, around: str, shapes: Shapes) -> str:
    """Return an element's text with `$(prefix)` before each name in it; `around` is the tag around the element."""
    open_tags: list[str | None] = [around]
    pieces: list[str] = []
    opened, text_begins = "", 0
    for found in MARKUP.finditer(raw):
        if opened and found.lastgroup in ("start", "end"):
            pieces[text_begins:] = _text_with_prefix(pieces[text_begins:], opened, open_tags[-2], shapes)
            opened = ""
        if found.lastgroup == "end":
            open_tags.pop()
        if found.lastgroup != "start":
            pieces.append(found[0])
            continue
        tag = found["tag"]
        known = known_tag(tag, open_tags[-1])
        pieces.append(_tag_with_prefix(found[0], known) if known in _TAGS_WITH_NAMES else found[0])
        if not found[0].endswith("/>"):
            opened, text_begins = tag if (open_tags[-1], tag) in _NAMES_AS_TEXT else "", len(pieces)
            open_tags.append(known)
    return "".join(pieces)


def _text_with_prefix(pieces: list[str], tag: str, around: str | None, shapes: Shapes) -> list[str]:
    """Return the pieces of an element's text, with comments and CDATA, prefixed if the text is a name."""
    texts = [_characters(piece) for piece in pieces]
    name = "".join(texts)
    if not is_name_as_text(tag, around, name, shapes) or _with_prefix(name) == name:
        return pieces
    first = next(number for number, text in enumerate(texts) if text.strip())
    section = _SECTION if pieces[first].startswith(_SECTION) else ""
    text = pieces[first].removeprefix(section)
    space = text[: len(text) - len(text.lstrip())]
    return [*pieces[:first], f"{section}{space}{_PREFIX}{text.lstrip()}", *pieces[first + 1 :]]


def _characters(piece: str) -> str:
    """Return the characters of a text or CDATA section; none of a comment."""
    if piece.startswith("<!--"):
        return ""
    return piece.removeprefix(_SECTION).removesuffix("]]>") if piece.startswith(_SECTION) else piece


def _tag_with_prefix(start: str, tag: str | None) -> str:
    def put_prefix(found: re.Match[str]) -> str:
        if not is_name(tag, found["name"]):
            return found[0]
        group = "single" if found["double"] is None else "double"
        begin, end = found.start(group) - found.start(), found.end(group) - found.start()
        return f"{found[0][:begin]}{_with_prefix(found[group])}{found[0][end:]}"

    return ATTRIBUTE.sub(put_prefix, start)


def _with_prefix(name: str) -> str:
    """Return a name with the prefix before it, but absolute and private topics and scoped names as they are."""
    bare = name.lstrip()
    if not bare or bare[0] in "/~" or "::" in bare or _RESERVED.fullmatch(bare.rstrip()):
        return name
    return f"{name[: len(name) - len(bare)]}{_PREFIX}{bare}"
