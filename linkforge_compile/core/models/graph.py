"""The robot as a graph: links are its nodes, joints its directed edges from parent to child.

A robot without faults is one tree, which a plain walk recognizes. networkx, whose import takes 0.2 s, answers for all
other graphs.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Link

if TYPE_CHECKING:
    from networkx import DiGraph, MultiDiGraph

Edge: TypeAlias = tuple[str, int]
"""The name that an edge leaves, and its place among the edges that leave it: two edges may join the same names."""


def parent_joints(joints: Iterable[Joint]) -> dict[str, Joint]:
    """Return the joint above each link that is a child, the first one where several are written."""
    above: dict[str, Joint] = {}
    for joint in joints:
        above.setdefault(joint.child, joint)
    return above


def child_joints(joints: Iterable[Joint]) -> dict[str, list[Joint]]:
    """Return the joints below each link that is a parent, in their order."""
    below: dict[str, list[Joint]] = defaultdict(list)
    for joint in joints:
        below[joint.parent].append(joint)
    return below


def walk_down(links: Iterable[str], below: Mapping[str, Sequence[Joint]]) -> Iterator[Joint]:
    """Yield the joints below some links, level by level, each that is the first to reach its child."""
    reached = list(links)
    seen = set(reached)
    for link in reached:
        for joint in below.get(link, ()):
            if joint.child not in seen:
                seen.add(joint.child)
                reached.append(joint.child)
                yield joint


class Visit(NamedTuple):
    """A link on a walk: the joint that leads to it, None where the walk starts, and how many joints are above it.

    `is_again` for a link that the walk was at before, as a cycle and a second parent lead to it.
    """

    link: str
    joint: Joint | None
    depth: int
    is_again: bool = False


def walk_depth_first(starts: Iterable[str], below: Mapping[str, Sequence[Joint]]) -> Iterator[Visit]:
    """Yield the starts that no other one led to, each with what is below it, branch after branch; each joint once."""
    seen: set[str] = set()
    for start in starts:
        waiting = [] if start in seen else [Visit(start, None, 0)]
        while waiting:
            visit = waiting.pop()
            if visit.link in seen:
                yield visit._replace(is_again=True)
                continue
            seen.add(visit.link)
            yield visit
            joints = below.get(visit.link, ())
            waiting.extend(Visit(joint.child, joint, visit.depth + 1) for joint in reversed(joints))


def walk_up(link: str, parents: Mapping[str, str]) -> Iterator[str]:
    """Yield a link, its parent, and so on to the root; each link of a cycle once."""
    seen: set[str] = set()
    while link not in seen:
        yield link
        seen.add(link)
        link = parents.get(link, link)


def find_tree_root(links: Collection[Link], joints: Collection[Joint]) -> str | None:
    """Return the root of links and joints that are one tree, None for any other graph."""
    names, children = {link.name for link in links}, {joint.child for joint in joints}
    roots = names - children
    if len(roots) != 1 or not len(children) == len(joints) == len(names) - 1:
        return None
    (root,) = roots
    reached = sum(1 for _ in walk_down(roots, child_joints(joints)))
    return root if reached == len(joints) else None


def tree_root(links: Collection[Link], joints: Collection[Joint]) -> str:
    """Return the name of the one link that is no joint's child, in a graph without cycles.

    Raises:
        RobotValidationError: NOT_FOUND for a joint without its links, NO_ROOT, MULTIPLE_ROOTS, HAS_CYCLE.

    """
    root = find_tree_root(links, joints)
    if root is None:
        root = single_root(KinematicGraph(links, joints))
        refuse_cycles(links, joints)
    return root


def single_root(graph: KinematicGraph) -> str:
    """Return the name of the one link that is no joint's child.

    Raises:
        RobotValidationError: NO_ROOT, MULTIPLE_ROOTS.

    """
    roots = graph.get_root_links()
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
    return roots[0]


def refuse_cycles(links: Collection[Link], joints: Collection[Joint]) -> None:
    """Raise NOT_FOUND for a joint without its links, HAS_CYCLE if some link is its own ancestor."""
    if find_tree_root(links, joints) is None and KinematicGraph(links, joints).has_cycle():
        raise _cyclic()


def _cyclic() -> RobotValidationError:
    return RobotValidationError(ValidationErrorCode.HAS_CYCLE, "Kinematic graph contains cycles", target="CyclicGraph")


def find_cycles(successors: Mapping[str, Sequence[str]]) -> Iterator[list[Edge]]:
    """Yield the edges of a cycle for each edge that closes one in a depth-first walk; it comes last.

    The walk starts at the names in their order; names that are only successors of others end it.
    """
    from graphlib import CycleError, TopologicalSorter

    try:
        TopologicalSorter(successors).prepare()
    except CycleError:
        yield from _cycles_of_walk(successors)


def _cycles_of_walk(successors: Mapping[str, Sequence[str]]) -> Iterator[list[Edge]]:
    import networkx

    path: list[Edge] = []
    depth: dict[str, int] = {}
    for _, node, label in networkx.dfs_labeled_edges(_with_edges_as_nodes(successors)):
        match node, label:
            case str(), "forward":
                depth[node] = len(path)
            case str(), "reverse":
                del depth[node]
            case str(), _:
                if node in depth:
                    yield path[depth[node] :]
            case edge, "forward":
                path.append(edge)
            case _:
                path.pop()


def _with_edges_as_nodes(successors: Mapping[str, Sequence[str]]) -> DiGraph[str | Edge]:
    """Draw a graph that a walk passes edge by edge, also where two join the same names."""
    import networkx

    graph: DiGraph[str | Edge] = networkx.DiGraph()
    graph.add_nodes_from(successors)
    for name, others in successors.items():
        for place, other in enumerate(others):
            graph.add_edge(name, (name, place))
            graph.add_edge((name, place), other)
    return graph


class KinematicGraph:
    """The links and joints of a robot as they are when the graph is made.

    `adj` maps a parent link to its (child link, joint) names in the order of the joints, `inv_adj` a child link
    to its (parent link, joint) names. Every answer is computed anew from them.

    Raises:
        RobotValidationError: NOT_FOUND for a joint whose parent or child is no link of the graph.

    """

    def __init__(self, links: Iterable[Link], joints: Iterable[Joint]) -> None:
        self.link_names: set[str] = {link.name for link in links}
        self.joints: list[Joint] = list(joints)
        self.adj: dict[str, list[tuple[str, str]]] = defaultdict(list)
        self.inv_adj: dict[str, list[tuple[str, str]]] = defaultdict(list)
        for joint in self.joints:
            self._require_link("Parent", joint.parent)
            self._require_link("Child", joint.child)
            self.adj[joint.parent].append((joint.child, joint.name))
            self.inv_adj[joint.child].append((joint.parent, joint.name))

    def _require_link(self, end: str, name: str) -> None:
        if name not in self.link_names:
            raise RobotValidationError.not_found(f"{end} link '{name}' unknown", f"{end}Link", name, end.lower())

    def has_cycle(self) -> bool:
        """Return whether some link is its own ancestor; two ways to one link (a diamond) are no cycle."""
        import networkx

        return not networkx.is_directed_acyclic_graph(self._drawn())

    def get_root_links(self) -> list[str]:
        """Return the sorted names of links that are no joint's child, those without joints included."""
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
        """Return the joints from the root links down, branch after branch.

        Raises:
            RobotValidationError: HAS_CYCLE.

        """
        import networkx

        self._refuse_cycles()
        by_name = {joint.name: joint for joint in self.joints}
        names = dict.fromkeys((*self.get_root_links(), *self.adj))
        graph = _with_edges_as_nodes({name: [child for child, _ in self.adj.get(name, ())] for name in names})
        edges = [node for node in networkx.dfs_preorder_nodes(graph) if isinstance(node, tuple)]
        walked = [self.adj[parent][place][1] for parent, place in edges]
        return [by_name[name] for name in walked if name in by_name]

    def _refuse_cycles(self) -> None:
        if self.has_cycle():
            raise _cyclic()

    def _drawn(self) -> MultiDiGraph[str]:
        import networkx

        graph: MultiDiGraph[str] = networkx.MultiDiGraph()
        graph.add_nodes_from(self.link_names)
        graph.add_edges_from((parent, child) for parent, ends in self.adj.items() for child, _ in ends)
        return graph
