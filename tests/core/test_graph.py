"""What the graph of links and joints says, and that no chain is too long for it."""

from itertools import pairwise

import pytest

from linkforge_compile.core import Joint, KinematicGraph, Link, Robot, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.graph import refuse_cycles


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


def test_merging_finds_the_cycles_that_networkx_finds():
    for edges in (("ab", "bc"), ("ab", "ac", "bd", "cd"), ("ab", "bc", "ca"), ("xy", "ab", "bc", "cb")):
        drawn = graph(*edges)
        if drawn.has_cycle():
            with pytest.raises(RobotValidationError, match="cycles"):
                refuse_cycles(drawn.joints)
        else:
            refuse_cycles(drawn.joints)


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
