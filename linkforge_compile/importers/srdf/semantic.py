"""An SRDF document as the semantic part of a spec, each of its sections in the order of the file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import OTHER_ROBOT
from linkforge_compile.importers.comments import place_comments
from linkforge_compile.importers.document import Imported
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft
from linkforge_compile.importers.srdf.group import read_end_effector, read_group, read_state, subgroups_first
from linkforge_compile.importers.srdf.known import Known
from linkforge_compile.importers.srdf.nested import read_nested, read_pair, read_property
from linkforge_compile.source import Span
from linkforge_compile.source.xml_tree import XmlAttribute, XmlDocument
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

Named = dict[str, tuple[XmlAttribute, YamlNode]]


def read_srdf(
    document: XmlDocument, robot: YamlMap, sink: Diagnostics, refused: Mapping[Span, CannotRepresentError]
) -> Imported:
    """Read an SRDF document of the robot whose spec is given, as a tree of the one section `semantic`.

    All that it says is there, in the language's own words or as raw XML, or it is told what is left out.
    """
    draft, root = SpecDraft(refused), document.root
    reading = ElementReader(draft, root)
    name, of = reading.required_text(), robot.get("name")
    if isinstance(of, YamlScalar) and of.text != name.text:
        draft.diagnostics.append(OTHER_ROBOT.at(name.span, name=name.text, robot=of.text))
    semantic = _semantic(reading, Known.of(robot))
    draft.bodies[root] = semantic
    tree = draft.map_of({"semantic": semantic}, root.span)
    draft.report(sink)
    return Imported(tree, place_comments(document, draft, tree), (document,))


def _semantic(robot: ElementReader, known: Known) -> YamlMap:
    draft, span = robot.draft, robot.span
    virtual_joints = _section(robot, "virtual_joint", lambda joint: _virtual_joint(joint, known))
    known.joints.update(draft.text(name, span).text for name in virtual_joints)
    groups = _groups(robot, known)
    return robot.map(
        virtual_joints=draft.named(virtual_joints, span),
        groups=draft.named(groups, span),
        group_states=read_nested(robot, "group_state", "group", "name", lambda state: _state(state, known)),
        end_effectors=draft.named(
            _section(robot, "end_effector", lambda effector: read_end_effector(effector, known)), span
        ),
        passive_joints=_passive_joints(robot, known),
        disabled_collisions=_pairs(robot, "disable_collisions", known),
        enabled_collisions=_pairs(robot, "enable_collisions", known),
        no_default_collision_links=_links(robot, "disable_default_collisions", known),
        joint_properties=read_nested(
            robot, "joint_property", "joint_name", "property_name", lambda remark: read_property(remark, known)
        ),
        link_sphere_approximations=draft.named(_sphere_approximations(robot, known), span),
    )


def _section(robot: ElementReader, tag: str, read: Callable[[ElementReader], YamlNode], key: str = "name") -> Named:
    """Read the children of a tag by their names; a name that is taken stays raw."""
    section: Named = {}
    for child in [child for child in robot.remaining() if child.tag == tag]:
        robot.try_read(child, partial(_named, section, read, key))
    return section


def _groups(robot: ElementReader, known: Known) -> Named:
    """Read the groups, each after those in it: one that goes takes along those that have nothing else."""
    elements = subgroups_first(child for child in robot.remaining() if child.tag == "group")
    known.unread.update(name for element in elements if (name := element.get("name")))
    section: Named = {}

    def read(group: ElementReader) -> YamlMap:
        name = group.element.attributes["name"]
        node = read_group(group, known)
        known.groups.add(group.draft.text(name.value, name.span).text)
        return node

    for element in elements:
        robot.try_read(element, partial(_named, section, read, "name"))
        known.unread.discard(element.get("name") or "")
    return dict(sorted(section.items(), key=lambda named: named[1][0].span))


def _named(section: Named, read: Callable[[ElementReader], YamlNode], key: str, part: ElementReader) -> YamlNode:
    name = part.attribute(key)
    if name.value in section:
        raise CannotRepresentError(f"there is a {part.element.tag} '{name.value}' already", name.span)
    node = read(part)
    section[name.value] = name, node
    return node


def _virtual_joint(joint: ElementReader, known: Known) -> YamlMap:
    return joint.map(
        type=joint.required_text("type"),
        parent_frame=joint.required_text("parent_frame"),
        child_link=known.link(joint, "child_link"),
    )


def _state(state: ElementReader, known: Known) -> YamlMap:
    known.group(state, "group")
    state.attribute("name")
    return read_state(state, known)


def _pairs(robot: ElementReader, tag: str, known: Known) -> YamlMap | None:
    return read_nested(robot, tag, "link1", "link2", lambda pair: read_pair(pair, known))


def _links(robot: ElementReader, tag: str, known: Known) -> YamlNode | None:
    def read(part: ElementReader) -> YamlNode:
        link = known.link(part, "link")
        part.require_used_up()
        return link

    links = robot.children(tag, read)
    return robot.draft.list_of(links, links[0].span) if links else None


def _passive_joints(robot: ElementReader, known: Known) -> YamlNode | None:
    """Return a list of names, or a map where one of them has more to say."""

    def read(joint: ElementReader) -> YamlMap:
        name = joint.element.attributes["name"]
        if name.value not in known.joints:
            raise CannotRepresentError(f"there is no joint named '{name.value}'", name.span)
        return joint.map()

    joints = _section(robot, "passive_joint", read)
    if any(isinstance(node, YamlMap) and len(node) for _, node in joints.values()):
        return robot.draft.named(joints, robot.span)
    names: list[YamlNode] = []
    for attribute, node in joints.values():
        names.append(robot.draft.text(attribute.value, attribute.span))
        robot.draft.note_same_source(names[-1], node)
    return robot.draft.list_of(names, names[0].span) if names else None


def _sphere_approximations(robot: ElementReader, known: Known) -> Named:
    def read(approximation: ElementReader) -> YamlNode:
        link = approximation.element.attributes["link"]
        if link.value not in known.links:
            raise CannotRepresentError(f"there is no link named '{link.value}'", link.span)
        spheres = approximation.children("sphere", _sphere)
        listed = approximation.draft.list_of(spheres, approximation.span)
        return listed if approximation.is_used_up() else approximation.map(spheres=listed)

    return _section(robot, "link_sphere_approximation", read, "link")


def _sphere(sphere: ElementReader) -> YamlMap:
    center = sphere.numbers("center", 3)
    if center is None:
        raise sphere.cannot_represent("it has no 'center'")
    return sphere.map(center=center, radius=sphere.required_number("radius"))
