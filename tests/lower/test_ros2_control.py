"""ros2_control and transmissions: hardware by name, with what it moves, reads and switches."""

from linkforge_compile.core import Interface, Ros2Control, Transmission
from tests.lower.specs import robot_of

ARM = """
    name: arm
    links: {{base: , upper: }}
    joints: {{shoulder: {{type: continuous, parent: base, child: upper, axis: z}}}}
    {}
"""


def control(fields: str) -> Ros2Control:
    return robot_of(ARM.format(f"ros2_control: {{arm: {{hardware_plugin: arm/System, {fields}}}}}")).ros2_control("arm")


def transmission(fields: str) -> Transmission:
    return robot_of(ARM.format(f"transmissions: {{one: {{type: gears/Gears, {fields}}}}}")).transmission("one")


def test_interfaces_are_names_until_one_has_parameters():
    [joint] = control(
        "joints: {shoulder: {command_interfaces: {position: {min: -1.50, max: 1.50}, effort: }, "
        "state_interfaces: [position, 1.0]}}"
    ).joints
    position = Interface("position", {"min": "-1.50", "max": "1.50"})
    assert joint.command_interfaces == (position, "effort")
    assert joint.state_interfaces == ("position", "1.0")


def test_a_block_is_a_system_by_default():
    assert control("joints: {shoulder: {state_interfaces: [position]}}").type == "system"
    assert control("type: sensor, sensors: {tcp: {state_interfaces: [force.x]}}").type == "sensor"


def test_gpios_and_sensors_are_names_of_the_hardware():
    arm = control("gpios: {flange: {command_interfaces: [vacuum]}}, sensors: {tcp: {parameters: {frame: tool}}}")
    assert arm.gpios[0].command_interfaces == ("vacuum",)
    assert arm.sensors[0].parameters == {"frame": "tool"}


def test_a_transmission_moves_joints_by_actuators():
    gears = transmission(
        "joints: {shoulder: {hardware_interfaces: [effort], mechanical_reduction: -50, offset: 1 rad}}, "
        "actuators: {motor: }, parameters: {role: {_kind: a, ratio: 1.0}}"
    )
    [joint], [actuator] = gears.joints, gears.actuators
    assert (joint.hardware_interfaces, joint.mechanical_reduction, joint.offset) == (("effort",), -50, 1)
    assert (actuator.hardware_interfaces, actuator.mechanical_reduction) == (("position",), None)
    assert gears.parameters == {"role": {"_kind": "a", "ratio": "1.0"}}


def test_a_dropped_part_causes_no_further_report():
    robot = robot_of("""
        name: arm
        links: {base: , upper: }
        joints: {shoulder: {type: continuous, parent: base, child: upper, axis: z}}
        transmissions:
          one:
            type: transmission_interface/SimpleTransmission
            joints: {shoulder: 3}   # E[LF5001]:24 transmission joint 'shoulder' takes a map, found 3
            actuators: {motor: 3}   # E[LF5001]:24 transmission actuator 'motor' takes a map, found 3
        ros2_control:
          brake:
            type: actuator
            hardware_plugin: brake/Actuator
            joints: {shoulder: 3}   # E[LF5001]:24 ros2_control joint 'shoulder' takes a map, found 3
    """)
    assert not robot.transmissions
    assert not robot.ros2_controls
