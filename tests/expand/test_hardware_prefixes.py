"""A vendor's arm with a driver that composes names from a parameter: its ways out where the arm has a prefix."""

import pytest

from linkforge_compile import compile_file, render_urdf

XACRO = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="tf_prefix" default=""/>
  <xacro:macro name="arm" params="tf_prefix">
    <link name="${tf_prefix}base"/>
    <ros2_control name="${tf_prefix}ur" type="sensor">
      <hardware>
        <plugin>ur_robot_driver/URPositionHardwareInterface</plugin>
        <param name="tf_prefix">${tf_prefix}</param>
      </hardware>
      <sensor name="${tf_prefix}tcp_fts_sensor"><state_interface name="force.x"/></sensor>
    </ros2_control>
  </xacro:macro>
  <xacro:arm tf_prefix="$(arg tf_prefix)"/>
</robot>
"""
URDF = """\
<robot name="arm">
  <link name="base"/>
  <ros2_control name="ur" type="sensor">
    <hardware><plugin>driver/Arm</plugin><param name="tf_prefix">VALUE</param></hardware>
    <sensor name="tcp_fts_sensor"><state_interface name="force.x"/></sensor>
  </ros2_control>
</robot>
"""
OVERRIDE = "override: {ros2_control: {ur: {parameters: {tf_prefix: ...}}}}"


def mounted(tmp_path, arm: str, fields: str):
    """Return the URDF of a cell with the arm, and its messages of LF5706."""
    name = "arm.urdf.xacro" if "xacro:arm" in arm else "arm.urdf"
    (tmp_path / name).write_text(arm, "utf-8")
    spec = tmp_path / "cell.robot.yaml"
    spec.write_text(
        f"linkforge: 1\nname: cell\nlinks: {{table: }}\nmodules:\n  left: {{use: {name}, parent: table{fields}}}\n",
        "utf-8",
    )
    compilation = compile_file(spec)
    messages = [one.message for one in compilation.diagnostics if one.code.id == "LF5706"]
    return render_urdf(compilation.result()), messages


def test_the_use_that_gives_the_prefix_is_shown(tmp_path):
    (tmp_path / "arm.urdf").write_text(URDF.replace("VALUE", ""), "utf-8")
    (tmp_path / "tool.robot.yaml").write_text(
        "linkforge: 1\nname: tool\nlinks: {plate: }\nmodules:\n  arm: {use: arm.urdf, parent: plate}\n", "utf-8"
    )
    cell = tmp_path / "cell.robot.yaml"
    cell.write_text(
        "linkforge: 1\nname: cell\nlinks: {table: }\nmodules: {left: {use: tool.robot.yaml, parent: table}}\n", "utf-8"
    )
    (prefix,) = (one for one in compile_file(cell).diagnostics if one.code.id == "LF5706")
    places = [(note.message, note.span.file.path.name, note.span.line) for note in prefix.notes]
    assert places == [("used here", "tool.robot.yaml", 5), ("used here", "cell.robot.yaml", 4)]


@pytest.mark.parametrize("arm", [URDF.replace("VALUE", ""), XACRO], ids=["urdf", "xacro"])
def test_a_prefix_that_the_driver_reads_and_that_stays_is_reported_with_its_override(arm: str, tmp_path):
    if arm == XACRO:
        pytest.importorskip("xacro")
    urdf, messages = mounted(tmp_path, arm, "")
    assert '<sensor name="left_tcp_fts_sensor">' in urdf
    assert messages == [
        "'tf_prefix' of hardware 'ur' stays empty, but its sensor 'tcp_fts_sensor' gets the prefix; change it to "
        f"'left_' by '{OVERRIDE}' where this file is used"
    ]


def test_the_override_is_one_way_out(tmp_path):
    urdf, messages = mounted(tmp_path, URDF.replace("VALUE", ""), f", {OVERRIDE.replace('...', 'left_')}")
    assert not messages
    assert '<sensor name="left_tcp_fts_sensor">' in urdf
    assert '<param name="tf_prefix">left_</param>' in urdf


def test_the_argument_of_the_xacro_without_a_prefix_of_ours_is_the_other_way_out(tmp_path):
    pytest.importorskip("xacro")
    urdf, messages = mounted(tmp_path, XACRO, ', prefix: "", with: {tf_prefix: left_}')
    assert not messages
    assert '<sensor name="left_tcp_fts_sensor">' in urdf
    assert '<param name="tf_prefix">left_</param>' in urdf


def test_a_prefix_from_both_is_reported(tmp_path):
    pytest.importorskip("xacro")
    urdf, messages = mounted(tmp_path, XACRO, ", with: {tf_prefix: left_}")
    assert '<sensor name="left_left_tcp_fts_sensor">' in urdf
    assert messages == [
        "'tf_prefix' of hardware 'left_ur' stays 'left_', but its sensor 'left_tcp_fts_sensor' gets the prefix; "
        "its names have it already: use this file with 'prefix: \"\"'"
    ]


@pytest.mark.parametrize(("value", "final"), [('""', '"left_"'), ("tcp_", "left_tcp_"), ("tcp", "left_tcp")])
def test_the_offered_value_keeps_what_the_vendor_wrote_around_it(value: str, final: str, tmp_path):
    _, [message] = mounted(tmp_path, URDF.replace("VALUE", value), "")
    assert f"change it to '{final}' by" in message


@pytest.mark.parametrize("name", ["P", "192.168.1.2", "tf_prefix"])
def test_a_prefix_of_other_things_is_not_reported(name: str, tmp_path):
    _, messages = mounted(tmp_path, URDF.replace("VALUE", name), "")
    assert not messages


@pytest.mark.parametrize("key", ["topic_prefix", "namespace_prefix", "prefixes", "ip"])
def test_other_parameters_may_be_empty(key: str, tmp_path):
    _, messages = mounted(tmp_path, URDF.replace("VALUE", "").replace("tf_prefix", key), "")
    assert not messages


def test_the_prefix_of_an_expression_is_not_reported_where_names_begin_alike(tmp_path):
    (tmp_path / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nlinks: {base: }\nros2_control:\n  ur:\n    type: sensor\n    hardware_plugin: d/A\n"
        "    parameters: {tf_prefix: $(prefix)}\n    sensors: {left_force: {state_interfaces: [force.x]}}\n"
    )
    spec = tmp_path / "cell.robot.yaml"
    spec.write_text("linkforge: 1\nname: c\nlinks: {table: }\nmodules: {left: {use: arm.robot.yaml, parent: table}}\n")
    assert "LF5706" not in {one.code.id for one in compile_file(spec).diagnostics}
