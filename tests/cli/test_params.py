"""`linkforge params` and `--variant`, run as a program."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from linkforge_compile.limits import Limit
from tests.cli.in_process import linkforge
from tests.cli.test_compile import box_height

ARM = """\
linkforge: 1
name: arm
description: An arm.
parameters:
  reach: {type: length, default: 800 mm, minimum: 0.2 m, maximum: 1.5 m, description: Base to tool.}
  hardware: {type: string, enum: [mock, real], default: mock}
  tool: {type: string, pattern: '^[a-z]+$'}
  half: {default: $(reach / 2)}
  offset: [0, 0, 10 cm]
variants:
  lab: {reach: 50 cm, tool: gripper}
  bare: {tool: none}
links:
  base: {visual: {box: [1, 1, $(reach)]}}
"""

TABLE = """\
arm: An arm.

parameter  type    default               limits          description
reach      length  800 mm = 0.8 m        0.2 m to 1.5 m  Base to tool.
hardware   string  mock                  mock | real
tool       string  (required)            like ^[a-z]+$
half       length  $(reach / 2) = 0.4 m
offset     vector  [0, 0, 10 cm]

variant  sets
lab      reach=50 cm, tool=gripper
bare     tool=none
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    return tmp_path


def test_the_parameters_are_a_table(arm: Path):
    run = linkforge("params", "arm.robot.yaml", cwd=arm)
    assert (run.returncode, run.stdout, run.stderr) == (0, TABLE, "")


def test_the_parameters_are_json_for_tools(arm: Path):
    run = linkforge("params", "arm.robot.yaml", "--json", cwd=arm)
    listed = json.loads(run.stdout)
    assert listed["parameters"][0] == {
        "name": "reach",
        "type": "length",
        "unit": "m",
        "required": False,
        "default": "800 mm",
        "value": 0.8,
        "minimum": 0.2,
        "maximum": 1.5,
        "enum": None,
        "pattern": None,
        "description": "Base to tool.",
    }
    assert [(one["name"], one["required"], one["value"]) for one in listed["parameters"][2:]] == [
        ("tool", True, None),
        ("half", False, 0.4),
        ("offset", False, [0, 0, 0.1]),
    ]
    assert listed["variants"][1] == {"name": "bare", "sets": {"tool": "none"}}


def test_a_faulty_declaration_is_reported_with_the_others(arm: Path):
    (arm / "arm.robot.yaml").write_text(ARM.replace("default: 800 mm", "default: 3 kg"))
    run = linkforge("params", "arm.robot.yaml", cwd=arm)
    assert run.returncode == 1
    assert "[LF3023]" in run.stderr
    assert "hardware   string  mock" in run.stdout


def test_a_spec_without_parameters_is_reported_as_such(tmp_path: Path):
    (tmp_path / "box.robot.yaml").write_text("linkforge: 1\nname: box\nlinks: {base: }\n")
    run = linkforge("params", "box.robot.yaml", cwd=tmp_path)
    assert run.stdout == "box\n\nIt has no parameters.\n"


def test_a_variant_is_compiled(arm: Path):
    run = linkforge("compile", "arm.robot.yaml", "--variant", "lab", cwd=arm)
    assert (run.returncode, box_height(run.stdout)) == (0, "0.5")
    run = linkforge("compile", "arm.robot.yaml", "--variant", "lab", "reach:=0.3m", cwd=arm)
    assert box_height(run.stdout) == "0.3"


def test_all_variants_are_checked_in_one_report(arm: Path):
    spec = ARM.replace("box: [1, 1, $(reach)]", "box: [1, 1, $(1 / (reach - 0.5))], material: red")
    (arm / "arm.robot.yaml").write_text(spec)
    run = linkforge("check", "arm.robot.yaml", "--all-variants", cwd=arm)
    assert run.returncode == 1
    assert run.stderr.count("[LF3125]") == run.stderr.count("[LF4105]") == 1
    assert "note: with variant 'lab' only" in run.stderr
    assert "with the defaults and every variant" not in run.stderr.rpartition("checked")[0], (
        "what all have needs no note"
    )
    assert run.stderr.splitlines()[-1] == "checked 1 spec with the defaults and 2 variants: 2 errors"


def test_variants_that_were_not_checked_are_counted(arm: Path, monkeypatch: pytest.MonkeyPatch):
    spec = "linkforge: 1\nname: arm\nlinks: {base: }\nvariants: {a: , b: , c: , d: , e: , f: , g: , h: }\n"
    (arm / "arm.robot.yaml").write_text(spec)
    monkeypatch.setattr(Limit.CHARACTERS_READ, "_value_", replace(Limit.CHARACTERS_READ.value, most=len(spec)))
    run = linkforge("check", "arm.robot.yaml", "--all-variants", cwd=arm)
    assert run.stderr.splitlines()[1:] == [
        "note: what comes after variant 'd' is not checked",
        "checked 1 spec with the defaults and 4 variants, but not with 4 more: 1 error",
    ]


def test_one_variant_or_all_of_them(arm: Path):
    run = linkforge("check", "arm.robot.yaml", "--all-variants", "--variant", "lab", cwd=arm)
    assert run.returncode == 2
    assert "--variant or --all-variants" in run.stderr


def test_a_xacro_has_its_arguments_and_a_urdf_none(tmp_path: Path):
    (tmp_path / "a.urdf.xacro").write_text(
        '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:arg name="reach" default="0.5"/><xacro:arg name="prefix" default=""/>'
        '<xacro:arg name="serial"/><link name="a"/></robot>'
    )
    (tmp_path / "a.urdf").write_text('<robot name="arm"><link name="a"/></robot>')
    run = linkforge("params", "a.urdf.xacro", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert [line.split() for line in run.stdout.splitlines()[3:]] == [
        ["reach", "string", "0.5"],
        ["prefix", "string", '""'],
        ["serial", "string", "(required)"],
    ]
    assert linkforge("params", "a.urdf", cwd=tmp_path).stdout == "arm\n\nIt has no parameters.\n"
    run = linkforge("check", "--all-variants", "a.urdf", "a.urdf.xacro", "serial:=7", "--quiet", cwd=tmp_path)
    assert run.returncode == 1, "the URDF has no parameter 'serial'"
    assert "serial" in run.stderr
