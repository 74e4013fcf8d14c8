"""A vendor's xacro as a module, unchanged: its arguments, its packages, its places, and what it may not do."""

import errno
import io
import json
import os
from pathlib import Path

import pytest

from linkforge_compile import Compilation, compile_file, compile_text, import_urdf
from linkforge_compile.importers.xacro import process

pytest.importorskip("xacro")

FLOOR = "{inertial: {mass: 10, inertia: {ixx: 1, iyy: 1, izz: 1}}}"
ARM = """\
<?xml version="1.0"?>
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="reach" default="0.5"/>
  <xacro:arg name="has_cover" default="false"/>
  <xacro:arg name="label" default="plain"/>
  <xacro:include filename="$(find arm_parts)/urdf/segment.xacro"/>
  <xacro:property name="table" value="${xacro.load_yaml('$(find arm_parts)/config/masses.yaml')}"/>
  <link name="base"/>
  <xacro:segment name="upper" parent="base" length="$(arg reach)" mass="${table['upper']}">
    <origin xyz="0 0 0.1"/>
  </xacro:segment>
  <xacro:segment name="lower" parent="upper" length="${$(arg reach) / 2}" mass="${table['lower']}">
    <origin xyz="0 0 $(arg reach)"/>
  </xacro:segment>
  <xacro:if value="$(arg has_cover)">
    <link name="cover"/>
    <joint name="cover_joint" type="fixed"><parent link="lower"/><child link="cover"/></joint>
  </xacro:if>
  <gazebo><plugin name="p" filename="libp.so"><label>$(arg label)</label></plugin></gazebo>
</robot>
"""
SEGMENT = """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="segment" params="name parent length mass *origin">
    <link name="${name}">
      <visual><geometry><box size="0.05 0.05 ${length}"/></geometry></visual>
      <collision><geometry><box size="0.05 0.05 ${length}"/></geometry></collision>
      <inertial>
        <mass value="${mass}"/>
        <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
      </inertial>
    </link>
    <joint name="${name}_joint" type="revolute">
      <parent link="${parent}"/><child link="${name}"/>
      <xacro:insert_block name="origin"/>
      <axis xyz="0 1 0"/>
      <limit lower="-1" upper="1" effort="10" velocity="1"/>
    </joint>
  </xacro:macro>
</robot>
"""


@pytest.fixture
def vendor(tmp_path: Path) -> Path:
    """Return the folder of a vendor's package that is not declared anywhere."""
    package = tmp_path / "vendor"
    for folder in ("urdf", "config"):
        (package / folder).mkdir(parents=True)
    (package / "urdf" / "arm.urdf.xacro").write_text(ARM, "utf-8")
    (package / "urdf" / "segment.xacro").write_text(SEGMENT, "utf-8")
    (package / "config" / "masses.yaml").write_text("upper: 2.5\nlower: 1.25\n", "utf-8")
    return package


def cell(folder: Path, modules: str, packages: str = "{arm_parts: vendor}") -> Compilation:
    spec = folder / "cell.robot.yaml"
    text = f"linkforge: 1\nname: cell\npackages: {packages}\nlinks: {{floor: {FLOOR}}}\nmodules:\n  {modules}\n"
    spec.write_text(text, "utf-8")
    return compile_file(spec)


def place(compilation: Compilation) -> tuple[str, int, str]:
    """Return the place and message of the only diagnostic."""
    [diagnostic] = compilation.diagnostics
    return Path(diagnostic.span.file.name).name, diagnostic.span.line, diagnostic.message


def test_two_uses_with_their_own_arguments_prefixes_and_overrides(vendor, tmp_path):
    compilation = cell(
        tmp_path,
        "left: {use: package://arm_parts/urdf/arm.urdf.xacro, parent: floor, with: {reach: 60 cm, has_cover: true}}\n"
        "  right: {use: vendor/urdf/arm.urdf.xacro, parent: floor, "
        "with: {reach: $(0.4 * 2)}, override: {joints: {upper_joint: {limits: {effort: 99}}}}}",
    )
    robot = compilation.result()
    assert robot.joint("left_lower_joint").origin.xyz.z == 0.6
    assert robot.joint("right_lower_joint").origin.xyz.z == 0.8
    assert "left_cover" in robot.links
    assert "right_cover" not in robot.links
    assert [robot.joint(f"{side}_upper_joint").limits.effort for side in ("left", "right")] == [10, 99]
    assert robot.link("right_lower").inertial.mass == 1.25
    names = {path.name for path in compilation.files}
    assert names == {"cell.robot.yaml", "arm.urdf.xacro", "segment.xacro", "masses.yaml"}


