"""Read a URDF document as the tree of a spec."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping
from types import MappingProxyType

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import MATERIAL_REPEATED, SRDF_FOR_URDF
from linkforge_compile.importers.document import Imported, Move, place_comments, read_document
from linkforge_compile.importers.element_reader import ElementReader, Named, read_named
from linkforge_compile.importers.link import Palette, read_joint, read_link
from linkforge_compile.importers.package_paths import NO_PACKAGE_PATHS, PackagePaths
from linkforge_compile.importers.plugin_data import Blocks
from linkforge_compile.importers.raw_xml import Shapes
from linkforge_compile.importers.refused import find_refusals
from linkforge_compile.importers.renaming import Renamed, rename_parts
from linkforge_compile.importers.ros2_control import find_commanded_again, read_ros2_control, read_transmission
from linkforge_compile.importers.spec_draft import CannotRepresentError, SpecDraft, values_in
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import SourceFile
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_SRDF_TAGS = (
    *("group", "group_state", "end_effector", "virtual_joint", "passive_joint", "disable_collisions"),
    *("enable_collisions", "disable_default_collisions", "joint_property", "link_sphere_approximation"),
)
_VERSIONS_WITHOUT_QUATERNIONS = (None, "1.0")

_FRAME_JOINT_KEYS = {"type", "parent", "child", "origin"}
_FRAME_NAME = re.compile(r"[\w./-]+")
"""Names that every reader accepts; faults of others are reported at the link."""


def read_urdf(
    file: SourceFile,
    sink: Diagnostics,
    moved: Move | None = None,
    *,
    keeps_refused: bool = False,
    package_paths: PackagePaths = NO_PACKAGE_PATHS,
    outside: Collection[str] | None = None,
) -> Imported | None:
    """Read a URDF document; None where it is none, which is reported.

    The tree has all of its content, in the language's words or as raw XML; what is omitted is reported. `moved` gives
    elements the places in which they were written. What URDF readers refuse is reported as an error and at fault in
    the tree, unless `keeps_refused`: then it becomes raw XML, for a tree that is written as a spec. `package_paths` are
    written as expressions. `outside` is given for a document that is merged with others, the names of links and joints
    that it may name: in such a one, links and joints are no frames, and nothing is shortened to a word that stands for
    something else.
    """
    document = read_document(file, sink, moved)
    if document is None:
        return None
    root = document.root
    if part := _find_srdf_part(root):
        sink.report(SRDF_FOR_URDF.at(part.span, tag=part.tag))
        return None
    _require_few_parts(root)
    document, renamed = rename_parts(document, sink)
    root = document.root
    refused = find_commanded_again(root) if keeps_refused else {}
    draft, tree = _draft(root, renamed, package_paths, refused=refused, outside=outside)
    # What readers refuse has no form in the language, so there is none of it unless something is raw or left out.
    has_repeats = any(one.code is MATERIAL_REPEATED for one in draft.diagnostics)
    if (draft.raw or has_repeats) and not keeps_refused and (refusals := tuple(find_refusals(root))):
        sink.report_all(refusal.diagnostic for refusal in refusals)
        at_fault = frozenset(element for refusal in refusals for element in refusal.path)
        draft, tree = _draft(root, renamed, package_paths, at_fault=at_fault)
    draft.report(sink)
    return Imported(tree, place_comments(document, draft, tree), (document,), renamed)


def _require_few_parts(root: XmlElement) -> None:
    """Refuse a robot with too many parts before reading it; a fixed joint may become one frame with its link."""
    parts = [one for one in root.children if one.tag == "link" or (one.tag == "joint" and one.get("type") != "fixed")]
    budget = Budget()
    if len(parts) > (most := budget.left(Limit.ENTRIES)):
        raise budget.beyond(Limit.ENTRIES, parts[most].span)


def _draft(
    root: XmlElement,
    renamed: Renamed,
    package_paths: PackagePaths,
    *,
    refused: Mapping[XmlElement, CannotRepresentError] = MappingProxyType({}),
    at_fault: Collection[XmlElement] = (),
    outside: Collection[str] | None = None,
) -> tuple[SpecDraft, YamlMap]:
    draft = SpecDraft(
        refused,
        has_quaternions=_has_quaternions(root),
        shapes=_shape_names(root),
        at_fault=at_fault,
        is_urdf=True,
        renamed=renamed,
        package_paths=package_paths,
        outside=outside,
    )
    tree = _read_robot(ElementReader(draft, root))
    draft.bodies[root] = tree
    return draft, tree


def _find_srdf_part(root: XmlElement) -> XmlElement | None:
    """Return an element that shows that a document is an SRDF, None if it may be a URDF."""
    tags = [child.tag for child in root.children]
    if "link" in tags or "joint" in tags:
        return None
    return next((child for child in root.children if child.tag in _SRDF_TAGS), None)


def _has_quaternions(root: XmlElement) -> bool:
    """Whether readers of the compiled robot accept quaternions: a capsule without a version makes it URDF 1.1."""
    version = root.get("version")
    has_capsule = bool(_find(root, ("link",), ("visual", "collision"), ("geometry",), ("capsule",)))
    return version not in _VERSIONS_WITHOUT_QUATERNIONS or (version is None and has_capsule)


def _shape_names(root: XmlElement) -> Shapes:
    links, collisions = _find(root, ("link",)), _find(root, ("link",), ("collision",))
    return Shapes(*(frozenset(one.get("name") or "" for one in elements) for elements in (links, collisions)))


def _find(root: XmlElement, *path: tuple[str, ...]) -> list[XmlElement]:
    """Return the elements at a path, each step of which is one of several tags."""
    found = [root]
    for tags in path:
        found = [child for element in found for child in element.children if child.tag in tags]
    return found


def _read_robot(robot: ElementReader) -> YamlMap:
    draft, palette = robot.draft, Palette(robot.element)
    name, version = robot.required_text("name"), robot.text("version")
    robot.children("material", palette.read_declared)
    palette.find_in_visuals(draft, robot.element)
    blocks = Blocks(robot)
    links = read_named(robot, "link", lambda link: read_link(link, palette, blocks))
    joint_names = (child.get("name") or "" for child in robot.element.children if child.tag == "joint")
    names = {"joint": {draft.text(joint, robot.element).text for joint in joint_names}.union(draft.outside)}
    joints = read_named(robot, "joint", lambda joint: read_joint(joint, names, blocks))
    frames = {} if draft.is_template else _take_frames(draft, links, joints)
    transmissions = read_named(robot, "transmission", lambda one: read_transmission(one, names))
    controls = read_named(robot, "ros2_control", read_ros2_control)
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
        gazebo=blocks.take_rest(),
    )


def _take_frames(draft: SpecDraft, links: Named, joints: Named) -> Named:
    """Remove the frames from the ends of links and joints, and return them.

    A frame is an empty link on a fixed joint. Frames are written after all other links and joints, so an empty link
    among those stays a link, as does one with a fault, which is reported at the link or joint.
    """
    frames: Named = {}
    shared = _shared_children(joints)
    while links and joints:
        link, (link_name, link_node) = next(reversed(links.items()))
        joint, (joint_name, joint_node) = next(reversed(joints.items()))
        frame = _frame(draft, link, link_node, joint_node, shared)
        if frame is None:
            break
        del links[link], joints[joint]
        draft.size -= values_in(joint_node)  # the frame counts in its place
        if joint != f"{link}_joint":
            joint_text = draft.text(joint, joint_name.span)
            frame = draft.map_of({**{one.name: one.value for one in frame}, "joint": joint_text}, frame.span)
        draft.note_same_source(frame, link_node, joint_node)
        frames[link] = link_name, frame
    return dict(reversed(frames.items()))


def _shared_children(joints: Named) -> frozenset[str]:
    """Return the links that are the child of more than one joint."""
    nodes = (joint for _, joint in joints.values() if isinstance(joint, YamlMap))
    children = Counter(child.text for joint in nodes if isinstance(child := joint.get("child"), YamlScalar))
    return frozenset(child for child, count in children.items() if count > 1)


def _frame(
    draft: SpecDraft, link: str, link_node: YamlNode, joint_node: YamlNode, shared: Collection[str]
) -> YamlMap | None:
    if not isinstance(link_node, YamlMap) or not isinstance(joint_node, YamlMap) or len(link_node):
        return None
    if not _FRAME_NAME.fullmatch(link):
        return None
    entries = {entry.name: entry.value for entry in joint_node}
    kind, child = entries.get("type"), entries.get("child")
    if (
        not isinstance(kind, YamlScalar)
        or not isinstance(child, YamlScalar)
        or not _FRAME_JOINT_KEYS.issuperset(entries)
    ):
        return None
    if kind.text != "fixed" or child.text != draft.text(link, child).text:
        return None
    parent = entries.get("parent")
    if child.text in shared or (isinstance(parent, YamlScalar) and parent.text == child.text):
        return None
    return draft.map_of({"parent": parent, "origin": entries.get("origin")}, joint_node.span)
