"""What a migration reports, and the command."""

import json
import re
from pathlib import Path

import pytest

from linkforge_compile.migration.proof import Comparison, Prover
from tests.cli.in_process import linkforge
from tests.conftest import ROOT
from tests.migration.migrated import write

ROBOT = """
<xacro:arg name="long" default="false"/>
<xacro:macro name="paint" params="link"><gazebo reference="${link}"><mu1>0.5</mu1></gazebo></xacro:macro>
<link name="base"/>
<xacro:if value="$(arg long)">
  <link name="tip"/>
  <joint name="j" type="fixed"><parent link="base"/><child link="tip"/></joint>
</xacro:if>
<xacro:paint link="base"/>
"""


def test_the_command_writes_specs_and_prints_a_report(tmp_path: Path):
    write(tmp_path, robot=ROBOT)
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", cwd=tmp_path)
    assert ran.returncode == 0
    assert "proof       the same robot for 2 of 2 combinations of its arguments\n" in ran.stdout
    assert "macro 'paint' cannot be a module: it has no links and joints" in ran.stderr  # LF8041
    text = (tmp_path / "specs/robot.robot.yaml").read_text("utf-8")
    assert text.startswith("# linkforge migrate ../robot.xacro -o .\n")
    assert [path.name for path in (tmp_path / "specs").iterdir()] == ["robot.robot.yaml"]


def test_verify_finds_what_was_changed(tmp_path: Path):
    write(tmp_path, robot=ROBOT)
    assert linkforge("migrate", "robot.xacro", "-o", "specs", cwd=tmp_path).returncode == 0
    verify = ("migrate", "robot.xacro", "-o", "specs", "--verify")
    equal = linkforge(*verify, cwd=tmp_path)
    assert equal.returncode == 0
    assert [line.split()[0] for line in equal.stdout.splitlines()] == ["proof", "arguments"]
    assert '"lines_after"' not in linkforge(*verify, "--json", cwd=tmp_path).stdout
    spec = tmp_path / "specs/robot.robot.yaml"
    spec.write_text(spec.read_text("utf-8").replace("mu1: 0.5", "mu1: 0.6"), "utf-8")
    ran = linkforge(*verify, cwd=tmp_path)
    assert ran.returncode == 1
    assert "with all defaults and 1 other combination, the specs give a different robot: " in ran.stderr  # LF8040
    assert "note: this is a change from the robot of xacro to that of the specs\n" in ran.stderr
    assert ran.stderr.endswith("the specs are not equal to the xacro: correct them, or migrate again with --force\n")


def test_verify_reports_an_error_of_a_spec_as_check_does(tmp_path: Path):
    write(tmp_path, robot=ROBOT)
    assert linkforge("migrate", "robot.xacro", cwd=tmp_path).returncode == 0
    spec = tmp_path / "robot.robot.yaml"
    text = spec.read_text("utf-8")
    spec.write_text(text + "frames: {tool: {parent: bse}}\n", "utf-8")
    ran = linkforge("migrate", "robot.xacro", "--verify", cwd=tmp_path)
    assert ran.returncode == 1
    checked = linkforge("check", "robot.robot.yaml", cwd=tmp_path).stderr
    error = checked.partition("[LF4102]")[0]
    assert "LF4102" in checked
    assert ran.stderr.startswith(error)
    assert "different robot" not in ran.stderr
    assert "this is with" not in ran.stderr
    spec.write_text(text + "frames: {tool: {when: $(long), parent: bse}}\n", "utf-8")
    ran = linkforge("migrate", "robot.xacro", "--verify", cwd=tmp_path)
    assert "note: this is with long:=true\n" in ran.stderr


