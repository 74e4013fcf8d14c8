"""`linkforge diff`, run as a program."""

import json
import os
import re
import sys
from pathlib import Path

import pytest
from jsonschema import Draft7Validator

from linkforge_compile.export_spec import write_spec
from tests.cli.in_process import linkforge
from tests.conftest import ROOT
from tests.formats.everything import everything

SCHEMA = Draft7Validator(json.loads((ROOT / "docs" / "diff.schema.json").read_text("utf-8")))

OLD = """\
linkforge: 1
name: arm
parameters: {reach: 1 m}
links: {base: , arm: {inertial: {mass: 2, inertia: {ixx: 1, iyy: 1, izz: 1}}}, tool0: }
joints:
  elbow: {type: revolute, parent: base, child: arm, axis: z, limits: {lower: 0, upper: 90 deg, effort: 1, velocity: 1}}
  flange: {type: fixed, parent: arm, child: tool0, origin: [0, 0, $(reach)]}
semantic: {groups: {arm: {joints: [elbow]}}}
"""
NEW = OLD.replace("upper: 90 deg", "upper: 120 deg").replace("tool0", "tool").replace("mass: 2", "mass: 2.1")

TEXT = """\
old.robot.yaml → new.robot.yaml: 1 renamed, 2 changed

breaking: removed names that others may rely on
  link  tool0, now tool

links
  > tool: was 'tool0'
  ~ arm
      inertial/mass: 2 kg → 2.1 kg (+5 %)

joints
  ~ elbow
      limits/upper: 90 deg → 120 deg (+30 deg)
"""


@pytest.fixture
def arms(tmp_path: Path) -> Path:
    (tmp_path / "old.robot.yaml").write_text(OLD)
    (tmp_path / "new.robot.yaml").write_text(NEW)
    return tmp_path


def test_differences_are_shown_in_terms_of_the_robot(arms: Path):
    run = linkforge("diff", "old.robot.yaml", "new.robot.yaml", cwd=arms)
    assert (run.returncode, run.stdout, run.stderr) == (1, TEXT, "")


def test_the_same_robot_is_no_difference(arms: Path):
    linkforge("compile", "old.robot.yaml", "-o", "old.urdf", cwd=arms)
    run = linkforge("diff", "old.robot.yaml", "old.urdf", cwd=arms)
    expected = "old.robot.yaml and old.urdf are the same robot\nthe semantic part is omitted: old.urdf has none\n"
    assert (run.returncode, run.stdout) == (0, expected)


def test_a_spec_is_the_same_robot_as_what_it_compiles_to(tmp_path: Path):
    """Its sensors are Gazebo's there, its raw XML is read in other places, and its metadata are nowhere."""
    spec = tmp_path / "all.robot.yaml"
    spec.write_text(write_spec(everything()), "utf-8")
    assert linkforge("compile", spec.name, "-o", ".", cwd=tmp_path).returncode == 0
    run = linkforge("diff", spec.name, "all.urdf", "--after-srdf", "all.srdf", cwd=tmp_path)
    assert run.stdout == "all.robot.yaml and all.urdf (all.srdf) are the same robot\n"
    urdf = tmp_path / "all.urdf"
    urdf.write_text(re.sub(r"<update_rate>[^<]*", "<update_rate>7", urdf.read_text("utf-8"), count=1), "utf-8")
    run = linkforge("diff", spec.name, "all.urdf", "--after-srdf", "all.srdf", cwd=tmp_path)
    assert (run.returncode, run.stdout.count("update_rate: ")) == (1, 1)


def test_a_spec_whose_urdf_does_not_read_back_is_compared_as_written(tmp_path: Path):
    spec = "linkforge: 1\nname: r\nlinks: {a: }\nsensors: {imu: {type: imu, link: a}}\n"
    (tmp_path / "r.robot.yaml").write_text(spec)
    linkforge("compile", "r.robot.yaml", "-o", "r.urdf", cwd=tmp_path)
    declared = 'extra_attributes: {"xmlns:xacro": "http://x"}\nextra: <xacro:macro name="foo"/>\n'
    (tmp_path / "r.robot.yaml").write_text(spec + declared)
    reason = "<xacro:macro> is xacro syntax, which is expanded only in a file named 'NAME.urdf.xacro'"
    run = linkforge("diff", "r.urdf", "r.robot.yaml", cwd=tmp_path)
    line = f"r.robot.yaml is compared as written, since its URDF does not read back: {reason}"
    assert (run.returncode, line in run.stdout.splitlines()) == (1, True)
    report = json.loads(linkforge("diff", "r.robot.yaml", "r.urdf", "--json", cwd=tmp_path).stdout)
    SCHEMA.validate(report)
    assert report["not_read_back"] == reason


