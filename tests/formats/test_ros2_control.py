from linkforge_compile.core.models.ros2_control import (
    Interface,
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)
from tests.formats.inside import urdf, xml


def test_hardware_with_joints_sensors_and_gpios():
    arm = Ros2Control(
        "arm",
        "system",
        "mock_components/GenericSystem",
        [
            Ros2ControlJoint(
                "shoulder",
                [Interface("position", {"min": "-1", "max": "1.0"}), "velocity"],
                ["position"],
                {"acceleration": "007"},
            )
        ],
        [Ros2ControlSensor("wrist", ["force.x"], {"frame_id": "tool0"})],
        {"slowdown": "50.0", "calibrate": ""},
        gpios=[Ros2ControlGpio("flange", ["out1"], ["in1"])],
        extra_attributes=[("rw_rate", "500")],
        extra_elements=['<transmission name="t"><plugin>a/B</plugin></transmission>'],
    )
    assert urdf(ros2_controls=[arm]) == xml("""
        <ros2_control name="arm" type="system" rw_rate="500">
          <hardware>
            <plugin>mock_components/GenericSystem</plugin>
            <param name="slowdown">50.0</param>
            <param name="calibrate"/>
          </hardware>
          <joint name="shoulder">
            <command_interface name="position">
              <param name="min">-1</param>
              <param name="max">1.0</param>
            </command_interface>
            <command_interface name="velocity"/>
            <state_interface name="position"/>
            <param name="acceleration">007</param>
          </joint>
          <sensor name="wrist">
            <state_interface name="force.x"/>
            <param name="frame_id">tool0</param>
          </sensor>
          <gpio name="flange">
            <command_interface name="out1"/>
            <state_interface name="in1"/>
          </gpio>
          <transmission name="t">
            <plugin>a/B</plugin>
          </transmission>
        </ros2_control>
    """)
