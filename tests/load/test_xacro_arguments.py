"""The arguments of xacro files: which there are, without running them, and how a robot of two files takes them."""

import re
from pathlib import Path

import pytest

from linkforge_compile import compile_file, import_urdf, render_srdf, render_urdf
from linkforge_compile.pipeline import parameters_of

HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
URDF = f"""\
{HEAD} name="arm">
  <xacro:arg name="prefix" default=""/>
  <xacro:arg name="kind" default="small"/>
  <xacro:include filename="$(find arm_parts)/urdf/parts.xacro"/>
  <xacro:include filename="$(dirname)/$(arg kind).xacro"/>
  <xacro:include filename="${{'com' + 'puted'}}.xacro"/>
  <xacro:include filename="none.xacro" optional="true"/>
  <xacro:include filename="gone.xacro"/>
  <link name="$(arg prefix)base"/>
  <link name="$(arg tool)"/>
  <joint name="$(arg prefix)turn" type="continuous">
    <parent link="$(arg prefix)base"/><child link="$(arg tool)"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""
SRDF = f"""\
{HEAD} name="arm">
  <xacro:arg name="prefix" default=""/>
  <xacro:arg name="group" default="all"/>
  <xacro:macro name="all" params="joint">
    <group name="$(arg group)"><joint name="${{joint}}"/></group>
  </xacro:macro>
  <xacro:all joint="$(arg prefix)turn"/>
</robot>
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    """Return the folder of the URDF, in a package; its SRDF is in another one."""
    for package in ("arm_parts", "arm_moveit"):
        (tmp_path / package / "urdf").mkdir(parents=True)
        (tmp_path / package / "package.xml").write_text(f"<package><name>{package}</name></package>", "utf-8")
    urdf = tmp_path / "arm_parts" / "urdf"
    (urdf / "arm.urdf.xacro").write_text(URDF, "utf-8")
    (urdf / "parts.xacro").write_text(f'{HEAD}><xacro:arg name="mass" default="${{1 + 1}}"/></robot>', "utf-8")
    (urdf / "small.xacro").write_text(
        f'{HEAD}><xacro:include filename="arm.urdf.xacro"/><xacro:arg name="kind" default="other"/></robot>', "utf-8"
    )
    (tmp_path / "arm_moveit" / "urdf" / "arm.srdf.xacro").write_text(SRDF, "utf-8")
    return urdf


def without_includes(arm: Path) -> Path:
    """Return the URDF that xacro can expand."""
    lines = [line for line in URDF.splitlines() if "xacro:include" not in line]
    (arm / "arm.urdf.xacro").write_text("\n".join(lines), "utf-8")
    return arm / "arm.urdf.xacro"


def test_arguments_of_included_files_are_listed_and_unread_files_reported(arm: Path):
    listing, diagnostics = parameters_of(arm / "arm.urdf.xacro")
    assert [(one.name, one.default) for one in listing.parameters] == [
        ("prefix", ""),
        ("kind", "small"),
        ("mass", "${1 + 1}"),
        ("tool", None),
    ]
    assert [(one.code.id, one.span.line, one.message.partition(": ")[2]) for one in diagnostics] == [
        ("LF8061", 6, "its name is known only as xacro runs"),
        ("LF8061", 8, "there is no file 'gone.xacro'"),
    ]


def test_files_of_a_missing_package_are_reported_and_found_with_package(arm: Path, tmp_path: Path):
    file = tmp_path / "cell.xacro"
    file.write_text(f'{HEAD} name="$(arg name)"><xacro:arg name="name" default="c"/><xacro:include '
                    'filename="$(find parts)/urdf/parts.xacro"/></robot>', "utf-8")  # fmt: skip
    listing, [diagnostic] = parameters_of(file)
    assert "no package named 'parts'; specify its folder with --package parts=FOLDER" in diagnostic.message
    assert [(one.name, one.is_required) for one in listing.parameters] == [("name", True)], "xacro comes too late to it"
    listing, diagnostic = parameters_of(file, packages={"parts": arm.parent})
    assert ([one.name for one in listing.parameters], diagnostic) == (["name", "mass"], ())