def test_a_fault_is_reported_in_the_macro_that_wrote_it(vendor, tmp_path):
    (vendor / "urdf" / "segment.xacro").write_text(SEGMENT.replace('izz="0.01"', 'izz="-1"'), "utf-8")
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor}")
    [first, *_] = compilation.diagnostics
    assert (Path(first.span.file.name).name, first.span.line) == ("segment.xacro", 8)
    assert "used here" in [note.message for note in first.notes]


def test_an_unknown_argument_is_reported_with_the_known_ones(vendor, tmp_path):
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor, with: {reech: 1}}")
    file, line, message = place(compilation)
    assert (file, line) == ("cell.robot.yaml", 6)
    assert message == "no parameter named 'reech'; did you mean 'reach'?"
    note = compilation.diagnostics[0].notes[0]
    assert (Path(note.span.file.name).name, note.span.line) == ("arm.urdf.xacro", 3)


def test_an_argument_without_a_value_is_reported_at_the_use(vendor, tmp_path):
    arm = vendor / "urdf" / "arm.urdf.xacro"
    arm.write_text(ARM.replace('  <xacro:arg name="reach" default="0.5"/>\n', ""), "utf-8")
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor}")
    assert place(compilation) == (
        "cell.robot.yaml",
        6,
        "parameter 'reach' has no default and must be set; write 'with: {reach: VALUE}'",
    )


def test_an_argument_is_no_map(vendor, tmp_path):
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor, with: {reach: {a: 1}}}")
    assert compilation.diagnostics[0].code.id == "LF8033"


def test_a_missing_package_is_reported_at_the_use(vendor, tmp_path):
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor}", packages="{arm_part: vendor}")
    file, line, message = place(compilation)
    assert (file, line) == ("cell.robot.yaml", 6)
    assert message.startswith("no package named 'arm_parts'")
    assert "did you mean 'arm_part'" in message


def test_a_package_that_is_not_sourced_is_reported_in_the_xacro_with_its_folder(vendor, tmp_path, monkeypatch):
    (vendor / "package.xml").write_text("<package><name>arm</name></package>")
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "package.xml").write_text("<package><name>arm_parts</name></package>")
    monkeypatch.chdir(tmp_path)
    [fault] = compile_file("vendor/urdf/arm.urdf.xacro").diagnostics
    assert fault.message == "no package named 'arm_parts'; specify its folder with --package arm_parts=FOLDER"
    assert [note.message for note in fault.notes] == ["there is one; write --package arm_parts=parts"]


@pytest.mark.parametrize(
    ("change", "line", "message"),
    [
        (("${table['lower']}", "${table['nope']}"), 12, "nope"),
        (("</robot>", "</robto>"), 20, "mismatched tag"),
    ],
)
def test_xacro_failures_are_reported_where_they_occur(change, line, message, vendor, tmp_path):
    (vendor / "urdf" / "arm.urdf.xacro").write_text(ARM.replace(*change), "utf-8")
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor}")
    place_found = place(compilation)
    assert place_found[:2] == ("arm.urdf.xacro", line)
    assert place_found[2].startswith("xacro fails here: ")
    assert message in place_found[2]


def test_warnings_of_xacro_are_reported(vendor, tmp_path):
    arm = ARM.replace("  <gazebo>", "  ${xacro.warning('it is old')}\n  <gazebo>")
    (vendor / "urdf" / "arm.urdf.xacro").write_text(arm, "utf-8")
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor}")
    assert "xacro reports: it is old" in [diagnostic.message for diagnostic in compilation.diagnostics]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("${[0 for i in range(10**9)]}", ""),
        ("${'a' * 10**10}", "memory"),
        ('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>', "without an end"),
    ],
)
def test_a_file_without_bounds_comes_to_an_end(text, reason, vendor, tmp_path, monkeypatch):
    monkeypatch.setattr("linkforge_compile.importers.xacro.run.MAX_SECONDS", 1)
    (vendor / "urdf" / "arm.urdf.xacro").write_text(ARM.replace("  <gazebo>", f"  {text}<gazebo>"), "utf-8")
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor}")
    [diagnostic] = compilation.diagnostics
    assert diagnostic.code.id == "LF8032"
    assert reason in diagnostic.message


