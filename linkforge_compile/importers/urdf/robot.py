"""A URDF document as the tree of a spec: its sections, each in the order of the file."""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import partial

from linkforge_compile.bounds import Budget, Limit
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import SRDF_FOR_URDF
from linkforge_compile.importers.comments import place_comments
from linkforge_compile.importers.document import Imported, Move, read_document
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.raw_xml import Shapes
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft
from linkforge_compile.importers.urdf.frame import frames_of
from linkforge_compile.importers.urdf.gazebo import Blocks
from linkforge_compile.importers.urdf.joint import read_joint
from linkforge_compile.importers.urdf.link import read_link
from linkforge_compile.importers.urdf.material import Named, Palette
from linkforge_compile.importers.urdf.refused import refused_by_readers
from linkforge_compile.importers.urdf.ros2_control import read_ros2_control
from linkforge_compile.importers.urdf.transmission import read_transmission
from linkforge_compile.source import SourceFile
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_OF_SRDF = (
    *("group", "group_state", "end_effector", "virtual_joint", "passive_joint", "disable_collisions"),
    *("enable_collisions", "disable_default_collisions", "joint_property", "link_sphere_approximation"),
)
_VERSIONS_WITHOUT_QUATERNIONS = (None, "1.0")


def read_urdf(
    file: SourceFile, sink: Diagnostics, moved: Move | None = None, *, keeps_refused: bool = False
) -> Imported | None:
    """Read a URDF document; None where it is none, which is told.

    All that it says is in the tree, in the language's own words or as raw XML, or it is told what is left out.
    `moved` gives the elements other places than those that they have in the text. What readers of URDF refuse is an
    error and at fault in the tree; where the tree becomes a spec, `keeps_refused`, it comes in as raw XML.
    """
    document = read_document(file, sink, moved)
    if document is None:
        return None
    root = document.root
    if part := _part_of_srdf(root):
        sink.report(SRDF_FOR_URDF.at(part.span, tag=part.tag))
        return None
    _require_few_parts(root)
    draft, tree = _drafted(root)
    # What readers refuse has no form in the language, so where nothing is raw there is none of it.
    if draft.raw and not keeps_refused and (faults := tuple(refused_by_readers(root))):
        sink.report_all(fault.told for fault in faults)
        draft, tree = _drafted(root, frozenset(element for fault in faults for element in fault.path))
    draft.report(sink)
    return Imported(tree, place_comments(document, draft, tree), (document,))


def _require_few_parts(root: XmlElement) -> None:
    """Refuse a robot of too many parts before it is read, which takes long: a fixed joint may be one with its link."""
    parts = [one for one in root.children if one.tag == "link" or (one.tag == "joint" and one.get("type") != "fixed")]
    budget = Budget()
    if len(parts) > (most := budget.left(Limit.ENTRIES)):
        raise budget.beyond(Limit.ENTRIES, parts[most].span)


def _drafted(root: XmlElement, at_fault: Collection[XmlElement] = ()) -> tuple[SpecDraft, YamlMap]:
    draft = SpecDraft(has_quaternions=_has_quaternions(root), shapes=_shapes_of(root), at_fault=at_fault)
    tree = _robot(ElementReader(draft, root))
    draft.bodies[root] = tree
    return draft, tree


def _part_of_srdf(root: XmlElement) -> XmlElement | None:
    """Return what shows that a document is an SRDF, None where it may be a URDF."""
    tags = [child.tag for child in root.children]
    if "link" in tags or "joint" in tags:
        return None
    return next((child for child in root.children if child.tag in _OF_SRDF), None)


def _has_quaternions(root: XmlElement) -> bool:
    """Whether readers take the quaternions of what a robot compiles to, which states URDF 1.1 for a capsule."""
    version = root.get("version")
    return version not in _VERSIONS_WITHOUT_QUATERNIONS or (version is None and _has_capsule(root))


def _has_capsule(root: XmlElement) -> bool:
    return bool(_inside(root, ("link",), ("visual", "collision"), ("geometry",), ("capsule",)))


def _shapes_of(root: XmlElement) -> Shapes:
    links, collisions = _inside(root, ("link",)), _inside(root, ("link",), ("collision",))
    return Shapes(*(frozenset(one.get("name") or "" for one in named) for named in (links, collisions)))


def _inside(root: XmlElement, *path: tuple[str, ...]) -> list[XmlElement]:
    """Return the elements that a path of tags leads to, at each step one of several."""
    found = [root]
    for tags in path:
        found = [child for element in found for child in element.children if child.tag in tags]
    return found


def _robot(robot: ElementReader) -> YamlMap:
    draft, palette = robot.draft, Palette(robot.element)
    name, version = robot.required_text(), robot.text("version")
    robot.children("material", palette.declare)
    palette.find(draft, robot.element)
    blocks = Blocks(robot)
    links = _section(robot, "link", lambda link: read_link(link, palette, blocks))
    names = {child.get("name") or "" for child in robot.element.children if child.tag == "joint"}
    joints = _section(robot, "joint", lambda joint: read_joint(joint, names, blocks))
    frames = frames_of(draft, links, joints)
    transmissions = _section(robot, "transmission", lambda one: read_transmission(one, names))
    controls = _section(robot, "ros2_control", read_ros2_control)
    return robot.map(
        linkforge=YamlScalar("1", 1, robot.span),
        name=name,
        version=version,
        materials=draft.named(palette.materials, robot.span),
        links=draft.named(links, robot.span),
        joints=draft.named(joints, robot.span),
        frames=draft.named(frames, robot.span),
        transmissions=draft.named(transmissions, robot.span),
        ros2_control=draft.named(controls, robot.span),
        gazebo=blocks.rest(),
    )


def _section(robot: ElementReader, tag: str, read: Callable[[ElementReader], YamlNode]) -> Named:
    """Read the children of a tag by their names; a name that is taken stays raw."""
    section: Named = {}
    for child in [child for child in robot.remaining() if child.tag == tag]:
        robot.try_read(child, partial(_named, section, read))
    return section


def _named(section: Named, read: Callable[[ElementReader], YamlNode], part: ElementReader) -> YamlNode:
    name = part.attribute("name")
    if name.value in section:
        raise CannotRepresentError(f"there is a {part.element.tag} '{name.value}' already", name.span)
    node = read(part)
    section[name.value] = name, node
    return node
