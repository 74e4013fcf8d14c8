"""The graph of links and joints, also for long chains."""

from itertools import pairwise

import networkx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.core import Joint, KinematicGraph, Link, Robot, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.graph import find_cycles, find_tree_root


def graph(*edges: str, alone: str = "") -> KinematicGraph:
    names = dict.fromkeys("".join(edges) + alone)
    return KinematicGraph([Link(name) for name in names], [Joint(edge, "fixed", edge[0], edge[1]) for edge in edges])


def test_a_joint_to_nowhere_is_refused():
    with pytest.raises(RobotValidationError, match="Child link 'b' unknown") as refused:
        KinematicGraph([Link("a")], [Joint("ab", "fixed", "a", "b")])
    assert (refused.value.code, refused.value.target) == (ValidationErrorCode.NOT_FOUND, "ChildLink")


def test_roots_are_sorted_and_lone_links_are_among_them():
    assert graph("ca", "bd", alone="z").get_root_links() == ["b", "c", "z"]


def test_a_diamond_is_no_cycle_but_a_ring_is():
    assert not graph("ab", "ac", "bd", "cd").has_cycle()
    assert graph("ab", "bc", "ca").has_cycle()


def test_links_come_parents_first_and_otherwise_by_alphabet():
    assert graph("cb", "ca", "bd").get_topological_link_names() == ["c", "a", "b", "d"]


def test_joints_come_branch_after_branch():
    joints = graph("ab", "bc", "ad", "cd").get_topological_joints()
    assert [joint.name for joint in joints] == ["ab", "bc", "cd", "ad"]


def test_no_order_is_given_to_a_cycle():
    ring = graph("ab", "ba")
    for order in (ring.get_topological_link_names, ring.get_topological_joints):
        with pytest.raises(RobotValidationError, match="cycles") as refused:
            order()
        assert refused.value.code is ValidationErrorCode.HAS_CYCLE


def test_islands_are_found_whatever_the_direction_and_in_a_fixed_order():
    assert graph("cb", "ab", "zy", alone="m").find_islands() == [{"a", "b", "c"}, {"m"}, {"y", "z"}]


def test_answers_follow_what_is_written_into_adj():
    chain = graph("ab", "bc")
    chain.adj["c"].append(("a", "back"))
    assert chain.has_cycle()


def test_a_graph_is_drawn_anew_only_after_a_change():
    robot = Robot("r", links=[Link("a"), Link("b")])
    first = robot.graph
    assert robot.graph is first
    robot.add_joint(Joint("ab", "fixed", "a", "b"))
    second = robot.graph
    assert second is not first
    robot.links[1].name = "c"
    with pytest.raises(RobotValidationError, match="Child link 'b' unknown"):
        _ = robot.graph


@given(
    st.lists(st.tuples(st.sampled_from("abcdef"), st.sampled_from("abcdef")).filter(lambda ends: ends[0] != ends[1]))
)
def test_the_plain_walk_recognizes_a_tree_as_networkx_does(ends: list[tuple[str, str]]):
    drawn = networkx.MultiDiGraph(ends)
    drawn.add_nodes_from("abcdef")
    links, joints = [Link(name) for name in "abcdef"], [Joint(f"j{i}", "fixed", *two) for i, two in enumerate(ends)]
    root = find_tree_root(links, joints)
    assert (root is not None) == networkx.is_arborescence(drawn)
    assert root is None or drawn.in_degree(root) == 0


@pytest.mark.parametrize(
    "edges", [("ab", "bc"), ("ab", "ac", "bd", "cd"), ("ab", "bc", "ca"), ("xy", "ab", "bc", "cb")]
)
def test_merging_refuses_cycles_and_no_other_graph(edges: tuple[str, ...]):
    drawn = graph(*edges)
    component = Robot("component", links=[Link(name) for name in sorted(drawn.link_names)], joints=drawn.joints)
    whole = Robot("whole", links=[Link("base")])
    if drawn.has_cycle():
        with pytest.raises(RobotValidationError, match="cycles"):
            whole.merge(component, None, None)
    else:
        assert len(whole.merge(component, None, None).joints) == len(edges)


def test_each_edge_that_closes_a_cycle_is_found_once():
    assert [*find_cycles({"a": ["b", "b"], "b": ["a", "c", "a"], "c": ["c", "nowhere"]})] == [
        [("a", 0), ("b", 0)],
        [("c", 0)],
        [("a", 0), ("b", 2)],
    ]
    assert [*find_cycles({"a": ["b", "c"], "b": ["d"], "c": ["d"], "d": []})] == []


def test_a_ring_of_ten_thousand_is_found_without_recursion():
    (ring,) = find_cycles({f"n{number}": [f"n{(number + 1) % 10_000}"] for number in range(10_000)})
    assert ring == [(f"n{number}", 0) for number in range(10_000)]


def test_a_chain_of_ten_thousand_links_is_not_too_deep():
    links = [Link(f"l{number}") for number in range(10_000)]
    joints = [
        Joint(f"j{number}", "fixed", parent.name, child.name) for number, (parent, child) in enumerate(pairwise(links))
    ]
    snake = Robot("snake", links=links, joints=joints)
    assert not snake.has_cycle
    assert snake.root_link is links[0]
    assert snake.graph.get_topological_joints() == joints
    assert len(snake.graph.get_topological_link_names()) == 10_000
    assert len(snake.graph.find_islands()) == 1
    body = Robot("body", links=[Link("base")]).merge(snake, "base", "mount", prefix="s_")
    assert body.get_parent_link("s_l9999") == Link("s_l9998")
    assert body.clone() == body
    assert "10001 links" in body.summary()
