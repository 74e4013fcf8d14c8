"""Modules that declare pairs are not sampled inside; pairs of different modules are."""

from pathlib import Path

import pytest

pytest.importorskip("pinocchio")

from tests.collisions.sampled import HEAD, reasons_of

FINGER = """
links:
  near: {collision: {sphere: 0.1}}
  far: {collision: {sphere: 0.1}}
  tip: {collision: {sphere: 0.1}}
joints:
  knuckle: {type: continuous, parent: near, child: far, axis: z, origin: [1, 0, 0]}
  nail: {type: fixed, parent: far, child: tip, origin: [1, 0, 0]}
"""

KNOWN = "semantic: {disabled_collisions: {near: {far: Adjacent}, far: {tip: User}}}\n"

HAND = """
links:
  palm: {collision: {sphere: 0.1}}
modules:
  $(side)_finger:
    for: {side: [left, left_2]}
    use: finger.robot.yaml
    parent: palm
    origin: {xyz: [0, $(0 if side == 'left' else 0.15), 3]}
"""


def hand(folder: Path, *, finger: str = FINGER, spec: str = HAND, options: tuple[str, ...] = ()) -> dict[str, str]:
    """Return the reasons by pairs in one text, `left_finger_near left_finger_far`."""
    (folder / "finger.robot.yaml").write_text(HEAD.replace("robot\n", "finger\n") + finger, "utf-8")
    return {f"{one} {other}": reason for (one, other), reason in reasons_of(spec, folder, *options).items()}


INSIDE = {
    "left_finger_near left_finger_far": "Adjacent",
    "left_finger_near left_finger_tip": "checked",
    "left_finger_far left_finger_tip": "Adjacent",
}

ACROSS = {
    "palm left_finger_near": "Adjacent",
    "palm left_2_finger_near": "Adjacent",
    "palm left_finger_far": "Never",
    "palm left_finger_tip": "Never",
    "palm left_2_finger_far": "Never",
    "palm left_2_finger_tip": "Never",
    # They are 0.15 m apart, which is less than their diameters.
    "left_finger_near left_2_finger_near": "Default",
    "left_finger_far left_2_finger_far": "Default",
    "left_finger_tip left_2_finger_tip": "Default",
    "left_finger_near left_2_finger_far": "Never",
    "left_finger_near left_2_finger_tip": "checked",
    "left_finger_far left_2_finger_near": "Never",
}


def test_a_module_without_pairs_is_sampled_inside(tmp_path: Path):
    reasons = hand(tmp_path)
    assert INSIDE.items() <= reasons.items()
    assert ACROSS.items() <= reasons.items()


def test_a_module_with_pairs_is_not_sampled_inside(tmp_path: Path):
    reasons = hand(tmp_path, finger=FINGER + KNOWN)
    assert ACROSS.items() <= reasons.items()
    assert len(reasons) == 7 * 6 // 2 - 2 * 3


def test_all_samples_what_modules_leave_to_be_checked(tmp_path: Path):
    reasons = hand(tmp_path, finger=FINGER + KNOWN, options=("--all",))
    assert ACROSS.items() <= reasons.items()
    inside = {pair for pair in reasons if all(name.startswith("left_finger_") for name in pair.split())}
    assert inside == {"left_finger_near left_finger_tip"}


def test_pairs_of_the_robot_inside_a_known_module_stay(tmp_path: Path):
    spec = HAND + "semantic: {disabled_collisions: {left_finger_near: {left_finger_tip: Default}}}\n"
    assert hand(tmp_path, finger=FINGER + KNOWN, spec=spec)["left_finger_near left_finger_tip"] == "Default"


def test_modules_of_a_known_module_are_known(tmp_path: Path):
    known_hand = f"{HEAD}{HAND}semantic: {{disabled_collisions: {{palm: {{left_finger_near: Adjacent}}}}}}\n"
    (tmp_path / "hand.robot.yaml").write_text(known_hand, "utf-8")
    spec = """
links: {wall: {collision: {box: [0.1, 9, 9], origin: [-1, 0, 0]}}}
modules:
  my: {use: hand.robot.yaml, parent: wall}
"""
    reasons = hand(tmp_path, spec=spec)
    assert {pair.split()[0] for pair in reasons} == {"wall"}
    assert len(reasons) == 7


def test_a_vendors_srdf_is_known(tmp_path: Path):
    (tmp_path / "a.urdf").write_text(
        '<robot name="a"><link name="one"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>'
        '<link name="two"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>'
        '<joint name="j" type="fixed"><parent link="one"/><child link="two"/><origin xyz="0 0 1"/></joint></robot>',
        "utf-8",
    )
    (tmp_path / "a.srdf").write_text(
        '<robot name="a"><disable_collisions link1="two" link2="one" reason="Adjacent"/></robot>', "utf-8"
    )
    spec = """
links: {wall: {collision: {sphere: 0.1}}}
modules: {left: {use: a.urdf, srdf: a.srdf, parent: wall, origin: [0, 0, 1]}}
"""
    assert hand(tmp_path, spec=spec) == {"wall left_one": "Adjacent", "wall left_two": "Never"}
    without = spec.replace("srdf: a.srdf, ", "")
    assert hand(tmp_path, spec=without)["left_one left_two"] == "Adjacent"
