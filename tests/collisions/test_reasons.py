"""Robots of boxes and spheres, for which one can see which links collide."""

from pathlib import Path

import pytest

pytest.importorskip("pinocchio")

from tests.collisions.sampled import reasons_of

BALL = "{collision: {sphere: 0.1}}"


def slider(limits: str, *, link: str = "slide", mimic: str = "") -> str:
    """Return a ball that slides along x and begins at x = 1 m."""
    return (
        f"  {link}: {{type: prismatic, parent: base, child: {link}, axis: x, origin: [1, 0, 0], "
        f"limits: {{{limits}, effort: 1, velocity: 1}}{mimic}}}\n"
    )


def obstacle(x: float) -> str:
    """Return two links fixed to the base, the second of them a ball at x, which is not adjacent to the base."""
    return (
        "  post: {type: fixed, parent: base, child: post, origin: [0, 0, 5]}\n"
        f"  obstacle: {{type: fixed, parent: post, child: obstacle, origin: [{x}, 0, -5]}}\n"
    )


def robot_with_obstacle(x: float, limits: str) -> str:
    """Return a ball that slides along x, and a ball at x."""
    links = f"links: {{base: {BALL}, post: {BALL}, slide: {BALL}, obstacle: {BALL}}}\n"
    return f"{links}joints:\n{slider(limits)}{obstacle(x)}"


def test_links_that_a_joint_connects_are_adjacent(tmp_path: Path):
    spec = robot_with_obstacle(9, "lower: 0, upper: 1")
    adjacent = {pair for pair, reason in reasons_of(spec, tmp_path).items() if reason == "Adjacent"}
    assert adjacent == {("base", "post"), ("base", "slide"), ("post", "obstacle")}


def test_links_without_shapes_do_not_separate_adjacent_ones(tmp_path: Path):
    spec = f"""
links: {{base: {BALL}, mount: , flange: , hand: {BALL}, left: {BALL}, right: {BALL}}}
joints:
  one: {{type: fixed, parent: base, child: mount, origin: [0, 0, 1]}}
  two: {{type: continuous, parent: mount, child: flange, axis: z}}
  three: {{type: fixed, parent: flange, child: hand, origin: [0, 0, 1]}}
  four: {{type: fixed, parent: hand, child: left, origin: [0, 1, 1]}}
  five: {{type: fixed, parent: mount, child: right, origin: [0, 3, 0]}}
"""
    assert reasons_of(spec, tmp_path) == {
        ("base", "hand"): "Adjacent",
        ("base", "right"): "Adjacent",
        ("hand", "right"): "Adjacent",
        ("hand", "left"): "Adjacent",
        ("base", "left"): "Never",
        ("left", "right"): "Never",
    }


@pytest.mark.parametrize(
    ("x", "limits", "reason"),
    [
        (9, "lower: 0, upper: 1", "Never"),
        (1, "lower: 0, upper: 1", "Default"),
        # The balls touch from 0.2 m to 0.6 m of 1 m.
        (1.4, "lower: 0, upper: 1", "checked"),
        # In the default pose, at 0, they are 1 mm apart; they collide in 99 % of the range.
        (1.201, "lower: 0, upper: 0.1", "Always"),
        # 0 is not within the limits, and they collide in the middle.
        (2.5, "lower: 1, upper: 2", "Default"),
        (1, "lower: 1, upper: 2", "Never"),
    ],
)
def test_a_ball_that_slides_along_another_one(x: float, limits: str, reason: str, tmp_path: Path):
    assert reasons_of(robot_with_obstacle(x, limits), tmp_path)["slide", "obstacle"] == reason


@pytest.mark.parametrize(("kind", "reason"), [("continuous", "checked"), ("revolute", "Never")])
def test_a_continuous_joint_turns_all_the_way(kind: str, reason: str, tmp_path: Path):
    limits = "limits: {lower: -90 deg, upper: 90 deg, effort: 1, velocity: 1}" if kind == "revolute" else ""
    spec = f"""
links: {{base: {BALL}, arm: {{collision: {{sphere: 0.1, origin: [1, 0, 0]}}}}, post: {BALL}, obstacle: {BALL}}}
joints:
  turn: {{type: {kind}, parent: base, child: arm, axis: z, {limits}}}
{obstacle(-1)}"""
    assert reasons_of(spec, tmp_path)["arm", "obstacle"] == reason


@pytest.mark.parametrize(
    ("mimic", "reason"), [("", "checked"), (", mimic: {joint: slide}", "Never"), (", mimic: {joint: two}", "Never")]
)
def test_a_joint_that_follows_another_one_keeps_its_distance(mimic: str, reason: str, tmp_path: Path):
    spec = f"links: {{base: {BALL}, slide: {BALL}, two: {BALL}, three: {BALL}}}\njoints:\n"
    spec += slider("lower: 0, upper: 9")
    spec += slider("lower: 0, upper: 9", link="two", mimic=", mimic: {joint: slide, offset: 0.5}")
    spec += slider("lower: 1, upper: 9", link="three", mimic=mimic and f"{mimic[:-1]}, offset: 1}}")
    assert reasons_of(spec, tmp_path)["slide", "three"] == reason


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_links_on_either_side_of_a_floating_or_planar_joint_are_left_out(kind: str, tmp_path: Path):
    axis = "axis: z, " if kind == "planar" else ""
    spec = f"""
links: {{base: {BALL}, ship: {BALL}, mast: {BALL}, flag: {BALL}}}
joints:
  sail: {{type: {kind}, parent: base, child: ship, {axis}origin: [9, 0, 0]}}
  foot: {{type: fixed, parent: ship, child: mast, origin: [0, 0, 1]}}
  rope: {{type: fixed, parent: mast, child: flag, origin: [0, 0, 1]}}
"""
    assert reasons_of(spec, tmp_path) == {
        ("ship", "mast"): "Adjacent",
        ("mast", "flag"): "Adjacent",
        ("ship", "flag"): "Never",
    }


def test_any_of_several_shapes_may_collide(tmp_path: Path):
    spec = f"""
links:
  base: {BALL}
  post: {BALL}
  slide: {{collision: [{{sphere: 0.1}}, {{box: [0.1, 0.1, 0.1], origin: [0, 3, 0]}}]}}
  obstacle: {{collision: [{{cylinder: {{radius: 0.1, length: 0.1}}, origin: [0, 3, 0]}}, {{sphere: 0.1}}]}}
joints:
{slider("lower: 0, upper: 1")}{obstacle(1.5)}"""
    assert reasons_of(spec, tmp_path)["slide", "obstacle"] == "checked"
    away = spec.replace("origin: [0, 3, 0]}, {sphere: 0.1}", "origin: [0, 0, 3]}, {sphere: 0.1, origin: [0, 9, 0]}")
    assert reasons_of(away, tmp_path)["slide", "obstacle"] == "Never"


def test_pairs_of_people_stay_and_are_not_sampled(tmp_path: Path):
    spec = robot_with_obstacle(1.4, "lower: 0, upper: 1")
    spec += "semantic: {disabled_collisions: {obstacle: {slide: User}, post: {slide: }}}\n"
    assert reasons_of(spec, tmp_path)["slide", "obstacle"] == "User"


def test_pairs_of_an_earlier_run_are_sampled_again(tmp_path: Path):
    spec = robot_with_obstacle(1.4, "lower: 0, upper: 1")
    spec += "semantic: {disabled_collisions: {obstacle: {slide: Never}, post: {slide: Always}}}\n"
    reasons = reasons_of(spec, tmp_path)
    assert (reasons["slide", "obstacle"], reasons["post", "slide"]) == ("checked", "Never")
