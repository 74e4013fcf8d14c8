"""What the values of a macro may be: dimensions, values around its call, and blocks."""

from pathlib import Path

import pytest

from linkforge_compile import compile_file
from linkforge_compile.diagnostics import Diagnostic

pytest.importorskip("xacro")

CAMERA = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:macro name="camera" params="name parent height:=^ weight:=1 turn:=1 **extra">
  <link name="${name}">
    <inertial><mass value="${weight}"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <xacro:insert_block name="extra"/>
  </link>
  <joint name="${name}_joint" type="fixed">
    <parent link="${parent}"/><child link="${name}"/><origin xyz="0 0 ${height / 2}" rpy="0 0 ${1 / turn}"/>
  </joint>
</xacro:macro>
</robot>
"""


def _diagnostics(folder: Path, given: str) -> list[Diagnostic]:
    (folder / "camera.xacro").write_text(CAMERA, "utf-8")
    entry = f"{{use: camera.xacro, macro: camera, parent: base, with: {{{given}}}}}"
    spec = f"linkforge: 1\nname: robot\nlinks: {{base: }}\nmodules:\n  front: {entry}\n"
    (folder / "robot.robot.yaml").write_text(spec, "utf-8")
    found = compile_file(folder / "robot.robot.yaml").diagnostics
    return [one for one in found if not one.code.id.startswith("LF6")]


@pytest.mark.parametrize("given", ["height: 3 cm, weight: 2 kg", "height: 0.1, weight: 200 g", "height: 1, turn: 3 kg"])
def test_quantities_are_taken_that_fit_or_are_used_otherwise(given: str, tmp_path: Path):
    assert _diagnostics(tmp_path, f"{given}, extra: ''") == []


def test_a_quantity_of_another_dimension_is_told_with_its_use(tmp_path: Path):
    (fault,) = _diagnostics(tmp_path, "height: 3 kg, extra: ''")
    assert fault.message == "'height' takes a length, found '3 kg', which is a mass"
    assert fault.code.id == "LF5002"
    (note,) = fault.notes
    assert note.span
    assert (note.span.file.name.endswith("camera.xacro"), note.span.line) == (True, 9)


def test_a_value_that_is_not_around_the_call_is_to_be_written(tmp_path: Path):
    (fault,) = _diagnostics(tmp_path, "extra: ''")
    assert fault.message == (
        "parameter 'height' of macro 'camera' has no default and must be set; write 'with: {height: VALUE}'"
    )
    (note,) = fault.notes
    assert note.message == "'height:=^' takes the value around the call, and there is none"
    assert note.span
    assert note.span.line == 2


@pytest.mark.parametrize(
    ("block", "problem"),
    [
        ("<visual>", "it is not XML: it ends before </visual>"),
        ("<visual", "it is not XML: this tag is not closed"),
        ("</visual>", "it is not XML: </visual> closes no open element"),
    ],
)
def test_what_is_wrong_with_the_xml_of_a_block_is_told(block: str, problem: str, tmp_path: Path):
    (fault,) = _diagnostics(tmp_path, f"height: 1, extra: '{block}'")
    assert fault.code.id == "LF8036"
    assert [note.message for note in fault.notes] == [problem]


@pytest.mark.parametrize("given", ["length: 500 mm, density: 2700 kg/m^3", "length: 500 mm, density: 2700"])
def test_a_factor_may_have_a_dimension_of_its_own(given: str, tmp_path: Path):
    """The mass of a profile is its length times a mass per metre, or its density times a volume."""
    macro = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="profile" params="length density">
      <link name="bar"><inertial><mass value="${length * 1.5}"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
        <visual><geometry><box size="1 1 ${2*length}"/></geometry></visual></link>
      <link name="block"><inertial><mass value="${0.001 * density}"/>
        <inertia ixx="1" iyy="1" izz="1"/></inertial></link>
      <joint name="j" type="fixed"><parent link="bar"/><child link="block"/></joint>
    </xacro:macro></robot>"""
    (tmp_path / "profile.xacro").write_text(macro, "utf-8")
    entry = f"{{use: profile.xacro, macro: profile, with: {{{given}}}}}"
    (tmp_path / "robot.robot.yaml").write_text(f"linkforge: 1\nname: robot\nmodules: {{bar: {entry}}}\n", "utf-8")
    assert not [one for one in compile_file(tmp_path / "robot.robot.yaml").diagnostics if one.code.id == "LF5002"]
    faulty = entry.replace("500 mm", "3 kg")
    (tmp_path / "robot.robot.yaml").write_text(f"linkforge: 1\nname: robot\nmodules: {{bar: {faulty}}}\n", "utf-8")
    (fault,) = [one for one in compile_file(tmp_path / "robot.robot.yaml").diagnostics if one.code.id == "LF5002"]
    assert fault.message == "'length' takes a length, found '3 kg', which is a mass"