@pytest.mark.parametrize("content", [b"mine\n", "café\n".encode("latin-1")])
def test_other_content_is_replaced_only_by_force(tmp_path: Path, content: bytes):
    write(tmp_path, robot=ROBOT)
    (tmp_path / "robot.robot.yaml").write_bytes(content)
    ran = linkforge("migrate", "robot.xacro", cwd=tmp_path)
    assert ran.returncode == 2
    assert "robot.robot.yaml has other content; use --force to replace it" in ran.stderr
    assert (tmp_path / "robot.robot.yaml").read_bytes() == content
    assert linkforge("migrate", "robot.xacro", "--force", cwd=tmp_path).returncode == 0


def test_a_xacro_that_cannot_be_translated_is_used_as_it_is(tmp_path: Path):
    write(
        tmp_path,
        robot='<xacro:arg name="prefix" default="a_"/><xacro:element xacro:name="link" name="$(arg prefix)base"/>',
    )
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", cwd=tmp_path)
    assert ran.returncode == 0
    assert "because this cannot be translated: <xacro:element> [LF8043]" in ran.stderr
    spec = (tmp_path / "specs/robot.robot.yaml").read_text("utf-8")
    assert 'robot: {use: ../robot.xacro, prefix: "", with: {prefix: $(name_prefix)}}' in spec


def test_combinations_that_xacro_refuses_are_not_compared(tmp_path: Path):
    write(
        tmp_path,
        robot="""
        <xacro:arg name="broken" default="false"/>
        <link name="base"/>
        <xacro:if value="$(arg broken)">
          <joint name="j" type="fixed"><parent link="base"/><child link="nowhere"/></joint>
        </xacro:if>
        """,
    )
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", cwd=tmp_path)
    assert ran.returncode == 0
    assert "with broken:=true, nothing is compared, because xacro's robot is faulty" in ran.stderr  # LF8044


def test_an_argument_that_chooses_a_file_is_reported(tmp_path: Path):
    write(
        tmp_path,
        robot='<xacro:arg name="kind" default="small"/><xacro:include filename="$(arg kind).xacro"/>',
        small='<link name="small"/>',
    )
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", cwd=tmp_path)
    assert "'kind' is 'small' in the specs" in ran.stderr
    assert "[LF8042]" in ran.stderr


def test_the_report_as_json(tmp_path: Path):
    write(tmp_path, robot=ROBOT)
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", "--json", cwd=tmp_path)
    assert '"same": true' in ran.stdout
    assert '"in_place": 1' in ran.stdout


def test_a_file_that_is_none_is_wrong_usage(tmp_path: Path):
    ran = linkforge("migrate", "nothing.xacro", cwd=tmp_path)
    assert ran.returncode == 2
    assert "'nothing.xacro' is not a file" in ran.stderr


@pytest.mark.parametrize("seconds", ["0", "-1", "nan"])
def test_a_time_limit_is_above_zero(tmp_path: Path, seconds: str):
    (tmp_path / "r.xacro").write_text('<robot name="r"><link name="a"/></robot>', "utf-8")
    ran = linkforge("migrate", "r.xacro", "-o", "out", "--seconds", seconds, cwd=tmp_path)
    assert ran.returncode == 2
    assert f"--seconds takes a number above 0, found {seconds}" in ran.stderr
    assert not (tmp_path / "out").exists()


def test_the_example_of_the_docs_is_what_the_command_writes(tmp_path: Path):
    page = (ROOT / "docs/from-xacro.md").read_text("utf-8")
    (tmp_path / "cart.urdf.xacro").write_text(re.findall(r"```xml\n(.*?)```", page, re.DOTALL)[0], "utf-8")
    assert linkforge("migrate", "cart.urdf.xacro", cwd=tmp_path).returncode == 0
    shown = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    assert [(tmp_path / name).read_text("utf-8") for name in ("cart.robot.yaml", "wheel.robot.yaml")] == shown


