"""Frames: the empty links at the end of a robot, with the fixed joints to them."""

from __future__ import annotations

from linkforge_compile.importers.draft import Draft
from linkforge_compile.importers.urdf.material import Named
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar

_MAY_SAY = {"type", "parent", "child", "origin"}


def frames_of(draft: Draft, links: Named, joints: Named) -> Named:
    """Take the frames from the ends of links and joints, where they stand in the same order.

    Frames come out behind all other links and joints, so an empty link among those stays a link.
    """
    frames: Named = {}
    while links and joints:
        link, (link_name, link_node) = next(reversed(links.items()))
        joint, (joint_name, joint_node) = next(reversed(joints.items()))
        frame = _frame(draft, link, link_node, joint_node)
        if frame is None:
            break
        del links[link], joints[joint]
        if joint != f"{link}_joint":
            named = draft.text(joint, joint_name.span)
            frame = draft.map_of({**{one.name: one.value for one in frame}, "joint": named}, frame.span)
        draft.stands_for(frame, link_node, joint_node)
        frames[link] = link_name, frame
    return dict(reversed(frames.items()))


def _frame(draft: Draft, link: str, link_node: YamlNode, joint_node: YamlNode) -> YamlMap | None:
    if not isinstance(link_node, YamlMap) or not isinstance(joint_node, YamlMap) or len(link_node):
        return None
    said = {entry.name: entry.value for entry in joint_node}
    kind, child = said.get("type"), said.get("child")
    if not isinstance(kind, YamlScalar) or not isinstance(child, YamlScalar) or not _MAY_SAY.issuperset(said):
        return None
    if kind.text != "fixed" or child.text != draft.text(link, child.span).text:
        return None
    return draft.map_of({"parent": said.get("parent"), "origin": said.get("origin")}, joint_node.span)
