"""What stands under two names in the semantic part: pairs of links, states of groups, properties of joints."""

from __future__ import annotations

from collections.abc import Callable

from linkforge_compile.importers.draft import DeclinedError
from linkforge_compile.importers.reading import Reading
from linkforge_compile.importers.srdf.known import Known
from linkforge_compile.source.xml_tree import XmlAttribute, XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

Outer = dict[str, tuple[XmlAttribute, dict[str, tuple[XmlAttribute, YamlNode]]]]


def read_nested(
    robot: Reading, tag: str, outer: str, inner: str, read: Callable[[Reading], YamlNode]
) -> YamlMap | None:
    """Read the children of a tag by the names that two of their attributes give, in the order of the file.

    What shares its outer name comes together where that first stands. A pair of names that is taken stays raw.
    """
    found: Outer = {}
    first: dict[str, XmlElement] = {}

    def read_one(part: Reading) -> YamlNode:
        names = part.element.attributes.get(outer), part.element.attributes.get(inner)
        node = read(part)
        first_name, second_name = names
        if first_name is None or second_name is None:
            raise part.declined(f"it lacks '{outer}' or '{inner}'")
        _, under = found.setdefault(first_name.value, (first_name, {}))
        if second_name.value in under:
            raise DeclinedError(f"'{first_name.value}' and '{second_name.value}' are there already", second_name.span)
        under[second_name.value] = second_name, node
        first.setdefault(first_name.value, part.element)
        return node

    for child in [child for child in robot.children() if child.tag == tag]:
        robot.take(child, read_one)
    return _section(robot, found, first)


def _section(robot: Reading, found: Outer, first: dict[str, XmlElement]) -> YamlMap | None:
    """Return the map of maps; what stands above the first of a name is said of them all."""
    section = {}
    for name, (attribute, under) in found.items():
        node = robot.draft.named(under, attribute.span)
        if node is not None:
            robot.draft.made(node, first[name])
            section[name] = attribute, node
    return robot.draft.named(section, robot.span)


def read_pair(pair: Reading, known: Known) -> YamlNode:
    """Read a pair of links: its reason, null for none, or the long form."""
    for end in ("link1", "link2"):
        known.link(pair, end)
    reason = pair.attribute("reason") if pair.element.get("reason") is not None else None
    if pair.is_spent():
        return pair.draft.word(reason.value, reason.span) if reason else YamlScalar("null", None, pair.span)
    return pair.map(reason=pair.draft.text(reason.value, reason.span) if reason else None)


def read_property(remark: Reading, known: Known) -> YamlNode:
    """Read a property of a joint: its text, or the long form."""
    known.joint(remark, "joint_name")
    remark.attribute("property_name")
    said = remark.attribute("value")
    value = remark.draft.word(said.value, said.span)
    return value if remark.is_spent() else remark.map(value=value)
