"""The same fault of many parts is one diagnostic; a comment takes one part out of it."""

import json
from pathlib import Path

import pytest

from linkforge_compile import check_file, compile_text
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.render_text import render_text
from tests.cli.in_process import linkforge

JOINT = "type: prismatic, parent: base, axis: z, limits: {lower: 0, upper: 1, effort: 0, velocity: 1}"

REPEATED = f"""\
linkforge: 1
name: arm
links:
  base:
  l$(i): {{for: {{i: 12}}}}
joints:
  j$(i): {{{JOINT}, child: l$(i), for: {{i: 12}}}}
"""

WEIGHTLESS = """\
linkforge: 1
name: arm
parameters: {big: false}
variants: {large: {big: true}}
links:
  base: {inertial: {mass: 1, inertia: {ixx: 0, iyy: 0, izz: 0}}}
  tip: {inertial: {mass: 1, inertia: {ixx: 0, iyy: 0, izz: 0}}, when: $(big)}
joints:
  wrist: {type: fixed, parent: base, child: tip, when: $(big)}
"""


def arm(count: int, comment: str = "") -> str:
    """Return a robot with powerless joints from line 5 on, with a comment on the first one."""
    links = ", ".join(f"l{number}: " for number in range(count))
    first, *others = [f"  j{number}: {{child: l{number}, {JOINT}}}" for number in range(count)]
    return "\n".join(("linkforge: 1", "name: arm", f"links: {{base: , {links}}}", "joints:", first + comment, *others))


def lines_of(diagnostic: Diagnostic) -> list[int]:
    return [place.span.line for place in (diagnostic, *diagnostic.notes) if place.span]


def test_the_first_of_many_is_reported_with_the_names_and_places_of_others():
    (powerless,) = compile_text(arm(12)).diagnostics
    assert powerless.message == (
        "joint 'j0' cannot be driven: its limit of effort is 0; "
        "the same for 'j1', 'j2', 'j3', 'j4', 'j5', 'j6', 'j7' and 4 more"
    )
    assert lines_of(powerless) == [5, 6, 7, 8]
    assert powerless.notes[0].message == "'j1' is here"
    assert powerless.notes[-1].message == "and 8 more places"


def test_a_comment_takes_its_part_out_of_the_group():
    (powerless,) = compile_text(arm(12, "  # linkforge: ignore LF5506")).diagnostics
    assert powerless.message.startswith("joint 'j1' cannot be driven: its limit of effort is 0; the same for 'j2', ")
    assert lines_of(powerless)[0] == 6


def test_a_group_of_two_shows_both_places():
    (powerless,) = compile_text(arm(2)).diagnostics
    assert powerless.message == "joint 'j0' cannot be driven: its limit of effort is 0; the same for 'j1'"
    assert lines_of(powerless) == [5, 6]


def test_a_group_shows_its_other_places_without_their_source():
    (powerless,) = compile_text(arm(3)).diagnostics
    assert render_text([powerless]).splitlines()[3:] == [
        "<text>:6:96: note: 'j1' is here",
        "<text>:7:96: note: 'j2' is here",
    ]


def test_all_parts_of_a_repetition_are_counted_at_their_one_place():
    (powerless,) = compile_text(REPEATED).diagnostics
    assert powerless.message.endswith("; the same for 'j1', 'j2', 'j3', 'j4', 'j5', 'j6', 'j7' and 4 more")
    assert powerless.notes == ()


def test_a_large_group_displaces_no_other_diagnostics():
    body = "visual: {box: [1, 1, 1]}, inertial: {mass: 1}"
    links = [f"  l{number}: {{{body}}}" for number in range(1_100)]
    joints = [f"  j{number}: {{type: fixed, parent: base, child: l{number}}}" for number in range(1_100)]
    blocks = ["gazebo:", "  - {reference: j7, provide_feedback: true}"]
    base = f"  base: {{{body}, collision: visual}}"
    text = "\n".join(("linkforge: 1", "name: arm", "links:", base, *links, "joints:", *joints, *blocks))
    found = {one.code.id: one.message for one in compile_text(text).diagnostics}
    assert found.keys() == {"LF6040", "LF6050"}
    assert found["LF6050"].endswith(" and 1,092 more")


@pytest.mark.parametrize(
    ("masses", "messages"),
    [
        ((1, 1), ["link 'l0' has a mass of 1 kg and an inertia of zero; the same for 'l1'"]),
        (
            (1, 2),
            [
                "link 'l0' has a mass of 1 kg and an inertia of zero",
                "link 'l1' has a mass of 2 kg and an inertia of zero",
            ],
        ),
    ],
)
def test_parts_are_grouped_only_if_the_message_holds_for_all(masses: tuple[int, ...], messages: list[str]):
    zero = "inertia: {ixx: 0, iyy: 0, izz: 0}"
    links = [f"  l{number}: {{inertial: {{mass: {mass}, {zero}}}}}" for number, mass in enumerate(masses)]
    joint = "  j: {type: fixed, parent: l0, child: l1}"
    text = "\n".join(("linkforge: 1", "name: arm", "links:", *links, "joints:", joint))
    assert [one.message for one in compile_text(text).diagnostics] == messages


