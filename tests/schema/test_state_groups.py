"""Group states that name their group are written under it, with their comments."""

import time
from pathlib import Path

import pytest

from tests.schema.test_nesting import fixed

BLOCK = """\
semantic:
  group_states:
    # at first
    home: {group: arm, joints: {elbow: 0}}  # at home

    # the other hand
    open:
      joints: {finger: 1} # wide
      group: hand
    ready:   # A
      group: arm   # B
      # C
      joints:   # D
        elbow: 90 deg   # E
        # wrist: 0
    up:
      joint:
          elbow: 1
      group: arm
  # at last
"""

MADE = """\
semantic:
  group_states:
    # at first
    arm:
      home: {elbow: 0}  # at home
      ready:   # A
        # B
        # C
        # D
        elbow: 90 deg   # E
        # wrist: 0
      up:
        elbow: 1

    hand:
      # the other hand
      open: {finger: 1} # wide
  # at last
"""


@pytest.mark.parametrize(
    ("text", "makes", "code"),
    [
        (BLOCK, MADE, "LF2201"),
        (BLOCK.replace("group_states", "group_state"), MADE, "LF2101"),
        (BLOCK.replace("\n", "\r\n"), MADE.replace("\n", "\r\n"), "LF2201"),
        (
            "semantic: {group_state: {a: {group: arm, joint: {x: 0}}, b: {group: 'hand', joint: {y: [1, 2]}},\n"
            "  c: {joint: {}, group: arm}}}\n",
            "semantic: {group_states: {arm: {a: {x: 0}, c: {}}, 'hand': {b: {y: [1, 2]}}}}\n",
            "LF2101",
        ),
    ],
)
def test_states_are_written_under_their_groups(tmp_path: Path, text: str, makes: str, code: str):
    made, *_ = fixed(tmp_path, text, code)
    assert made == makes


@pytest.mark.parametrize(
    "states",
    [
        "{home: {group: arm,   # its group\n      joints: {x: 0}}}",
        "\n    home: {group: arm,   # its group\n      joints: {x: 0}}",
        "\n    home: {group: arm, joints: &x {x: 0}}\n    up: {group: arm, joints: *x}",
        "\n    home: &x {group: arm, joints: {x: 0}}",
        "\n    home:\n      group:   # its group\n        arm\n      joints: {x: 0}",
        "\n    home:\n      ? group\n      : arm\n      ? joints\n      :\n        x: 0",
        "\n    home:\n      group: arm\n      joints:\n        ? x: 0\n    up:\n      group: arm\n      joints: {x: 0}",
        "\n    ? home\n    : group: arm\n      joints:\n        x: 0",
    ],
)
def test_states_with_something_that_would_be_lost_stay(tmp_path: Path, states: str):
    assert fixed(tmp_path, f"semantic:\n  group_states: {states}\n", "LF2201") == []


def test_a_thousand_states_take_seconds(tmp_path: Path):
    states = "".join(f"    s{n}:\n      group: arm\n      joints:\n        x: {n}\n" for n in range(1000))
    began = time.process_time()
    [made] = fixed(tmp_path, f"semantic:\n  group_state:\n{states}", "LF2101")
    assert made.count("\n") == 3 + 2 * 1000
    assert time.process_time() - began < 10