def test_parameters_go_to_every_spec(arms: Path):
    linkforge("compile", "old.robot.yaml", "-o", "old.urdf", cwd=arms)
    run = linkforge("diff", "old.urdf", "old.robot.yaml", "reach:=1.5", cwd=arms)
    assert run.returncode == 1
    assert "  ~ flange\n      origin: moved by 500 mm (z +500 mm)\n" in run.stdout


def test_each_side_has_parameters_and_a_variant_of_its_own(arms: Path):
    file = arms / "old.robot.yaml"
    file.write_text(f"{OLD}variants: {{long: {{reach: 2}}}}\n")
    twice = ("diff", file.name, file.name)
    run = linkforge(*twice, "--before", "reach=0.5", "--after", "reach:=0.75 m", cwd=arms)
    assert "  ~ flange\n      origin: moved by 250 mm (z +250 mm)\n" in run.stdout
    run = linkforge(*twice, "--after-variant", "long", cwd=arms)
    assert "  ~ flange\n      origin: moved by 1000 mm (z +1000 mm)\n" in run.stdout
    linkforge("compile", file.name, "-o", "old.urdf", cwd=arms)
    run = linkforge("diff", "old.urdf", file.name, "--before", "reach=1", cwd=arms)
    assert (run.returncode, run.stdout) == (2, "")
    assert "'old.urdf' has no parameters" in run.stderr


def test_of_two_variants_for_one_side_none_is_forgotten_in_silence(arms: Path):
    run = linkforge(
        "diff", "old.robot.yaml", "old.robot.yaml", *["--after-variant", "a", "--after-variant", "b"], cwd=arms
    )
    assert run.returncode == 2
    assert "argument --after-variant: may be given once, found 'a' and 'b'" in run.stderr


def test_the_values_of_one_side_come_first_and_are_in_the_heading(arms: Path):
    (arms / "old.robot.yaml").write_text(f"{OLD}variants: {{long: {{reach: 2}}}}\n")
    twice = ("diff", "old.robot.yaml", "old.robot.yaml")
    run = linkforge(*twice, "--variant", "long", "-p", "reach=1", "--after", "reach=0.75 m", cwd=arms)
    assert run.stdout.splitlines()[0] == "old.robot.yaml → old.robot.yaml (reach=0.75 m): 1 changed"
    assert "moved by 250 mm (z -250 mm)" in run.stdout
    run = linkforge(*twice, "--after-variant", "long", "--before", "reach=2", cwd=arms)
    assert run.stdout == "old.robot.yaml (reach=2) and old.robot.yaml (variant long) are the same robot\n"


def test_an_srdf_is_the_semantic_part_of_its_urdf(arms: Path):
    linkforge("compile", "old.robot.yaml", "-o", ".", cwd=arms)
    run = linkforge("diff", "old.urdf", "old.robot.yaml", "--before-srdf", "old.srdf", cwd=arms)
    assert (run.returncode, run.stdout) == (0, "old.urdf (old.srdf) and old.robot.yaml are the same robot\n")
    srdf = arms / "old.srdf"
    srdf.write_text(srdf.read_text().replace('<joint name="elbow"', '<joint name="flange"'))
    run = linkforge("diff", "old.urdf", "old.robot.yaml", "--before-srdf", "old.srdf", cwd=arms)
    assert (run.returncode, run.stderr) == (1, "")
    assert "  ~ groups/arm\n      + joints: elbow\n      - joints: flange\n" in run.stdout


def test_a_xacro_gets_its_arguments(arms: Path):
    pytest.importorskip("xacro")
    (arms / "a.urdf.xacro").write_text(
        '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="link" default="b"/>'
        '<link name="$(arg link)"/></robot>'
    )
    run = linkforge("diff", "a.urdf.xacro", "a.urdf.xacro", "--after", "link=c", cwd=arms)
    assert (run.returncode, run.stderr) == (1, "")
    assert "> c: was 'b'" in run.stdout


def test_each_robot_gets_the_parameters_that_it_declares(arms: Path):
    pytest.importorskip("xacro")
    (arms / "a.urdf.xacro").write_text(
        '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="link" default="b"/>'
        '<xacro:arg name="reach" default="1"/><link name="$(arg link)$(arg reach)"/></robot>'
    )
    (arms / "b.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nparameters: {reach: 1, mode: fast}\nlinks: {'c$(reach)': }\n"
    )
    both = ("diff", "a.urdf.xacro", "b.robot.yaml")
    run = linkforge(*both, "link:=c", "reach:=2", "mode:=slow", cwd=arms)
    assert (run.returncode, run.stderr) == (0, "")
    run = linkforge(*both, "lnk:=c", cwd=arms)
    assert run.returncode == 2
    assert "no parameter named 'lnk'; did you mean 'link'?" in run.stderr