def test_a_package_named_by_a_relative_folder_is_that_of_the_working_directory(
    arm: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / "cells").mkdir()
    (tmp_path / "cells" / "cell.xacro").write_text(
        f'{HEAD} name="cell"><xacro:include filename="$(find parts)/urdf/parts.xacro"/></robot>', "utf-8"
    )
    monkeypatch.chdir(tmp_path)
    listing, diagnostics = parameters_of(Path("cells/cell.xacro"), packages={"parts": arm.parent.relative_to(tmp_path)})
    assert ([one.name for one in listing.parameters], diagnostics) == (["mass"], ())


def test_a_urdf_and_its_srdf_take_of_the_arguments_what_each_has(arm: Path, tmp_path: Path):
    pytest.importorskip("xacro")
    urdf, srdf = without_includes(arm), tmp_path / "arm_moveit" / "urdf" / "arm.srdf.xacro"
    imported = import_urdf(urdf, srdf=srdf, arguments=["prefix:=a_", "tool:=t", "group=arm"])
    assert imported.diagnostics == ()
    assert "groups: {arm: {joints: [a_turn]}}" in imported.text
    diagnostics = import_urdf(urdf, srdf=srdf, arguments=["prefix:=a_", "tool:=t", "grup=arm"]).diagnostics
    assert [one.message for one in diagnostics] == ["no parameter named 'grup'; did you mean 'group'?"]


def test_a_use_expands_the_srdf_with_the_same_arguments(arm: Path, tmp_path: Path):
    pytest.importorskip("xacro")
    without_includes(arm)
    (arm / "plain.urdf").write_text(
        '<robot name="arm"><link name="a"/><link name="b"/><joint name="turn" type="continuous"><parent link="a"/>'
        '<child link="b"/></joint></robot>', "utf-8")  # fmt: skip
    spec = tmp_path / "cell.robot.yaml"
    spec.write_text("""\
linkforge: 1
name: cell
links: {floor: }
modules:
  left:
    {use: arm_parts/urdf/arm.urdf.xacro, srdf: arm_moveit/urdf/arm.srdf.xacro, parent: floor, with: {tool: t, group: g}}
  right: {use: arm_parts/urdf/plain.urdf, srdf: arm_moveit/urdf/arm.srdf.xacro, parent: floor, with: {group: h}}
""", "utf-8")  # fmt: skip
    robot = compile_file(spec).result()
    srdf = render_srdf(robot)
    assert '<group name="left_g">\n    <joint name="left_turn"/>' in srdf
    assert '<group name="right_h">\n    <joint name="right_turn"/>' in srdf
    names = {path.name for path in compile_file(spec).files}
    assert "arm.srdf.xacro" in names
    spec.write_text(spec.read_text("utf-8").replace("{group: h}", "{grop: h}"), "utf-8")
    assert [one.message for one in compile_file(spec).diagnostics] == ["no parameter named 'grop'"]


def test_faults_of_an_expanded_srdf_are_reported_in_the_macro(arm: Path, tmp_path: Path):
    pytest.importorskip("xacro")
    urdf, srdf = without_includes(arm), tmp_path / "arm_moveit" / "urdf" / "arm.srdf.xacro"
    passive = '<passive_joint name="$(arg prefix)turn"/></robot>'
    srdf.write_text(SRDF.replace("${joint}", "${joint}x").replace("</robot>", passive), "utf-8")
    imported = import_urdf(urdf, srdf=srdf, arguments=["prefix:=a_", "tool:=t"])
    [diagnostic] = imported.diagnostics
    assert (diagnostic.code.id, Path(diagnostic.span.file.name).name, diagnostic.span.line) == (
        "LF8021",
        "arm.srdf.xacro",
        5,
    )
    assert 'a_turnx"/></group>' in imported.text


