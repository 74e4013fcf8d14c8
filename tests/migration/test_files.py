"""Includes, data of YAML files and packages."""

from pathlib import Path

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.migration.prove import Migrator
from tests.migration.migrated import migrated, write


def test_what_is_included_is_read_with_its_comments(tmp_path: Path):
    made = migrated(
        tmp_path,
        '<xacro:include filename="parts.xacro"/>\n<xacro:part name="base"/>',
        parts="""
        <!-- how wide all parts are -->
        <xacro:property name="width" value="0.1"/>
        <xacro:macro name="part" params="name">
          <!-- the body -->
          <link name="${name}"><visual><geometry><sphere radius="${width}"/></geometry></visual></link>
        </xacro:macro>
        """,
    )
    assert "  # how wide all parts are\n  width: 0.1\n" in made.files["part.robot.yaml"]
    assert "  # the body\n  $(base_name):" in made.files["part.robot.yaml"]


def test_yaml_files_become_data(tmp_path: Path):
    (tmp_path / "limits_a.yaml").write_text("shoulder: {lower: !degrees -90, upper: 1.5}\n")
    (tmp_path / "limits_b.yaml").write_text("shoulder: {lower: !degrees -45, upper: 1.0}\n")
    spec = migrated(
        tmp_path,
        """
        <xacro:arg name="model" default="a"/>
        <xacro:property name="limits" value="${xacro.load_yaml('limits_' + xacro.arg('model') + '.yaml')}"/>
        <link name="base"/>
        <link name="arm"/>
        <joint name="j" type="revolute">
          <parent link="base"/><child link="arm"/>
          <limit lower="${limits['shoulder']['lower']}" upper="${limits.shoulder.upper}" effort="1" velocity="1"/>
        </joint>
        """,
    ).robot
    assert "../limits_$(model).yaml" in spec
    assert "upper: $(limits.shoulder.upper)" in spec


def test_an_argument_that_chooses_a_file_keeps_its_value(tmp_path: Path):
    made = migrated(
        tmp_path,
        '<xacro:arg name="kind" default="small"/><xacro:include filename="$(arg kind).xacro"/>',
        small='<link name="small"/>',
        large='<link name="large"/>',
    )
    assert "kind: {type: string, default: small, enum: [small]}" in made.robot
    assert [one.code.id for one in made.proved.diagnostics] == ["LF8042"]


def test_comments_of_files_macros_and_calls_come_along(tmp_path: Path):
    main = write(
        tmp_path,
        robot="""
        <!-- Moves the wheel. -->
        <xacro:macro name="wheel" params="name">
          <link name="${name}"><collision><geometry><sphere radius="1"/></geometry></collision></link>
          <joint name="${name}_joint" type="continuous"><parent link="base"/><child link="${name}"/></joint>
        </xacro:macro>
        <!-- Where the battery is. -->
        <xacro:macro name="box"><visual><geometry><box size="1 1 1"/></geometry></visual></xacro:macro>
        <link name="base"><xacro:box/></link>
        <!-- Wheels -->
        <xacro:wheel name="left"/>
        <xacro:wheel name="right"/>
        """,
    )
    main.write_text(f"<!-- Copyright\n     Ada -->\n{main.read_text('utf-8')}", "utf-8")
    proved = Migrator(main, {}, tmp_path / "specs", Settings().loader(main), Diagnostics()).run()
    robot = proved.files["robot.robot.yaml"]
    assert robot.startswith("# Copyright\n# Ada\n\n# linkforge migrate")
    assert "  # Wheels\n  $(wheel.base_name):\n" in robot
    assert "# Where the battery is.\n" in robot
    assert proved.files["wheel.robot.yaml"].startswith("# Moves the wheel.\n\nlinkforge: 1\n")


def test_a_package_that_only_a_value_names_is_declared(tmp_path: Path):
    arm, specs = tmp_path / "vendor/arm", tmp_path / "robots"
    arm.mkdir(parents=True)
    specs.mkdir()
    (arm / "package.xml").write_text("<package><name>arm</name></package>", "utf-8")
    main = write(
        arm,
        robot="""
        <link name="base"><visual><geometry><mesh filename="file://$(find arm)/a.stl"/></geometry></visual></link>
        """,
    )
    loader = Settings(allow_outside=True).loader(main)
    proved = Migrator(main, {}, specs, loader, Diagnostics()).run()
    assert "packages:\n  arm: ../vendor/arm\n" in proved.files["robot.robot.yaml"]
    assert proved.is_equal