def test_a_macro_that_cannot_be_translated_stays_one(tmp_path: Path):
    write(
        tmp_path,
        robot="""
        <xacro:include filename="parts.xacro"/>
        <link name="base"/>
        <xacro:part name="tip" parent="base"/>
        """,
        parts="""
        <xacro:macro name="part" params="name parent">
          <xacro:element xacro:name="link" name="${name}"/>
          <joint name="${name}_joint" type="fixed"><parent link="${parent}"/><child link="${name}"/></joint>
        </xacro:macro>
        """,
    )
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert "macro 'part' remains a macro of its xacro" in ran.stderr  # LF8045
    spec = (tmp_path / "specs/robot.robot.yaml").read_text("utf-8")
    assert 'tip: {use: ../parts.xacro, macro: part, parent: base, prefix: "", with: {name: tip}}' in spec


def test_the_report_as_json_counts_the_macros_that_are_parts(tmp_path: Path):
    text = """
<xacro:macro name="tip" params="parent"><link name="tip"/>
  <joint name="j" type="fixed"><parent link="${parent}"/><child link="tip"/></joint></xacro:macro>
<xacro:macro name="arm" params="parent"><xacro:tip parent="${parent}"/></xacro:macro>
<xacro:macro name="mass" params="value"><inertial><mass value="${value}"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></xacro:macro>
<link name="base"><xacro:mass value="1"/></link>
<xacro:arm parent="base"/>
"""
    write(tmp_path, robot=text)
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", "--json", cwd=tmp_path)
    report = json.loads(ran.stdout)
    assert (report["macros"], report["parts"], report["modules"]) == (3, 2, 2)