def test_a_urdf_has_no_arguments(arm: Path, tmp_path: Path):
    (tmp_path / "a.urdf").write_text('<robot name="a"><link name="a"/></robot>', "utf-8")
    [diagnostic] = import_urdf(tmp_path / "a.urdf", arguments=["reach:=1"]).diagnostics
    assert (diagnostic.code.id, [note.message for note in diagnostic.notes]) == (
        "LF3020",
        ["a URDF takes no arguments"],
    )


def test_a_xacro_on_standard_input_is_reported_without_its_arguments(arm: Path):
    [diagnostic] = import_urdf(
        "<stdin>", text=(arm / "arm.urdf.xacro").read_text("utf-8"), arguments=["reach:=1"]
    ).diagnostics
    assert diagnostic.code.id == "LF8013"
    assert "expanded only in a file named 'NAME.urdf.xacro'" in diagnostic.message


def test_a_default_that_is_set_too_late_is_reported_where_xacro_needs_it(tmp_path: Path):
    pytest.importorskip("xacro")
    file = tmp_path / "a.urdf.xacro"
    file.write_text(
        f'{HEAD}\n  name="$(arg name)">\n  <xacro:arg name="name" default="a"/><link name="a"/>\n</robot>', "utf-8"
    )
    [diagnostic] = import_urdf(file).diagnostics
    assert (diagnostic.code.id, diagnostic.span.line, diagnostic.notes[0].span.line) == ("LF8062", 1, 3)
    assert diagnostic.message == "xacro uses 'name' here, before it reads its default; write 'name:=VALUE'"
    assert import_urdf(file, arguments=["name:=b"]).diagnostics == ()


def test_an_argument_that_is_used_and_declared_nowhere_can_be_given(tmp_path: Path):
    pytest.importorskip("xacro")
    file = tmp_path / "a.urdf.xacro"
    file.write_text(f'{HEAD} name="a"><link name="$(arg link)"/></robot>', "utf-8")
    assert import_urdf(file, arguments=["link:=b"]).diagnostics == ()
    [diagnostic] = import_urdf(file).diagnostics
    assert diagnostic.code.id == "LF3021"


@pytest.mark.parametrize("name", ["arm.urdf", "arm.xacro.urdf"])
def test_a_urdf_that_is_a_xacro_is_expanded(tmp_path: Path, name: str):
    pytest.importorskip("xacro")
    size = '<xacro:property name="size" value="2"/>' if name == "arm.urdf" else ""
    radius = "${size}" if size else "$(optenv NO_SUCH_VARIABLE 2)"
    shape = f'<link name="a"><visual><geometry><sphere radius="{radius}"/></geometry></visual></link>'
    (tmp_path / name).write_text(f'{HEAD} name="r">{size}{shape}</robot>', "utf-8")
    spec = tmp_path / "cell.robot.yaml"
    spec.write_text(f"linkforge: 1\nname: cell\nmodules: {{arm: {{use: {name}}}}}\n", "utf-8")
    assert "sphere: 2" in (import_urdf(tmp_path / name).text or "")
    for file in (tmp_path / name, spec):
        assert compile_file(file).result().links[0].visuals[0].geometry.radius == 2


@pytest.fixture
def package(tmp_path: Path) -> Path:
    pytest.importorskip("xacro")
    (tmp_path / "pkg").mkdir()
    (tmp_path / "pkg/package.xml").write_text('<package format="3"><name>pkg</name></package>', "utf-8")
    (tmp_path / "pkg/r.urdf.xacro").write_text(
        f"""{HEAD} name="r"><link name="a"><visual><geometry>
        <mesh filename="file://$(find pkg)/a.stl"/></geometry></visual></link>
        <gazebo><plugin name="p" filename="p.so"><file>$(find pkg)/c.yaml</file></plugin></gazebo>
        <raw file="$(find pkg)/d.yaml"/></robot>""",
        "utf-8",
    )
    return tmp_path / "pkg"


