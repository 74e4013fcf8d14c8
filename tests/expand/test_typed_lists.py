"""Lists, maps and vectors that a user types: on the command line, in a launch file, or as text from Python."""

import pytest

from linkforge_compile import compile_text
from tests.cli.in_process import linkforge

SPEC = """\
linkforge: 1
name: r
parameters:
  parts: [a]
  mp: {type: map, default: {a: 1}}
  imu_xyz: [0, 0, 0]
metadata: {parts: $(parts), mp: $(mp), xyz: $(imu_xyz)}
links:
  base:
  part_$(part): {for: {part: $(parts)}}
  imu: {when: $(imu_xyz.x > 0)}
joints:
  imu_joint: {when: $(imu_xyz.x > 0), type: fixed, parent: base, child: imu, origin: $(imu_xyz)}
  part_$(part)_joint: {for: {part: $(parts)}, type: fixed, parent: base, child: part_$(part)}
"""


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("parts", "[]", []),
        ("parts", "[b, c]", ["b", "c"]),
        ("mp", "{}", {}),
        ("mp", "{b: 2}", {"b": 2}),
    ],
)
def test_a_list_or_a_map_may_be_empty(name: str, text: str, value: object):
    metadata = compile_text(SPEC, parameters={name: text}).result().metadata
    assert metadata[name] == value


@pytest.mark.parametrize("text", ["0.1 0.2 0.3", "[0.1, 0.2, 0.3]", " 0.1  0.2 3e-1 ", "[100 mm, 20 cm, 0.3]"])
def test_a_vector_may_have_blanks_between_its_numbers(text: str):
    robot = compile_text(SPEC, parameters={"imu_xyz": text}).result()
    assert robot.joints["imu_joint"].origin.xyz.to_tuple() == (0.1, 0.2, 0.3)


@pytest.mark.parametrize("assignment", ["imu_xyz:=0.1 0.2 0.3", "imu_xyz=0.1 0.2 0.3", "parts:=[]"])
def test_the_command_line_accepts_what_launch_files_pass(assignment: str, tmp_path):
    (tmp_path / "r.robot.yaml").write_text(SPEC, "utf-8")
    run = linkforge("check", "r.robot.yaml", "-p", assignment, cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "checked 1 spec: no errors\n")


@pytest.mark.parametrize(
    ("text", "found"),
    [("0.1 0.2", "a list of 2"), ("0.1 0.2 0.3 4", "a list of 4"), ("0.1 0.2 x", "'0.1 0.2 x'"), ("0.1", "'0.1'")],
)
def test_what_are_not_three_numbers_is_refused(text: str, found: str):
    [error] = [one for one in compile_text(SPEC, parameters={"imu_xyz": text}).diagnostics if one.code.id == "LF3023"]
    assert error.message.endswith(f"takes three numbers, found {found}")
