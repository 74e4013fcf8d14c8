"""The robot as a graph: links are its nodes, joints its directed edges from parent to child."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode

if TYPE_CHECKING:
    from networkx import MultiDiGraph

    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.link import Link


def refuse_loose_joints(link_names: Collection[str], joints: Iterable[Joint]) -> None:
    """Raise NOT_FOUND for the first joint whose parent or child is none of the links."""
    for joint in joints:
        if joint.parent not in link_names:
            raise _loose("Parent", joint.parent)
        if joint.child not in link_names:
            raise _loose("Child", joint.child)


def _loose(end: str, link: str) -> RobotValidationError:
    return RobotValidationError(
        ValidationErrorCode.NOT_FOUND,
        f"{end} link '{link}' unknown",
        target=f"{end}Link",
        value=link,
        field=(end.lower(),),
    )


def tree_root(links: Sequence[Link], joints: Sequence[Joint]) -> str:
    """Return the name of the one link that is no joint's child, in a graph without cycles.

    Raises:
        RobotValidationError: NOT_FOUND for a joint without its links, NO_ROOT, MULTIPLE_ROOTS, HAS_CYCLE.

    """
    root = _root_written_first(links, joints)
    if root is None:
        root = single_root(links, joints).name
        refuse_cycles(joints)
    return root


def refuse_no_graph(links: Sequence[Link], joints: Sequence[Joint]) -> None:
    """Raise NOT_FOUND for a joint without its links, HAS_CYCLE if some link is its own ancestor."""
    if _root_written_first(links, joints) is None:
        refuse_loose_joints({link.name for link in links}, joints)
        refuse_cycles(joints)


def _root_written_first(links: Sequence[Link], joints: Sequence[Joint]) -> str | None:
    """Return the root of a tree whose joints come parents first, as people write them; None for any other graph.

    Merging asks this of every component: one look at each joint tells all of what else takes four.
    """
    if not links:
        return None
    root = joints[0].parent if joints else links[0].name
    reached = {root}
    for joint in joints:
        if joint.parent not in reached or joint.child in reached:
            return None
        reached.add(joint.child)
    return root if reached == {link.name for link in links} else None


def single_root(links: Iterable[Link], joints: Collection[Joint]) -> Link:
    """Return the one link that is no joint's child.

    Raises:
        RobotValidationError: NOT_FOUND for a joint without its links, NO_ROOT, MULTIPLE_ROOTS.

    """
    by_name = {link.name: link for link in links}
    refuse_loose_joints(by_name, joints)
    roots = sorted(by_name.keys() - {joint.child for joint in joints})
    if not roots:
        raise RobotValidationError(
            ValidationErrorCode.NO_ROOT, "No root link found in the kinematic tree", target="Roots", value=0
        )
    if len(roots) > 1:
        raise RobotValidationError(
            ValidationErrorCode.MULTIPLE_ROOTS,
            f"Multiple root links found ({len(roots)}): {roots}",
            target="Roots",
            value=len(roots),
        )
    return by_name[roots[0]]


def refuse_cycles(joints: Collection[Joint]) -> None:
    """Raise HAS_CYCLE if some link is its own ancestor.

    Merging asks this of some components, so it does without networkx, whose import costs more than the merge.
    """
    children: dict[str, list[str]] = defaultdict(list)
    ways_in: dict[str, int] = defaultdict(int)
    for joint in joints:
        children[joint.parent].append(joint.child)
        ways_in[joint.child] += 1
    reached = [link for link in children if link not in ways_in]
    while reached:
        for child in children.get(reached.pop(), ()):
            ways_in[child] -= 1
            if not ways_in[child]:
                reached.append(child)
    if any(ways_in.values()):
        raise _cyclic()


def _cyclic() -> RobotValidationError:
    return RobotValidationError(ValidationErrorCode.HAS_CYCLE, "Kinematic graph contains cycles", target="CyclicGraph")


class KinematicGraph:
    """How links and joints hang together, at the moment when the graph was drawn.

    `adj` maps a parent link to its (child link, joint) names in the order of the joints, `inv_adj` a child link
    to its (parent link, joint) names. Every answer is worked out anew from them.

    Raises:
        RobotValidationError: NOT_FOUND for a joint whose parent or child is no link of the graph.

    """

    def __init__(self, links: Iterable[Link], joints: Iterable[Joint]) -> None:
        self.link_names: set[str] = {link.name for link in links}
        self.joints: list[Joint] = list(joints)
        refuse_loose_joints(self.link_names, self.joints)
        self.adj: dict[str, list[tuple[str, str]]] = defaultdict(list)
        self.inv_adj: dict[str, list[tuple[str, str]]] = defaultdict(list)
        for joint in self.joints:
            self.adj[joint.parent].append((joint.child, joint.name))
            self.inv_adj[joint.child].append((joint.parent, joint.name))

    def has_cycle(self) -> bool:
        """Tell whether some link is its own ancestor; two ways to one link (a diamond) are no cycle."""
        import networkx

        return not networkx.is_directed_acyclic_graph(self._drawn())

    def get_root_links(self) -> list[str]:
        """Return the names of the links that are nobody's child, sorted; a link without joints is one of them."""
        return sorted(name for name in self.link_names if not self.inv_adj.get(name))

    def find_islands(self) -> list[set[str]]:
        """Return the sets of links that joints connect, whatever their direction, by their first link's name."""
        import networkx

        return sorted(networkx.weakly_connected_components(self._drawn()), key=min)

    def get_topological_link_names(self) -> list[str]:
        """Return all link names, parents before children, otherwise in alphabetical order.

        Raises:
            RobotValidationError: HAS_CYCLE.

        """
        import networkx

        self._refuse_cycles()
        return list(networkx.lexicographical_topological_sort(self._drawn()))

    def get_topological_joints(self) -> list[Joint]:
        """Return the joints in the order in which one walks down from the root links, branch after branch.

        Raises:
            RobotValidationError: HAS_CYCLE.

        """
        self._refuse_cycles()
        by_name = {joint.name: joint for joint in self.joints}
        return [by_name[name] for name in self._walked_joints() if name in by_name]

    def _walked_joints(self) -> Iterator[str]:
        """Yield each joint's name when it is passed; a link that two joints lead to is entered once."""
        entered: set[str] = set()
        for root in self.get_root_links():
            entered.add(root)
            # Our own stack: a snake robot of 10,000 links is deeper than Python's.
            branches = [iter(self.adj.get(root, ()))]
            while branches:
                child, joint = next(branches[-1], (None, None))
                if child is None or joint is None:
                    branches.pop()
                    continue
                yield joint
                if child not in entered:
                    entered.add(child)
                    branches.append(iter(self.adj.get(child, ())))

    def _refuse_cycles(self) -> None:
        if self.has_cycle():
            raise _cyclic()

    def _drawn(self) -> MultiDiGraph[str]:
        import networkx

        graph: MultiDiGraph[str] = networkx.MultiDiGraph()
        graph.add_nodes_from(self.link_names)
        graph.add_edges_from((parent, child) for parent, ends in self.adj.items() for child, _ in ends)
        return graph