FAULTS = {
    "an unknown property": ('<xacro:property name="a" value="${b}"/><link name="${a}"/>', "LF8063", "2:33"),
    "a missing file": ('<xacro:include filename="no.xacro"/>', "LF8064", "2:1"),
    "a missing package": ('<xacro:include filename="$(find no_package)/a.xacro"/>', "LF3005", "2:1"),
    "missing data": ("""<link name="${xacro.load_yaml('no.yaml')['a']}"/>""", "LF8064", "2:13"),
    "no XML": ("<link", "LF8032", "3:1"),
    "no link of that name": (
        '<link name="a"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>',
        "LF4102",
        "2:77",
    ),
    "no default": ('<xacro:arg name="n"/><link name="$(arg n)"/>', "LF8032", "2:1"),
    "macros only": ('<xacro:macro name="m"><link name="a"/></xacro:macro>', "LF8039", "1:1"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_what_is_wrong_with_the_xacro_is_told_once_and_at_its_place(fault: str, tmp_path: Path):
    text, code, place = FAULTS[fault]
    write(tmp_path, robot=text)
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", cwd=tmp_path)
    assert ran.returncode == 1
    assert re.findall(r"^(\S+): (?:error|warning): .*\[(LF\d+)\]$", ran.stderr, re.MULTILINE) == [
        (f"robot.xacro:{place}", code)
    ]
    assert ran.stderr.endswith("nothing is written\n")
    assert ran.stdout == ""
    assert not (tmp_path / "specs").exists()


def test_a_file_of_macros_only_tells_how_to_migrate_them(tmp_path: Path):
    write(tmp_path, robot=FAULTS["macros only"][0])
    ran = linkforge("migrate", "robot.xacro", cwd=tmp_path)
    assert "write a xacro beside it that includes it, with a link and a call of each macro" in ran.stderr


def test_a_condition_around_a_file_that_is_not_there_keeps_its_outcome(tmp_path: Path):
    include = '<xacro:include filename="$(find no_package)/arm.xacro"/>'
    write(
        tmp_path,
        robot=f"""<xacro:arg name="arm" default="false"/><link name="base"/>
<xacro:if value="$(arg arm)">{include}</xacro:if>""",
    )
    ran = linkforge("migrate", "robot.xacro", cwd=tmp_path)
    assert "'arm' is 'false' in the specs" in ran.stderr  # LF8042
    assert "robot.xacro:3:1: note: its value is needed here: no package named 'no_package'" in ran.stderr
    spec = (tmp_path / "robot.robot.yaml").read_text("utf-8")
    assert "arm: {type: boolean, default: false, enum: [false]}" in spec


def test_one_reason_is_told_once_for_all_combinations(tmp_path: Path):
    broken = '<joint name="j" type="fixed"><parent link="base"/><child link="nowhere"/></joint>'
    write(
        tmp_path,
        robot=f"""<xacro:arg name="broken" default="false"/><xacro:arg name="big" default="false"/><link name="base"/>
<xacro:if value="$(arg broken)">{broken}</xacro:if><xacro:if value="$(arg big)"><gazebo/></xacro:if>""",
    )
    ran = linkforge("migrate", "robot.xacro", cwd=tmp_path)
    assert ran.stderr.count("LF8044") == 1
    assert "with broken:=true and 1 other combination, nothing is compared" in ran.stderr


def test_the_other_word_that_a_xacro_refuses_is_counted(tmp_path: Path):
    write(
        tmp_path,
        robot="""<xacro:arg name="kind" default="small"/>
<xacro:if value="${'$(arg kind)' == 'small'}"><xacro:property name="size" value="1"/></xacro:if>
<xacro:if value="${'$(arg kind)' == 'large'}"><xacro:property name="size" value="2"/></xacro:if>
<link name="base"><collision><geometry><sphere radius="${size}"/></geometry></collision></link>""",
    )
    for options in ((), ("--verify",)):
        ran = linkforge("migrate", "robot.xacro", *options, cwd=tmp_path)
        assert ran.returncode == 0
        assert "the same robot for 2 of 3 combinations of its arguments, 1 cannot be compared\n" in ran.stdout
        assert "note: with kind:=none_of_these, nothing is compared" in ran.stderr  # LF8044


def _another_robot(_specs: object, arguments: dict[str, str]) -> Comparison:
    return Comparison(arguments, differences=("links/base: removed",))


def test_a_draft_is_written_although_it_is_another_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(Prover, "_compared", lambda _self, specs, arguments: _another_robot(specs, arguments))
    write(tmp_path, robot='<link name="base"/>')
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", cwd=tmp_path)
    assert ran.returncode == 1
    assert ran.stderr.endswith("nothing is written; --draft writes the specs as they are, to correct them by hand\n")
    assert not (tmp_path / "specs").exists()
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", "--draft", cwd=tmp_path)
    assert ran.returncode == 1
    assert "proof       the same robot for 0 of 1 combination of its arguments\n" in ran.stdout
    draft = "wrote specs/robot.robot.yaml, a draft that is not proved; mend it, and run this again with --verify\n"
    assert ran.stderr.endswith(draft)
    assert "base: {}" in (tmp_path / "specs/robot.robot.yaml").read_text("utf-8")


def test_the_output_may_be_the_file_of_the_robot(tmp_path: Path):
    write(tmp_path, robot=ROBOT)
    assert linkforge("migrate", "robot.xacro", "-o", "specs/arm.robot.yaml", cwd=tmp_path).returncode == 0
    text = (tmp_path / "specs/arm.robot.yaml").read_text("utf-8")
    assert text.startswith("# linkforge migrate ../robot.xacro -o arm.robot.yaml\n")
    verify = ("migrate", "robot.xacro", "-o", "specs/arm.robot.yaml", "--verify")
    assert linkforge(*verify, cwd=tmp_path).returncode == 0
    ran = linkforge("migrate", "robot.xacro", "-o", "arm.yaml", cwd=tmp_path)
    assert ran.returncode == 2
    assert "-o takes a folder, or a file that ends in .robot.yaml" in ran.stderr


def test_the_report_lists_the_arguments_that_are_renamed(tmp_path: Path):
    write(tmp_path, robot='<xacro:arg name="prefix" default="a_"/><link name="$(arg prefix)base"/>')
    ran = linkforge("migrate", "robot.xacro", cwd=tmp_path)
    assert "renamed     prefix is name_prefix: launch files give the new names\n" in ran.stdout
    ran = linkforge("migrate", "robot.xacro", "--json", cwd=tmp_path)
    assert json.loads(ran.stdout)["renamed"] == {"prefix": "name_prefix"}
