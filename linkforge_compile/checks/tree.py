"""Links and joints form one tree: every joint connects two links, every link but the root is the child of one joint."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.checks.names import (
    Graph,
    Reference,
    find_reference_cycles,
    report_cycles,
    report_unknown,
)
from linkforge_compile.core.constants import WORLD
from linkforge_compile.core.models.graph import child_joints, find_tree_root, walk_down
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Note, UnresolvedNames, Where
from linkforge_compile.diagnostics.codes.model import LINK_CYCLE, NO_LINKS, SECOND_PARENT, SEVERAL_ROOTS
from linkforge_compile.diagnostics.codes.names import UNKNOWN_LINK
from linkforge_compile.diagnostics.grouping import SHOWN, join_names

_USUAL_ROOT = "base_link"


def check_links(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A robot has at least one link.

    No URDF reader accepts a robot without links. Declare one under `links`, or use a module that has some.
    """
    if not robot.links and not unresolved:
        yield NO_LINKS.at(robot.source, "links", robot=robot.name)


def check_joint_ends(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A joint connects two links of this robot.

    URDF readers refuse the whole robot when one link is missing. Declare the link, or correct the name;
    a link of a module bears the module's prefix.
    """
    known = dict.fromkeys(robot.links.names)
    # Nearly all are known, and a look-up is cheaper than a reference.
    without_parent = [joint for joint in robot.joints if joint.parent not in known]
    parents = (Reference(joint.parent, f"joint '{joint.name}'", joint.source, ("parent",)) for joint in without_parent)
    yield from report_unknown(parents, UNKNOWN_LINK, known, unresolved)
    without_child = [joint for joint in robot.joints if joint.child not in known]
    if without_child:
        # A link that is a child already cannot be that of another joint, however similar its name.
        taken = {joint.child for joint in robot.joints}
        offered = [name for name in known if name not in taken]
        yield from report_unknown(map(child_reference, without_child), UNKNOWN_LINK, known, unresolved, offered=offered)


def check_second_parents(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A link is the child of one joint only.

    URDF describes trees: readers refuse a link with two parents, or keep one of them in silence. Where a
    mechanism closes a loop, cut it at one joint and describe the loop to the simulator; where a joint was
    copied, correct the child. A joint that leads back up the tree is reported as a cycle.
    """
    joints_above: dict[str, list[Joint]] = {}
    for joint in robot.joints:
        joints_above.setdefault(joint.child, []).append(joint)
    shared = [joints for child, joints in joints_above.items() if len(joints) > 1 and robot.has_link(child)]
    closing = {cycle[-1].user for cycle in find_reference_cycles(joint_graph(robot))} if shared else set()
    for joints in shared:
        first, *others = [joint for joint in joints if child_reference(joint).user not in closing] or joints[:1]
        note = child_reference(first).note(f"joint '{first.name}' attaches '{first.child}' to '{first.parent}'")
        for joint in others:
            facts = {"link": joint.child, "joint": joint.name, "parent": joint.parent, "first": first.name}
            facts |= {"other": first.parent, "way_out": _way_to_one_parent(joint, first)}
            yield child_reference(joint).report(SECOND_PARENT, notes=[note], **facts)


def _way_to_one_parent(joint: Joint, first: Joint) -> str:
    source, other = joint.source, first.source
    if source and other and source.key is not None and (source.span, source.trail) == (other.span, other.trail):
        return "'child' must contain what 'for' counts, to be unique in each round"
    return "correct the 'child' of one"


def check_link_cycles(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """No link is its own ancestor.

    Such links have no place in the world, and readers that walk the tree never end. One joint of the cycle
    has the wrong parent or child, or the two were swapped.
    """
    if find_tree_root(robot.links, robot.joints) is None:
        yield from report_cycles(joint_graph(robot), LINK_CYCLE)


def check_single_root(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """All links but one are children of joints; that one is the root.

    URDF readers refuse a robot in several pieces. Add the missing joint, or give a module the `parent` that
    it hangs on. Not checked while part of the robot could not be read, or while joints are raw XML, have no
    child or one with another parent: each of these may be the missing joint.
    """
    known = frozenset(robot.links.names)
    children = {joint.child for joint in robot.joints} & known
    roots = [link for link in robot.links if link.name not in children]
    raw = sum(text.lstrip().startswith("<joint") for text in robot.extra_elements)
    astray = len(robot.joints) - len(children) + raw
    if unresolved or len(roots) - 1 <= astray:
        return
    below = child_joints(
        joint for joint in robot.joints if robot.has_link(joint.parent) and robot.has_link(joint.child)
    )
    # A link without children lacks its joint, wherever it is written; else the base is usually written first.
    root = min(roots, key=lambda link: (link.name != WORLD, link.name not in below))
    strays = [link for link in roots if link is not root]
    # By convention, `base_link` is the root, even where most links hang on another.
    parent = next((link for link in roots if link.name == _USUAL_ROOT and root.name != WORLD), root)
    yield SEVERAL_ROOTS.at(
        _missing_joint(strays[0], root),
        notes=[
            *_base_by_omission(strays[0], root),
            *(_describe_tree(link, sum(1 for _ in walk_down([link.name], below))) for link in (root, *strays)[:SHOWN]),
        ],
        count=len(roots),
        roots=join_names([link.name for link in roots]),
        parent=parent.name,
        child=next(link.name for link in (root, *strays) if link is not parent),
    )


def _missing_joint(stray: Link, root: Link) -> Where:
    """Return where the joint is to be added: at the stray link, or at the import of the module that it came with."""
    trail = stray.source.trail if stray.source else ()
    of_root = root.source.trail if root.source else ()
    uses = [use for use in trail if use not in of_root]
    return uses[-1] if uses else stray.source


def _base_by_omission(stray: Link, root: Link) -> Iterator[Note]:
    """Yield a note on the alternative if the root came with a module that has no parent."""
    of_stray = stray.source.trail if stray.source else ()
    uses = [use for use in (root.source.trail if root.source else ()) if use not in of_stray]
    if uses:
        yield Note(f"or attach this module, which has no 'parent' and so is the base: 'parent: {stray.name}'", uses[-1])


def _describe_tree(link: Link, links_below: int) -> Note:
    what = f"'{link.name}' is the root of {links_below + 1} links" if links_below else f"'{link.name}' has no joints"
    return Note(what, link.source.span if link.source else None)


def child_reference(joint: Joint) -> Reference:
    """Return the reference of a joint to its child."""
    return Reference(joint.child, f"joint '{joint.name}'", joint.source, ("child",))


def joint_graph(robot: Robot) -> Graph:
    """Return the references of joints from each link to its children; links without a parent come first."""
    children = {joint.child for joint in robot.joints}
    graph: dict[str, list[Reference]] = {link.name: [] for link in robot.links if link.name not in children}
    graph.update((link.name, []) for link in robot.links if link.name in children)
    for joint in robot.joints:
        if joint.parent in graph:
            graph[joint.parent].append(child_reference(joint))
    return graph
