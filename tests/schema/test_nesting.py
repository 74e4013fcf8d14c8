"""Fixes that write keys at another level: what they make of a text, and where there is none."""

from pathlib import Path

import pytest

from linkforge_compile import check_file
from linkforge_compile.diagnostics.fix import apply_edits
from linkforge_compile.diagnostics.grouping import ungrouped

HEADER = "linkforge: 1\nname: arm\n"


def fixed(folder: Path, text: str, code: str = "LF2101") -> list[str]:
    """Return what each fix of the first diagnostic of a kind makes of a text."""
    file = folder / "arm.robot.yaml"
    file.write_bytes((HEADER + text).encode())
    one = next(one for one in ungrouped(check_file(file).diagnostics) if one.code.id == code)
    made = [apply_edits(fix.edits[0].span.file, fix.edits) for fix in one.fixes]
    return [text.removeprefix(HEADER) for text in made]


@pytest.mark.parametrize(
    ("text", "makes"),
    [
        # under a key
        (
            "links:\n  base:\n    visual:\n      sphere: 1\n      xyz:\n      - 0\n\n      - 1  # m\n      - 0\n"
            "      rpy: [0, 0, 0]\n    collision: visual\n",
            "links:\n  base:\n    visual:\n      sphere: 1\n      origin:\n        xyz:\n        - 0\n\n"
            "        - 1  # m\n        - 0\n        rpy: [0, 0, 0]\n    collision: visual\n",
        ),
        (
            "links: {a: {visual: {sphere: 1, xyz: [0, 0, 1]}}}\n",
            "links: {a: {visual: {sphere: 1, origin: {xyz: [0, 0, 1]}}}}\n",
        ),
        (
            "links:\n  base:\n    visual:\n    - rpy:\n      - 0\n      - 0\n      - 1\n      sphere: 1\n",
            "links:\n  base:\n    visual:\n    - origin:\n        rpy:\n        - 0\n        - 0\n        - 1\n"
            "      sphere: 1\n",
        ),
        # a neighbour of its section
        (
            "links:\n    base: {}\nmaterials:\n    red: {color: [1, 0, 0]}\nblue:\n    color: [0, 0, 1]\n",
            "links:\n    base: {}\nmaterials:\n    red: {color: [1, 0, 0]}\n    blue:\n        color: [0, 0, 1]\n",
        ),
        # without the map around
        ("robot:\n    linkforge: 1\n    links:\n        base: {}\n", None),
        (
            "joints: {j: {limits: {range: {lower: 0, upper: 1}}}}\n",
            "joints: {j: {limits: {lower: 0, upper: 1}}}\n",
        ),
        # misspelt
        ("links: {base: {inertia: {mass: 1 kg}}}\n", "links: {base: {inertial: {mass: 1 kg}}}\n"),
        ("links: {base: {inertia: {ixx: 1}}}\n", "links: {base: {inertial: {inertia: {ixx: 1}}}}\n"),
        # under another name
        ("bodies:\n  hand: {visual: {sphere: 1}}\n", "links:\n  hand: {visual: {sphere: 1}}\n"),
    ],
)
def test_a_key_at_the_wrong_level_is_written_at_the_right_one(tmp_path: Path, text: str, makes: str | None):
    assert fixed(tmp_path, text) == ([makes] if makes else [])


def test_line_ends_stay_those_of_the_file(tmp_path: Path):
    [made] = fixed(tmp_path, "links:\r\n  a: {visual: {sphere: 1}}\r\nknee: {parent: a, child: b}\r\n")
    assert made == "links:\r\n  a: {visual: {sphere: 1}}\r\njoints:\r\n  knee: {parent: a, child: b}\r\n"


@pytest.mark.parametrize(
    "text",
    [
        "x-a: &a [0, 0, 1]\nlinks: {base: {visual: {sphere: 1, xyz: *a}}}\n",
        "links: {base: {visual: {xyz: [0, 0, 1], sphere: 1, rpy: [0, 0, 0]}}}\n",
        "materials: {red: {color: [1, 0, 0]}}\nlinks: {base: {}}\nblue: {color: [0, 0, 1]}\n",
    ],
)
def test_what_is_not_written_in_one_place_has_no_fix(tmp_path: Path, text: str):
    assert fixed(tmp_path, text) == []


def test_the_line_of_a_section_is_written_at_the_level_of_the_one_around(tmp_path: Path):
    materials = "links:\n  base: {}\n  tip: {}\nmaterials:\n  red: {color: [1, 0, 0]}\n"
    joint = "  j: {type: fixed, parent: base, child: tip}\n"
    assert fixed(tmp_path, materials + joint, "LF2155") == [f"{materials}joints:\n{joint}"]