def test_parts_of_two_uses_of_a_module_are_one_group(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(arm(1))
    uses = "".join(f"  {side}: {{use: arm.robot.yaml, parent: torso}}\n" for side in ("left", "right"))
    (tmp_path / "cell.robot.yaml").write_text(f"linkforge: 1\nname: cell\nlinks: {{torso: }}\nmodules:\n{uses}")
    (powerless,) = check_file(tmp_path / "cell.robot.yaml").diagnostics
    assert powerless.message.endswith("; the same for 'right_j0'")
    assert lines_of(powerless) == [5, 5]  # the joint, and where the first module is used


def test_mimics_of_fixed_joints_in_two_uses_are_one_group_without_those_that_a_comment_ignores(tmp_path: Path):
    joints = (
        "  rigid: {type: fixed, parent: base, child: a}",
        "  one: {type: continuous, parent: base, child: b, axis: z, mimic: {joint: rigid}}",
        "  # linkforge: ignore LF5502",
        "  two: {type: continuous, parent: base, child: c, axis: z, mimic: {joint: rigid}}",
        "  three: {type: continuous, parent: base, child: d, axis: z, mimic: {joint: rigid}}",
    )
    hand = ("linkforge: 1", "name: hand", "links: {base: , a: , b: , c: , d: }", "joints:", *joints)
    (tmp_path / "hand.robot.yaml").write_text("\n".join(hand))
    uses = "".join(f"  {side}: {{use: hand.robot.yaml, parent: torso}}\n" for side in ("left", "right"))
    (tmp_path / "cell.robot.yaml").write_text(f"linkforge: 1\nname: cell\nlinks: {{torso: }}\nmodules:\n{uses}")
    (mimics,) = check_file(tmp_path / "cell.robot.yaml").diagnostics
    assert mimics.message == (
        "continuous joint 'left_one' mimics fixed joint 'left_rigid', but both must have one axis; "
        "the same for 'right_one', 'left_three' and 'right_three'"
    )
    assert lines_of(mimics) == [6, 5, 9]  # the joint, where the first module is used, and the other joint


def test_a_part_of_all_variants_is_reported_once(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(WEIGHTLESS)
    run = linkforge("check", "--all-variants", "--format", "json", "arm.robot.yaml", cwd=tmp_path)
    reported = [(one["message"], one["notes"]) for one in json.loads(run.stdout)["diagnostics"]]
    places = dict.fromkeys(("file", "line", "column", "end_line", "end_column"))
    assert reported == [
        ("link 'base' has a mass of 1 kg and an inertia of zero", []),
        (
            "link 'tip' has a mass of 1 kg and an inertia of zero",
            [{"message": "with variant 'large' only", **places}],
        ),
    ]


def test_a_module_that_two_specs_use_is_reported_once(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(arm(2))
    for name, prefix in (("one", '""'), ("two", "r_")):
        use = f"modules: {{arm: {{use: arm.robot.yaml, parent: torso, prefix: {prefix}}}}}"
        (tmp_path / f"{name}.robot.yaml").write_text(f"linkforge: 1\nname: {name}\nlinks: {{torso: }}\n{use}\n")
    run = linkforge("check", "one.robot.yaml", "two.robot.yaml", cwd=tmp_path)
    assert "; the same for 'j1', 'r_j0' and 'r_j1' [LF5506]" in run.stderr
    assert run.stderr.splitlines()[-1] == "checked 2 specs: 1 warning"


def test_options_apply_to_the_whole_group(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(arm(12))
    strict = linkforge("check", "--werror", "arm.robot.yaml", cwd=tmp_path)
    assert (strict.returncode, strict.stderr.splitlines()[-1]) == (1, "checked 1 spec: 1 error")
    ignoring = linkforge("check", "--ignore", "LF5506", "arm.robot.yaml", cwd=tmp_path)
    assert (ignoring.returncode, ignoring.stderr) == (0, "checked 1 spec: no errors\n")


def test_sarif_has_the_further_places_as_related_locations(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(arm(12))
    run = linkforge("check", "--format", "sarif", "arm.robot.yaml", cwd=tmp_path)
    (result,) = json.loads(run.stdout)["runs"][0]["results"]
    assert result["message"]["text"].endswith(" and 4 more\nand 8 more places")
    assert [one["physicalLocation"]["region"]["startLine"] for one in result["relatedLocations"]] == [6, 7, 8]
