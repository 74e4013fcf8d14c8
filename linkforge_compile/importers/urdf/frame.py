"""Frames: the empty links at the end of a robot, with the fixed joints to them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection

from linkforge_compile.importers.spec_draft import SpecDraft, values_in
from linkforge_compile.importers.urdf.material import Named
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_MAY_SAY = {"type", "parent", "child", "origin"}
_NAME = re.compile(r"[\w./-]+")
"""What every reader takes for a name; what is wrong with another is told of the link that has it."""


def frames_of(draft: SpecDraft, links: Named, joints: Named) -> Named:
    """Take the frames from the ends of links and joints, where they stand in the same order.

    Frames come out behind all other links and joints, so an empty link among those stays a link. So do a link and a
    joint that have a fault, which is told in their own words.
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
            named = draft.text(joint, joint_name.span)
            frame = draft.map_of({**{one.name: one.value for one in frame}, "joint": named}, frame.span)
        draft.note_same_source(frame, link_node, joint_node)
        frames[link] = link_name, frame
    return dict(reversed(frames.items()))


def _shared_children(joints: Named) -> frozenset[str]:
    """Return the links that more than one joint hangs."""
    bodies = (joint for _, joint in joints.values() if isinstance(joint, YamlMap))
    children = Counter(child.text for joint in bodies if isinstance(child := joint.get("child"), YamlScalar))
    return frozenset(child for child, count in children.items() if count > 1)


def _frame(
    draft: SpecDraft, link: str, link_node: YamlNode, joint_node: YamlNode, shared: Collection[str]
) -> YamlMap | None:
    if not isinstance(link_node, YamlMap) or not isinstance(joint_node, YamlMap) or len(link_node):
        return None
    if not _NAME.fullmatch(link):
        return None
    said = {entry.name: entry.value for entry in joint_node}
    kind, child = said.get("type"), said.get("child")
    if not isinstance(kind, YamlScalar) or not isinstance(child, YamlScalar) or not _MAY_SAY.issuperset(said):
        return None
    if kind.text != "fixed" or child.text != draft.text(link, child).text:
        return None
    parent = said.get("parent")
    if child.text in shared or (isinstance(parent, YamlScalar) and parent.text == child.text):
        return None
    return draft.map_of({"parent": parent, "origin": said.get("origin")}, joint_node.span)
