"""Read an SRDF document as the semantic part of a spec, each section in the order of the file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from linkforge_compile.core.models.srdf import (
    Chain,
    EndEffector,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    VirtualJoint,
)
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation, SrdfSphere
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import OTHER_ROBOT
from linkforge_compile.importers.document import Imported, place_comments
from linkforge_compile.importers.element_reader import ElementReader, Named, read_named
from linkforge_compile.importers.elements import Names, read_element, read_reference
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft
from linkforge_compile.source.xml_tree import XmlAttribute, XmlDocument, XmlElement
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Dimension

_TURNING = ("revolute", "continuous")
_RESERVED = frozenset(("extra", "extra_attributes", "extra_inside", "for", "when"))
"""Keys of a group state, which joints in it cannot be named."""


@dataclass
class SemanticNames:
    """The names that an SRDF may refer to, as the spec writes them; MoveIt skips what has others, so it stays raw."""

    links: set[str]
    joints: set[str]
    turning: frozenset[str]
    """The joints whose position is an angle."""
    groups: set[str] = field(default_factory=set)
    unread_groups: set[str] = field(default_factory=set)

    @classmethod
    def of(cls, tree: YamlMap) -> SemanticNames:
        """Return the names of links and joints in the spec of a URDF."""
        links, joints, frames = (tree.get(key) for key in ("links", "joints", "frames"))
        names = cls(_keys(links), _keys(joints), frozenset(_turning_joints(joints)))
        for frame in frames if isinstance(frames, YamlMap) else ():
            names.links.add(frame.name)
            joint = frame.value.child("joint")
            names.joints.add(joint.text if isinstance(joint, YamlScalar) else f"{frame.name}_joint")
        return names

    @property
    def by_kind(self) -> Names:
        return {"link": self.links, "joint": self.joints, "group": self.groups}


def _keys(section: object) -> set[str]:
    return {entry.name for entry in section} if isinstance(section, YamlMap) else set()


def _turning_joints(joints: object) -> Iterator[str]:
    for entry in joints if isinstance(joints, YamlMap) else ():
        kind = entry.value.child("type")
        if isinstance(kind, YamlScalar) and kind.text in _TURNING:
            yield entry.name


def read_srdf(
    document: XmlDocument, urdf: Imported, sink: Diagnostics, refused: Mapping[XmlElement, CannotRepresentError]
) -> Imported:
    """Read an SRDF document for a robot's spec, as a tree with the section `semantic` only.

    The tree has all of its content, in the language's words or as raw XML; what is omitted is reported.
    """
    robot, root = urdf.tree, document.root
    draft = SpecDraft(refused, renamed=urdf.renamed)
    reader = ElementReader(draft, root)
    name, robot_name = reader.required_text("name"), robot.get("name")
    if isinstance(robot_name, YamlScalar) and robot_name.text != name.text:
        draft.diagnostics.append(OTHER_ROBOT.at(name.span, name=name.text, robot=robot_name.text))
    semantic = _read_semantic(reader, SemanticNames.of(robot))
    draft.bodies[root] = semantic
    tree = draft.map_of({"semantic": semantic}, root.span)
    draft.report(sink)
    return Imported(tree, place_comments(document, draft, tree), (document,))


def _read_semantic(robot: ElementReader, names: SemanticNames) -> YamlMap:
    draft, span = robot.draft, robot.span

    def element(kind: type[VirtualJoint | EndEffector]) -> YamlMap | None:
        elements = read_named(robot, kind.TAG, lambda one: read_element(one, kind, names=names.by_kind))
        if kind is VirtualJoint:
            names.joints.update(draft.text(name, span).text for name in elements)
        return draft.named(elements, span)

    virtual_joints = element(VirtualJoint)
    groups = _read_groups(robot, names)
    return robot.map(
        virtual_joints=virtual_joints,
        groups=draft.named(groups, span),
        group_states=_read_nested(robot, "group_state", ("group", "name"), lambda state: _state(state, names)),
        end_effectors=element(EndEffector),
        passive_joints=_passive_joints(robot, names),
        disabled_collisions=_read_pairs(robot, "disable_collisions", names),
        enabled_collisions=_read_pairs(robot, "enable_collisions", names),
        no_default_collision_links=_read_references(robot, "disable_default_collisions", "link", "link", names),
        joint_properties=_read_nested(
            robot, "joint_property", ("joint_name", "property_name"), lambda one: _property(one, names)
        ),
        link_sphere_approximations=draft.named(_sphere_approximations(robot, names), span),
    )


def _read_references(
    owner: ElementReader, tag: str, attribute: str, kind: str, names: SemanticNames
) -> YamlList | None:
    """Read the children of a tag that only refer to something, as a list of names."""

    def read(reader: ElementReader) -> YamlNode:
        if kind == "group" and reader.element.get(attribute) in names.unread_groups:
            reference = reader.attribute(attribute)
            reason = f"planning group '{reference.value}' contains the group that it is in"
            raise CannotRepresentError(reason, reference.span)
        node = read_reference(reader, attribute, kind, names.by_kind)
        reader.require_used_up()
        return node

    nodes = owner.children(tag, read)
    return owner.draft.list_of(nodes, nodes[0].span) if nodes else None


# Planning groups and their states


def _read_groups(robot: ElementReader, names: SemanticNames) -> Named:
    """Read the groups after those in them, because a group that stays raw cannot be a member of another."""
    ordered = _subgroups_first(robot.remaining("group"))
    names.unread_groups.update(name for group in ordered if (name := group.get("name")))
    section: Named = {}

    def read(group: ElementReader) -> YamlMap:
        name = group.attribute("name")
        if name.value in section:
            raise CannotRepresentError(f"there is a group '{name.value}' already", name.span)
        node = _group(group, names)
        names.groups.add(group.draft.text(name.value, name).text)
        section[name.value] = name, node
        return node

    for group in ordered:
        robot.try_read(group, read)
        names.unread_groups.discard(group.get("name") or "")
    return dict(sorted(section.items(), key=lambda named: named[1][0].span))


def _subgroups_first(groups: Iterable[XmlElement]) -> list[XmlElement]:
    """Sort groups after those in them, as far as there is no cycle; groups of the same name stay in order."""
    from graphlib import CycleError, TopologicalSorter

    by_name: dict[str, list[XmlElement]] = {}
    for group in groups:
        by_name.setdefault(group.get("name") or "", []).append(group)
    members: dict[str, Iterable[str]] = {}
    for name, same_name in by_name.items():
        parts = (part.get("name") for group in same_name for part in group.children if part.tag == "group")
        members[name] = [part for part in parts if part in by_name][::-1]
    try:
        order: Iterable[str] = tuple(TopologicalSorter(members).static_order())
    except CycleError:
        from networkx import DiGraph, dfs_postorder_nodes

        order = dfs_postorder_nodes(DiGraph(members))
    return [group for name in order for group in by_name[name]]


def _group(group: ElementReader, names: SemanticNames) -> YamlMap:
    """Read a planning group whose name is taken."""
    chains = group.children("chain", lambda chain: read_element(chain, Chain, names=names.by_kind))
    first = {"chains": None, "chain" if len(chains) == 1 else "chains": group.draft.one_or_list(chains)}
    node = read_element(
        group,
        PlanningGroup,
        names=names.by_kind,
        first=first,
        links=lambda one: _read_references(one, "link", "name", "link", names),
        joints=lambda one: _read_references(one, "joint", "name", "joint", names),
        subgroups=lambda one: _read_references(one, "group", "name", "group", names),
    )
    if node.entries.keys().isdisjoint(("chain", "chains", "links", "joints", "subgroups")):
        raise group.cannot_represent("nothing in it is a member that the robot has")
    return node


def _state(state: ElementReader, names: SemanticNames) -> YamlMap:
    """Read a group state: positions by joint."""
    read_reference(state, "group", "group", names.by_kind)
    state.attribute("name")
    positions: dict[str, YamlNode | None] = {}

    def read(joint: ElementReader) -> YamlNode | None:
        name = read_reference(joint, "name", "joint", names.by_kind)
        if name.text in positions:
            raise CannotRepresentError(f"joint '{name.text}' has a value already", name.span)
        if name.text in _RESERVED:
            raise CannotRepresentError(f"'{name.text}' is a key of the language", name.span)
        node = _position(joint, Dimension.ANGLE if name.text in names.turning else None)
        joint.require_used_up()
        positions[name.text] = node
        return node

    state.children("joint", read)
    return state.map(**positions)


def _position(joint: ElementReader, unit: Dimension | None) -> YamlNode | None:
    """Read a position: one number, or a list of bare ones for several degrees of freedom."""
    joint.require_attributes(["value"])
    attribute = joint.element.attributes["value"]
    if not attribute.value.strip():
        raise CannotRepresentError("value is empty", attribute.span)
    count = len(attribute.value.split())
    return joint.number("value", unit) if count == 1 else joint.numbers("value", count)


def _passive_joints(robot: ElementReader, names: SemanticNames) -> YamlNode | None:
    """Return a list of names, or a map where one has extras."""

    def read(joint: ElementReader) -> YamlMap:
        name = joint.element.attributes["name"]
        if name.value not in names.joints:
            raise CannotRepresentError(f"there is no joint named '{name.value}'", name.span)
        return read_element(joint, PassiveJoint, names=names.by_kind)

    joints = read_named(robot, "passive_joint", read)
    if any(isinstance(node, YamlMap) and len(node) for _, node in joints.values()):
        return robot.draft.named(joints, robot.span)
    nodes: list[YamlNode] = []
    for attribute, node in joints.values():
        nodes.append(robot.draft.text(attribute.value, attribute.span))
        robot.draft.note_same_source(nodes[-1], node)
    return robot.draft.list_of(nodes, nodes[0].span) if nodes else None


# Sections with two names: pairs of links, states of groups, properties of joints


def _read_nested(
    robot: ElementReader, tag: str, keys: tuple[str, str], read: Callable[[ElementReader], YamlNode]
) -> YamlMap | None:
    """Read the children of a tag by two attributes, as a map of maps.

    Children with the same first name come together at the first of them; a pair of names that is taken stays raw.
    """
    groups: dict[str, tuple[XmlAttribute, Named]] = {}
    first_elements: dict[str, XmlElement] = {}

    def read_one(part: ElementReader) -> YamlNode:
        outer, inner = (part.element.attributes.get(key) for key in keys)
        node = read(part)
        if outer is None or inner is None:
            raise part.cannot_represent(f"it lacks '{keys[0]}' or '{keys[1]}'")
        _, group = groups.setdefault(outer.value, (outer, {}))
        if inner.value in group:
            raise CannotRepresentError(f"'{outer.value}' and '{inner.value}' are there already", inner.span)
        group[inner.value] = inner, node
        first_elements.setdefault(outer.value, part.element)
        return node

    for child in robot.remaining(tag):
        robot.try_read(child, read_one)
    section: Named = {}
    for name, (attribute, group) in groups.items():
        node = robot.draft.named(group, attribute.span)
        if node is not None:
            # Comments above the first element are about all of them.
            robot.draft.note_source(node, first_elements[name])
            section[name] = attribute, node
    return robot.draft.named(section, robot.span)


def _read_pairs(robot: ElementReader, tag: str, names: SemanticNames) -> YamlMap | None:
    return _read_nested(robot, tag, ("link1", "link2"), lambda pair: _pair(pair, names))


def _pair(pair: ElementReader, names: SemanticNames) -> YamlNode:
    """Read a pair of links: its reason, null for none, or an object where it has more."""
    for end in ("link1", "link2"):
        read_reference(pair, end, "link", names.by_kind)
    return _in_short_form(pair, read_element(pair, CollisionPair, names=names.by_kind), "reason")


def _property(one: ElementReader, names: SemanticNames) -> YamlNode:
    """Read a property of a joint: its value, or an object where it has more."""
    read_reference(one, "joint_name", "joint", names.by_kind)
    one.attribute("property_name")

    def value(one: ElementReader) -> YamlNode:
        attribute = one.attribute("value")
        return one.draft.word(attribute.value, attribute.span)

    return _in_short_form(one, read_element(one, JointProperty, names=names.by_kind, value=value), "value")


def _sphere_approximations(robot: ElementReader, names: SemanticNames) -> Named:
    def spheres(approximation: ElementReader) -> YamlNode:
        return approximation.draft.list_of(approximation.children("sphere", _sphere), approximation.span)

    def read(approximation: ElementReader) -> YamlNode:
        link = approximation.element.attributes["link"]
        if link.value not in names.links:
            raise CannotRepresentError(f"there is no link named '{link.value}'", link.span)
        node = read_element(approximation, LinkSphereApproximation, names=names.by_kind, spheres=spheres)
        return _in_short_form(approximation, node, "spheres")

    return read_named(robot, "link_sphere_approximation", read, "link")


def _sphere(sphere: ElementReader) -> YamlMap:
    """Read a sphere, whose `center` is three fields of its class; a negative radius is reported at the whole sphere."""
    sphere.require_attributes(["center", "radius"])
    center, radius = sphere.numbers("center", 3), sphere.number("radius")
    return read_element(sphere, SrdfSphere, first={"center": center, "radius": radius})


def _in_short_form(reader: ElementReader, node: YamlMap, key: str) -> YamlNode:
    """Return the value of an object that has only this key, null where it has none."""
    if node.entries.keys() - {key} or not reader.is_used_up():
        return node
    value = node.get(key) or YamlScalar("null", None, reader.span)
    if attribute := reader.element.get(key):
        return reader.draft.word(attribute, value.span)
    return value