def test_a_missing_xacro_package_is_reported_with_how_to_install_it(vendor, tmp_path, monkeypatch):
    (tmp_path / "none" / "xacro").mkdir(parents=True)
    (tmp_path / "none" / "xacro" / "__init__.py").write_text("raise ImportError", "utf-8")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "none"))
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor}")
    assert compilation.diagnostics[0].code.id == "LF8031"
    assert place(compilation) == (
        "cell.robot.yaml",
        6,
        "'vendor/urdf/arm.urdf.xacro' needs the xacro package, which runs its expressions: "
        "pip install 'linkforge-compile[xacro]'",
    )


def test_the_environment_can_forbid_xacro(vendor, tmp_path, monkeypatch):
    monkeypatch.setenv("LINKFORGE_NO_XACRO", "1")
    compilation = cell(tmp_path, "a: {use: vendor/urdf/arm.urdf.xacro, parent: floor}")
    assert compilation.diagnostics[0].code.id == "LF8035"


def test_a_xacro_compiles_alone_with_the_arguments_of_the_command_line(vendor):
    compilation = compile_file(
        vendor / "urdf" / "arm.urdf.xacro",
        parameters=["reach:=0.8"],
        packages={"arm_parts": vendor},
    )
    robot = compilation.result()
    assert robot.joint("lower_joint").origin.xyz.z == 0.8
    assert robot.joint("lower_joint").source.span.file.name.endswith("segment.xacro")


def test_a_xacro_is_imported_as_what_it_expands_to(vendor):
    (vendor / "package.xml").write_text("<package><name>arm_parts</name></package>", "utf-8")
    imported = import_urdf(vendor / "urdf" / "arm.urdf.xacro", arguments=["reach:=0.8"])
    assert imported.text is not None, imported.diagnostics
    assert compile_text(imported.text).result().joint("lower_joint").origin.xyz.z == 0.8


OUTSIDE = {
    "a file of data": "<xacro:property name='t' value=\"${xacro.load_yaml('../../secret.yaml')}\"/><link name='${t}'/>",
    "another xacro": "<xacro:include filename='../../secret.yaml'/>",
    "a listing": "<xacro:include filename='../../*.yaml'/>",
    "an optional one": "<xacro:include filename='/etc/passwd' optional='true'/>",
    "a link": "<xacro:include filename='link.xacro'/>",
}


@pytest.mark.parametrize("text", OUTSIDE.values(), ids=OUTSIDE)
def test_a_xacro_reads_within_the_roots(text: str, vendor: Path):
    secret = vendor.parent / "secret.yaml"
    secret.write_text("name: hidden", "utf-8")
    (vendor / "urdf" / "link.xacro").symlink_to(secret)
    (vendor / "package.xml").write_text("<package><name>arm_parts</name></package>", "utf-8")
    arm = vendor / "urdf" / "arm.urdf.xacro"
    arm.write_text(ARM.replace("  <gazebo>", f"  {text}<gazebo>"), "utf-8")
    [diagnostic] = compile_file(arm).diagnostics
    assert diagnostic.code.id == "LF3401"
    assert text in arm.read_text("utf-8").splitlines()[diagnostic.span.line - 1]
    assert all(one.code.id != "LF3401" for one in compile_file(arm, allow_outside=True).diagnostics)


def test_reading_a_path_without_access_is_requested(monkeypatch: pytest.MonkeyPatch):
    """In containers root runs tests, who may look at everything."""

    def refuse(path: object) -> str:
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    requests = io.StringIO()
    monkeypatch.setattr("os.path.realpath", refuse)
    monkeypatch.setattr("sys.stdin", io.StringIO("false\n"))
    assert not process._Run(requests)._may_read("/proc/1/exe.py", (Path("/proc"),))
    assert json.loads(requests.getvalue()) == {"may_read": "/proc/1/exe.py"}


ESCAPES = {
    "a program": ("system('echo > {file}')", "os.system"),
    "a process": ("execv('/bin/sh', ['sh', '-c', 'echo > {file}'])", "os.exec"),
    "a fork": ("fork()", "os.fork"),
    "a folder": ("mkdir('{file}')", "os.mkdir"),
    "a removal": ("remove('{kept}')", "os.remove"),
    "a new file": ("open('{file}', 65)", "writes files"),
    "an old file": ("truncate('{kept}', 0)", "os.truncate"),
    "another file": ("open('/etc/passwd', 0)", "LF3401"),
}