def test_json_fits_its_schema(arms: Path):
    run = linkforge("diff", "old.robot.yaml", "new.robot.yaml", "--json", cwd=arms)
    report = json.loads(run.stdout)
    SCHEMA.validate(report)
    assert report["breaking"] == [{"kind": "link", "name": "tool0", "now": "tool"}]
    assert report["differences"][1] == {
        "kind": "changed",
        "path": "links/arm/inertial/mass",
        "before": 2,
        "after": 2.1,
        "text": "2 kg → 2.1 kg (+5 %)",
    }


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (["old.robot.yaml"], "takes two robots, found 1"),
        (["-", "-"], "only one of the robots can come from standard input"),
        (["old.robot.yaml", "none.robot.yaml"], "none.robot.yaml"),
        (["old.robot.yaml", "none.urdf"], "none.urdf"),
        (["a.urdf", "b.urdf", "reach:=1"], "nothing takes 'reach:=1': a URDF has no parameters"),
        (["a.urdf", "b.urdf", "--variant", "long"], "nothing takes '--variant long': a URDF has no variants"),
        (["a.urdf", "b.srdf"], "'b.srdf' is an SRDF; pass it with its robot: --after-srdf b.srdf"),
        (["a.urdf", "new.robot.yaml", "--after-srdf", "b.srdf"], "'new.robot.yaml' has 'semantic' for it"),
        (["old.robot.yaml", "new.robot.yaml", "--tolerance", "-1"], "takes a number from 0 to below 1"),
    ],
)
def test_what_is_no_robot_is_trouble(arms: Path, words: list[str], fault: str):
    run = linkforge("diff", *words, cwd=arms)
    assert (run.returncode, run.stdout) == (2, "")
    assert fault in run.stderr


def test_a_urdf_comes_from_standard_input_and_by_any_name(tmp_path: Path):
    urdf = '<robot name="arm"><link name="base"/></robot>'
    (tmp_path / "arm").write_text(urdf.replace("base", "foot"))
    spec = "linkforge: 1\nname: arm\nparameters: {reach: 1 m}\nlinks: {base: }\n"
    (tmp_path / "arm.robot.yaml").write_text(spec)
    same = linkforge("diff", "-", "arm.robot.yaml", "reach:=2m", cwd=tmp_path, stdin=urdf)
    assert (same.returncode, same.stdout, same.stderr) == (0, "- and arm.robot.yaml are the same robot\n", "")
    other = linkforge("diff", "arm", "-", cwd=tmp_path, stdin=urdf)
    assert (other.returncode, "> base: was 'foot'" in other.stdout) == (1, True)
    refused = linkforge("diff", "-", "arm", "--before", "reach=1", cwd=tmp_path, stdin=urdf)
    assert (refused.returncode, "'-' has no parameters" in refused.stderr) == (2, True)


@pytest.mark.skipif(sys.platform == "win32", reason="a pipe with a name is one of POSIX")
@pytest.mark.parametrize(
    "text", ['<robot name="arm"><link name="base"/></robot>', "{linkforge: 1, name: arm, links: {base: }}"]
)
def test_a_robot_comes_from_a_pipe(tmp_path: Path, text: str):
    (tmp_path / "arm.urdf").write_text('<robot name="arm"><link name="base"/></robot>')
    reads, writes = os.pipe()
    os.write(writes, text.encode())
    os.close(writes)
    with os.fdopen(reads):
        run = linkforge("diff", f"/dev/fd/{reads}", "arm.urdf", cwd=tmp_path)
    assert (run.returncode, run.stdout) == (0, f"/dev/fd/{reads} and arm.urdf are the same robot\n")


@pytest.mark.parametrize("form", ["json", "sarif"])
def test_the_errors_of_both_robots_are_one_document(arms: Path, form: str):
    for name in ("old", "new"):
        (arms / f"{name}.robot.yaml").write_text(OLD.replace("mass: 2", f"{name}_mass: 2"))
    run = linkforge("diff", "old.robot.yaml", "new.robot.yaml", "--diagnostics", form, cwd=arms)
    assert run.returncode == 2
    assert json.loads(run.stderr)
    assert all(f"{name}.robot.yaml" in run.stderr for name in ("old", "new"))