def test_a_path_that_find_made_is_an_expression(package: Path):
    read = import_urdf(package / "r.urdf.xacro", output=package)
    assert read.text is not None
    assert str(package) not in read.text
    for file in ("a.stl", "c.yaml", "d.yaml"):
        assert f"$(path('package://pkg/{file}'))" in read.text
    (package / "r.robot.yaml").write_text(read.text, "utf-8")
    urdf = render_urdf(compile_file(package / "r.robot.yaml").result())
    assert urdf.count(f"{package}/") == 3
    assert f'"file://{package}/a.stl"' in urdf


def test_a_path_is_an_expression_as_a_whole_and_a_folder_that_is_left_is_reported(package: Path):
    texts = {
        "a": ("$(find pkg)/config/a b.yaml", "$(path('package://pkg/config/a b.yaml'))"),
        "b": ("$(find pkg)/*.yaml", "$(path('package://pkg/*.yaml'))"),
        "c": ("--from $(find pkg)/a.yaml --to b", "--from $(path('package://pkg/a.yaml')) --to b"),
        "d": ("$(find pkg)/a.yaml --to b", "$(path('package://pkg/a.yaml')) --to b"),
        "e": ("$(find pkg)/a.yaml:$(find pkg)/b", "$(path('package://pkg/a.yaml')):$(path('package://pkg/b'))"),
        "f": ("$(find pkg)_two/a.yaml", f"{package}_two/a.yaml"),
        "left_1": ("$(find pkg)", str(package)),
        "left_2": ("$(find pkg)/", f"{package}/"),
        "left_3": ("$(find pkg)/it's.yaml", f"{package}/it's.yaml"),
        "g": (r"$(find pkg)/a\nb.yaml", r"$(path('package://pkg/a'))\nb.yaml"),
        "left_4": ("x $(find pkg)/*.yaml", f"x {package}/*.yaml"),
    }
    inside = "".join(f"<{tag}>{written}</{tag}>\n" for tag, (written, _) in texts.items())
    file = package / "t.urdf.xacro"
    file.write_text(
        f"""{HEAD} name="r"><link name="a"/><gazebo><plugin name="p" filename="p.so">\n{inside}</plugin></gazebo>
        <raw file="$(find pkg)/a b.yaml"/></robot>""",
        "utf-8",
    )
    read = import_urdf(file, output=package)
    assert read.text is not None
    for tag, (_, expected) in texts.items():
        assert re.search(rf"""\b{tag}: ["']?{re.escape(expected)}["']?$""", read.text, re.MULTILINE), tag
    assert """file="$(path('package://pkg/a b.yaml'))\"""" in read.text
    [left] = [one for one in read.diagnostics if one.code.id == "LF8025"]
    assert left.span is not None
    assert (left.span.line, left.notes[0].message) == (8, "and 3 more like this, the next one here")


def test_a_path_of_a_package_that_the_spec_cannot_find_is_reported(package: Path, tmp_path: Path):
    read = import_urdf(package / "r.urdf.xacro", output=tmp_path / "far")
    assert read.text is not None
    assert f"file: {package}/c.yaml" in read.text
    assert [(one.code.id, one.span.line) for one in read.diagnostics if one.span] == [("LF8025", 3)]


@pytest.mark.parametrize("folder", ["pkg", "."])
def test_a_path_in_the_installed_copy_of_a_package_is_an_expression(
    package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: str
):
    installed = tmp_path / "install/share/pkg"
    for copy in (package, installed):
        copy.mkdir(parents=True, exist_ok=True)
        (copy / "c.yaml").write_text("a: 1\n", "utf-8")
    (installed / "d.yaml").write_text("a: 1\n", "utf-8")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "install"))
    read = import_urdf(package / "r.urdf.xacro", output=tmp_path / folder)
    assert read.text is not None
    assert "file: $(path('package://pkg/c.yaml'))" in read.text
    # Only the installation has this file, which a spec in the source tree of the package would not find.
    is_near = folder == "."
    assert (f'"{installed}/d.yaml"' in read.text) is not is_near
    assert ("package://pkg/d.yaml" in read.text) is is_near
    assert [loss.code.id for loss in read.losses] == []
    assert ("LF8025" in {one.code.id for one in read.diagnostics}) is not is_near
