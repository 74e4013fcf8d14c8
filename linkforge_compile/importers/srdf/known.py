"""What an SRDF may name: the links and joints of its robot, and the groups that it has itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from linkforge_compile.importers.draft import DeclinedError
from linkforge_compile.importers.reading import Reading
from linkforge_compile.source.xml_tree import XmlAttribute, XmlElement
from linkforge_compile.syntax import YamlMap, YamlScalar
from linkforge_compile.units import Dimension

_TURNING = ("revolute", "continuous")
_LINKS_AND_JOINTS = ("link", "link1", "link2", "base_link", "tip_link", "parent_link", "child_link", "joint_name")
_NAMED_BY_NAME = ("link", "joint", "passive_joint")


@dataclass
class Known:
    """Names as the spec writes them; what stands under another is kept raw, for MoveIt skips it."""

    links: set[str]
    joints: set[str]
    turning: frozenset[str]
    """The joints whose position is an angle."""
    groups: set[str] = field(default_factory=set)
    unread: set[str] = field(default_factory=set)
    """The groups that are still to be read."""

    @classmethod
    def of(cls, tree: YamlMap) -> Known:
        """Return what the spec of a URDF has."""
        links, joints, frames = (tree.get(key) for key in ("links", "joints", "frames"))
        known = cls(_names(links), _names(joints), frozenset(_turning(joints)))
        for frame in frames if isinstance(frames, YamlMap) else ():
            known.links.add(frame.name)
            named = frame.value.child("joint")
            known.joints.add(named.text if isinstance(named, YamlScalar) else f"{frame.name}_joint")
        return known

    def link(self, owner: Reading, name: str) -> YamlScalar:
        return _known(owner, name, "link", self.links)

    def joint(self, owner: Reading, name: str) -> YamlScalar:
        return _known(owner, name, "joint", self.joints)

    def group(self, owner: Reading, name: str) -> YamlScalar:
        return _known(owner, name, "planning group", self.groups)

    def subgroup(self, owner: Reading, name: str) -> YamlScalar:
        """Take the name of a group inside another: it has been read by now, unless the two are a circle."""
        if (said := owner.element.attributes.get(name)) and said.value in self.unread:
            raise DeclinedError(f"planning group '{said.value}' contains the group that it is in", said.span)
        return self.group(owner, name)

    def measure(self, joint: str) -> Dimension | None:
        return Dimension.ANGLE if joint in self.turning else None


def _known(owner: Reading, attribute: str, kind: str, names: set[str]) -> YamlScalar:
    """Take an attribute that names one of these."""
    name = owner.name(attribute)
    if name.text not in names:
        raise DeclinedError(f"there is no {kind} named '{name.text}'", name.span)
    return name


def named_parts(element: XmlElement) -> Iterator[XmlAttribute]:
    """Yield what an SRDF names of its robot, links and joints, in the order of the file."""
    for name, attribute in element.attributes.items():
        if name in _LINKS_AND_JOINTS or (name == "name" and element.tag in _NAMED_BY_NAME):
            yield attribute
    for child in element.children:
        yield from named_parts(child)


def _names(section: object) -> set[str]:
    return {entry.name for entry in section} if isinstance(section, YamlMap) else set()


def _turning(joints: object) -> set[str]:
    if not isinstance(joints, YamlMap):
        return set()
    kinds = ((entry.name, entry.value.child("type")) for entry in joints)
    return {name for name, kind in kinds if isinstance(kind, YamlScalar) and kind.text in _TURNING}
