"""Joints and transmissions that are alike but for a part of their names."""

from pathlib import Path

from tests.migration.migrated import migrated

JOINTS = "".join(
    f'<link name="arm_{name}_link"/><joint name="arm_{name}" type="continuous">'
    f'<parent link="base"/><child link="arm_{name}_link"/><axis xyz="0 0 1"/></joint>'
    for name in ("A1", "A2", "A3")
)
INTERFACES = """
<command_interface name="position">
  <param name="min">-${limits['A1'].upper}</param>
  <param name="max">${limits['A1']['upper']}</param>
</command_interface>
<!-- of the encoder -->
<state_interface name="position"/>
<param name="topic">/arm/A1/state</param>
"""


def _control(*joints: str) -> str:
    return f"""
<xacro:property name="limits" value="${{xacro.load_yaml('limits.yaml')}}"/>
<link name="base"/>
{JOINTS}
<ros2_control name="arm" type="system">
  <hardware><plugin>p/P</plugin></hardware>
  {"".join(joints)}
</ros2_control>
"""


def _joint(name: str, interfaces: str = INTERFACES) -> str:
    return f'<joint name="arm_{name}">{interfaces.replace("A1", name)}</joint>'


def _limits(folder: Path) -> None:
    (folder / "limits.yaml").write_text("A1: {upper: 1.5}\nA2: {upper: 2.5}\nA3: {upper: 1.5}\n", "utf-8")


def test_joints_of_ros2_control_that_differ_in_a_word_are_one_entry(tmp_path: Path):
    _limits(tmp_path)
    made = migrated(tmp_path, _control(*map(_joint, ("A1", "A2", "A3"))))
    assert "    joints:\n      arm_$(each):\n        for: {each: [A1, A2, A3]}\n" in made.robot
    assert made.robot.count("limits[each].upper") == 2
    assert made.robot.count("# of the encoder") == 1
    assert made.robot.endswith("parameters: {topic: /arm/$(each)/state}\n")


def test_a_joint_with_another_value_stays_alone(tmp_path: Path):
    _limits(tmp_path)
    last = _joint("A3", INTERFACES.replace("/state", "/status"))
    made = migrated(tmp_path, _control(_joint("A1"), _joint("A2"), last))
    assert "each" not in made.robot
    assert "arm_A3:" in made.robot


def test_a_word_within_a_text_of_an_expression_stays(tmp_path: Path):
    _limits(tmp_path)
    within = INTERFACES.replace("/arm/A1/state", "${'A1 low' if low else 'A1 high'}")
    argument = '<xacro:arg name="low" default="true"/><xacro:property name="low" value="$(arg low)"/>'
    made = migrated(tmp_path, argument + _control(*(_joint(name, within) for name in ("A1", "A2", "A3"))))
    assert "each" not in made.robot