@pytest.mark.skipif(os.name == "nt", reason="the calls are those of POSIX")
@pytest.mark.parametrize(("call", "expected"), ESCAPES.values(), ids=ESCAPES)
def test_indirect_access_from_an_expression_is_refused(call: str, expected: str, vendor: Path, tmp_path: Path):
    """xacro looks for names with `__` in an expression, and not in the comprehensions inside it."""
    new, kept = tmp_path / "new", tmp_path / "kept"
    kept.write_text("kept", "utf-8")
    reach = "[c.__init__.__globals__['sys'].modules['posix'] for c in type(x).__mro__[-1].__subclasses__()"
    value = (
        f"${{[{reach} if c.__name__ == '_wrap_close'][0].{call.format(file=new, kept=kept)}"
        " for x in [1] for type in [python.type]]}"
    )
    arm = vendor / "urdf" / "arm.urdf.xacro"
    arm.write_text(ARM.replace("  <gazebo>", f'  <link name="{value}"/><gazebo>'), "utf-8")
    [diagnostic] = compile_file(arm, packages={"arm_parts": vendor}).diagnostics
    assert expected in str(diagnostic)
    assert not new.exists()
    assert kept.read_text("utf-8") == "kept"


def test_its_srdf_joins_under_the_prefix_and_what_it_refuses_stays_raw(vendor, tmp_path):
    (tmp_path / "arm.srdf").write_text(
        '<robot name="arm"><group name="all"><chain base_link="base" tip_link="lower"/></group>'
        '<group_state name="home" group="all"><joint name="upper_joint" value="0.5"/></group_state>'
        '<passive_joint name="cover_joint"/></robot>',
        "utf-8",
    )
    use = "use: vendor/urdf/arm.urdf.xacro, srdf: arm.srdf, parent: floor"
    compilation = cell(tmp_path, f"a: {{{use}, with: {{has_cover: true}}}}\n  b: {{{use}}}")
    semantic = compilation.result().semantic
    assert [(group.name, group.chains[0].tip_link) for group in semantic.groups] == [
        ("a_all", "a_lower"),
        ("b_all", "b_lower"),
    ]
    assert [dict(state.joint_values) for state in semantic.group_states] == [
        {"a_upper_joint": (0.5,)},
        {"b_upper_joint": (0.5,)},
    ]
    assert [joint.name for joint in semantic.passive_joints] == ["a_cover_joint"]
    assert semantic.extra_elements == ('<passive_joint name="b_cover_joint"/>',)
    assert "LF8021" in {one.code.id for one in compilation.diagnostics}


def test_raw_xml_of_a_xacro_keeps_its_lines(tmp_path: Path):
    file = tmp_path / "c.urdf.xacro"
    file.write_text(
        """<robot name="c" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="mine" params="size">
    <mine>
      <!-- in metres -->
      <a size="${2 * size}" first="1"/>   <!-- doubled -->
      <b>
        <c>some &amp; more</c>
      </b>
    </mine>
  </xacro:macro>
  <link name="base"/>
  <xacro:mine size="2"/>
</robot>""",
        "utf-8",
    )
    assert (import_urdf(file).text or "").endswith(
        """\
extra: |-
  <mine>
    <!-- in metres -->
    <a size="4" first="1"/>   <!-- doubled -->
    <b>
      <c>some &amp; more</c>
    </b>
  </mine>
"""
    )


def test_comments_of_a_macro_stand_at_what_each_call_made(tmp_path: Path):
    file = tmp_path / "c.urdf.xacro"
    file.write_text(
        """<robot name="c" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="part" params="name">
    <!-- a part -->
    <link name="${name}">
      <visual>
        <origin xyz="0 0 1"/> <!-- measured -->
        <geometry><sphere radius="1"/></geometry>
      </visual>
    </link>
  </xacro:macro>
  <xacro:part name="one"/>
  <xacro:part name="two"/> <!-- the last -->
  <joint name="j" type="fixed"><parent link="one"/><child link="two"/></joint>
  <mine><a/> <!-- theirs --></mine>
</robot>""",
        "utf-8",
    )
    assert (
        import_urdf(file).text
        == """\
linkforge: 1
name: c

links:
  # a part
  one:
    visual:
      sphere: 1
      # measured
      origin: [0, 0, 1]
  # a part
  # the last
  two:
    visual:
      sphere: 1
      # measured
      origin: [0, 0, 1]

joints:
  j: {type: fixed, parent: one, child: two}

extra: <mine><a/> <!-- theirs --></mine>
"""
    )
