"""Fixes that write a list as a map by names, and keys of other formats as ours."""

from pathlib import Path

import pytest

from tests.schema.test_nesting import fixed


@pytest.mark.parametrize(
    ("text", "makes"),
    [
        ("links: [base, arm]\n", "links: {base: , arm: }\n"),
        ("links:\n  - base   # first\n  - arm\n", "links:\n  base:   # first\n  arm:\n"),
        (
            "links:\n- name: base\n  visual:\n    sphere: 1\n- name: arm\n",
            "links:\n  base:\n    visual:\n      sphere: 1\n  arm:\n",
        ),
        (
            "links:\n  - {name: base, visual: {sphere: 1}}\n  - arm: {}\n",
            "links:\n  base: {visual: {sphere: 1}}\n  arm: {}\n",
        ),
        (
            "links:\n  - base:\n      visual: {sphere: 1}\n",
            "links:\n  base:\n    visual: {sphere: 1}\n",
        ),
        (
            "links:\n  - base:\n      visual:\n# of steel\n        sphere: 1\n",
            "links:\n  base:\n    visual:\n# of steel\n      sphere: 1\n",
        ),
        ("links:\r\n- name: base\r\n", "links:\r\n  base:\r\n"),
        ("joints:\n  turn:\n  type: fixed\n\n  parent: a\n", "joints:\n  turn:\n    type: fixed\n\n    parent: a\n"),
        ("joints: {turn: , type: fixed, parent: a}\n", "joints: {turn: {type: fixed, parent: a}}\n"),
        (
            "semantic:\n  disabled_collisions:\n  - {link1: a, link2: b, reason: Never}\n"
            "  - {link1: a, link2: c}\n  - {link1: b, link2: c}\n",
            "semantic:\n  disabled_collisions:\n    a: {b: Never, c: User}\n    b: {c: User}\n",
        ),
        (
            "semantic:\n"
            "  group_states: [{name: home, group: arm, joint: [{name: x, value: 0}, {name: y, value: 1}]}]\n",
            "semantic:\n  group_states: {arm: {home: {x: 0, y: 1}}}\n",
        ),
    ],
)
def test_a_list_becomes_a_map(tmp_path: Path, text: str, makes: str):
    assert fixed(tmp_path, text, "LF2201") == [makes]


@pytest.mark.parametrize(
    "text",
    [
        "links: [base, base]\n",
        "links:\n  - visual: {sphere: 1}\n    name: base\n",
        "links:\n  - base\n  - 3\n",
        "frames: [tool]\n",  # a frame needs a parent
        "semantic:\n  disabled_collisions: [{link1: a, link2: b}, {link1: a, link2: b}]\n",
        "semantic:\n  disabled_collisions: [{link1: a}]\n",
    ],
)
def test_a_list_whose_map_is_not_certain_stays(tmp_path: Path, text: str):
    assert fixed(tmp_path, text, "LF2201") == []


@pytest.mark.parametrize(
    ("text", "makes"),
    [
        ("links: {base: {if: $(a)}}\n", "links: {base: {when: $(a)}}\n"),
        ("links: {base: {unless: $(a or b)}}\n", "links: {base: {when: $(not (a or b))}}\n"),
        ("args: {sim: false}\n", "parameters: {sim: false}\n"),
        ("links: {base: {visual: {geometry: {sphere: 1}}}}\n", "links: {base: {visual: {sphere: 1}}}\n"),
        (
            "sensors:\n  eye:\n    camera:\n      image: {width: 640, height: 480}\n",
            "sensors:\n  eye:\n    camera:\n      width: 640\n      height: 480\n",
        ),
        ("joints: {a: {pose: 0 0 1 0 0 1.57}}\n", "joints: {a: {origin: {xyz: [0, 0, 1], rpy: [0, 0, 1.57]}}}\n"),
        ("joints: {a: {origin: {z: 1, x: 2}}}\n", "joints: {a: {origin: {xyz: [2, 0, 1]}}}\n"),
        (
            "materials: {red: {color: {r: 1, g: 0.5, b: 0, a: 1}}}\n",
            "materials: {red: {color: [1, 0.5, 0, 1]}}\n",
        ),
        (
            "ros2_control: {arm: {hardware: {plugin: a/B}}}\n",
            "ros2_control: {arm: {hardware_plugin: a/B}}\n",
        ),
        (
            "semantic:\n  disable_collisions:\n    - {link1: a, link2: b}\n    - {link1: b, link2: c, reason: Never}\n",
            "semantic:\n  disabled_collisions:\n    a: {b: User}\n    b: {c: Never}\n",
        ),
        ("semantic: {passive_joint: [{name: a}, {name: b}]}\n", "semantic: {passive_joints: [a, b]}\n"),
        ("links: {base: {inertial: {mass: 1,5 kg}}}\n", "links: {base: {inertial: {mass: 1.5 kg}}}\n"),
    ],
)
def test_a_key_of_another_format_becomes_ours(tmp_path: Path, text: str, makes: str):
    assert fixed(tmp_path, text) == [makes]


def test_a_comma_that_may_separate_thousands_has_both_readings(tmp_path: Path):
    makes = [f"links: {{base: {{inertial: {{mass: {mass}}}}}}}\n" for mass in ("1.500", "1500")]
    assert fixed(tmp_path, "links: {base: {inertial: {mass: 1,500}}}\n") == makes


@pytest.mark.parametrize(
    "text",
    [
        "args: {a: 1}\nparameters: {b: 2}\n",
        "links: {base: {unless: true}}\n",
        "joints: {a: {pose: [0, 0, 1]}}\n",
        "links: {base: {visual: {geometry: {sphere: 1}, sphere: 2}}}\n",
        "semantic: {group: {name: arm, chain: {}}, groups: {}}\n",
    ],
)
def test_a_key_whose_place_is_not_certain_stays(tmp_path: Path, text: str):
    assert fixed(tmp_path, text) == []
