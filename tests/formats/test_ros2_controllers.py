"""controllers.yaml, with the parameters that the controller manager and the packages of ros2_controllers declare."""

from pathlib import Path

import pytest
import yaml

from linkforge_compile import compile_file, compile_text
from linkforge_compile.core.models.controller import Controller
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.export_spec import write_spec
from linkforge_compile.formats import ROS2_CONTROLLERS, Rendering
from tests.conftest import ROOT
from tests.ros_parameters import nodes_in, require_declared

CASE = ROOT / "tests" / "cases" / "good" / "planning" / "planning.robot.yaml"
GOLDEN = CASE.with_name("planning_controllers.yaml")

EXAMPLE = ROOT / "examples" / "09_mobile_manipulator" / "mobile_manipulator.robot.yaml"

MANAGER = {"update_rate": "int", r"\w+\.type": "string"}
GRIPPER = {
    "joint": "string",
    "state_interfaces": "string_array",
    "(max_effort|max_velocity|goal_tolerance|stall_timeout|stall_velocity_threshold|action_monitor_rate)": "double",
    "allow_stalling": "bool",
}
DECLARED = {
    "joint_trajectory_controller/JointTrajectoryController": {
        "joints|command_interfaces|state_interfaces|command_joints": "string_array",
        r"constraints\.(goal_time|stopped_velocity_tolerance)": "double",
        r"constraints\.\w+\.(trajectory|goal|max_deceleration_on_cancel)": "double",
        r"gains\.\w+\.(p|i|d|ff_velocity_scale)": "double",
        "action_monitor_rate|cmd_timeout": "double",
        "allow_(partial_joints_goal|nonzero_velocity_at_trajectory_end)": "bool",
        "interpolation_method": "string",
    },
    "forward_command_controller/ForwardCommandController": {"joints": "string_array", "interface_name": "string"},
    "position_controllers/JointGroupPositionController": {"joints": "string_array"},
    "parallel_gripper_action_controller/GripperActionController": GRIPPER,
    "joint_state_broadcaster/JointStateBroadcaster": {
        "joints|interfaces|extra_joints": "string_array",
        "use_local_topics|use_urdf_to_filter": "bool",
        "frame_id": "string",
    },
    "imu_sensor_broadcaster/IMUSensorBroadcaster": {
        "sensor_name|frame_id": "string",
        "static_covariance_(orientation|angular_velocity|linear_acceleration)": "double_array",
    },
    "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster": {"sensor_name|frame_id": "string"},
    "diff_drive_controller/DiffDriveController": {
        "(left|right)_wheel_names": "string_array",
        "wheel_separation|wheel_radius|cmd_vel_timeout": "double",
        "(pose|twist)_covariance_diagonal": "double_array",
        "open_loop|position_feedback|enable_odom_tf": "bool",
        "odom_frame_id|base_frame_id": "string",
        "velocity_rolling_window_size": "int",
        r"(linear\.x|angular\.z)\.(max|min)_(velocity|jerk)": "double",
        r"(linear\.x|angular\.z)\.max_(acceleration|deceleration)(_reverse)?": "double",
    },
}

LINK = "{inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}"
LIMITS = "{lower: 0, upper: 1, effort: 1, velocity: 1}"
ROBOT = f"""
links: {{base: , upper: &link {LINK}, lower: *link, left_wheel: *link, right_wheel: *link}}
joints:
  shoulder: {{type: revolute, parent: base, child: upper, axis: y, limits: {LIMITS}}}
  elbow: {{type: revolute, parent: upper, child: lower, axis: y, limits: {LIMITS}}}
  left: {{type: continuous, parent: base, child: left_wheel, axis: y}}
  right: {{type: continuous, parent: base, child: right_wheel, axis: y}}
ros2_control:
  all:
    hardware_plugin: mock_components/GenericSystem
    joints:
      shoulder: {{command_interfaces: [velocity, position], state_interfaces: [velocity, position, effort]}}
      elbow: {{command_interfaces: [position], state_interfaces: [position, velocity]}}
      left: &wheel {{command_interfaces: [velocity], state_interfaces: [position, velocity]}}
      right: *wheel
    sensors: {{imu: {{state_interfaces: [orientation.x]}}, wrench: {{state_interfaces: [force.x]}}}}
"""
ARM_GROUP = "semantic: {groups: {arm: {chain: {base_link: base, tip_link: lower}}}}\n"


def robot_of(text: str):
    compilation = compile_text(f"linkforge: 1\nname: robot\n{text}")
    assert compilation.robot is not None, compilation.diagnostics
    return compilation.robot


def rendered(text: str) -> str:
    return ROS2_CONTROLLERS.render(robot_of(text), Rendering())[0].text


def reported(text: str) -> list[str]:
    return [f"{one.code.id} {one.message}" for one in group_alike(ROS2_CONTROLLERS.limits(robot_of(text), {}))]


def require_all_declared(text: str) -> None:
    """Hold the parameters of each node against those that its class declares."""
    nodes = nodes_in(text)
    manager = nodes.pop("controller_manager")
    require_declared(manager, MANAGER)
    for name, parameters in nodes.items():
        require_declared(parameters, DECLARED[str(manager[f"{name}.type"])])


def controller(name: str, text: str) -> dict[str, object]:
    parameters: dict[str, object] = yaml.safe_load(rendered(text))[name]["ros__parameters"]
    return parameters


@pytest.mark.parametrize(("spec", "golden"), [(CASE, GOLDEN), (EXAMPLE, EXAMPLE.with_name("controllers.yaml"))])
def test_a_spec_compiles_to_the_file_next_to_it(spec: Path, golden: Path, update_golden: bool):
    robot = compile_file(spec).result()
    assert not tuple(ROS2_CONTROLLERS.limits(robot, {}))
    banner = f"Compiled by linkforge from {spec.name}; edit that file, not this one."
    text = ROS2_CONTROLLERS.render(robot, Rendering(banner=banner))[0].text
    if update_golden:
        golden.write_text(text, "utf-8")
    assert text == golden.read_text("utf-8")
    require_all_declared(text)


def test_groups_of_groups_have_no_controller_in_place_of_their_groups():
    groups = "all: {subgroups: [lower, upper]}, lower: {joints: [elbow]}, upper: {joints: [shoulder]}"
    written = yaml.safe_load(rendered(f"{ROBOT}semantic: {{groups: {{{groups}}}}}\n"))
    assert [name for name in written if name != "controller_manager"] == ["lower_controller", "upper_controller"]


def test_without_the_section_each_group_with_joints_of_its_own_has_a_controller():
    groups = "semantic: {groups: {arm: {chain: {base_link: base, tip_link: lower}}, tip: {joints: [elbow]}}}\n"
    written = yaml.safe_load(rendered(ROBOT + groups))
    assert list(written["controller_manager"]["ros__parameters"]) == [
        "update_rate",
        "joint_state_broadcaster",
        "arm_controller",
    ]
    assert written["arm_controller"]["ros__parameters"] == {
        "joints": ["shoulder", "elbow"],
        "command_interfaces": ["position"],
        "state_interfaces": ["position", "velocity"],
    }
    assert reported(ROBOT + groups) == ["LF7607 no controller commands joint 'left'; the same for 'right'"]


def test_each_class_gets_its_own_names_of_parameters():
    text = f"""{ROBOT}{ARM_GROUP}
controllers:
  states: {{type: joint_state_broadcaster/JointStateBroadcaster, joints: [elbow], state_interfaces: [position]}}
  forward: {{type: forward_command_controller/ForwardCommandController, group: arm}}
  base:
    type: diff_drive_controller/DiffDriveController
    left_wheels: [left]
    right_wheels: [right]
    parameters:
      wheel_separation: 400 mm
      wheel_radius: 1
      velocity_rolling_window_size: 5
      open_loop: true
      pose_covariance_diagonal: [0.001, 1, 0, 0, 0, 0]
      linear: {{x: {{max_velocity: 1, max_acceleration: 2.5}}}}
  imu: {{type: imu_sensor_broadcaster/IMUSensorBroadcaster, sensor: imu, frame: upper}}
  wrench: {{type: force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster, sensor: wrench, frame: lower}}
  grip:
    type: parallel_gripper_action_controller/GripperActionController
    joints: [elbow]
    parameters: {{max_effort: 5}}
"""
    assert reported(text) == []
    require_all_declared(rendered(text))
    assert controller("forward", text) == {"joints": ["shoulder", "elbow"], "interface_name": "position"}
    assert controller("base", text)["wheel_separation"] == 0.4
    assert controller("imu", text) == {"sensor_name": "imu", "frame_id": "upper"}
    assert controller("states", text) == {"joints": ["elbow"], "interfaces": ["position"]}


@pytest.mark.parametrize("name", ["y", "inf", "NaN", "-Infinity", "NAN", "0x1p3", "0x.8", "1e3", "017"])
def test_a_joint_whose_name_ros_takes_for_a_number_stays_text(name: str):
    text = ROBOT.replace("elbow:", f"'{name}':")
    text += f"controllers: {{own: {{type: a/B, joints: [shoulder, '{name}']}}}}\n"
    assert nodes_in(rendered(text))["own"] == {"joints": ["shoulder", name]}


def test_parameters_of_another_class_keep_their_types():
    text = f"""{ROBOT}
controllers:
  own:
    type: my_package/Own
    joints: [elbow]
    parameters:
      {{count: 1, gain: 1.0, small: 1e-7, name: '1', text: yes, list: [1, 2], mixed: [1, 2.5], nothing: , empty: {{}}}}
"""
    assert controller("own", text) == {
        "joints": ["elbow"],
        "count": 1,
        "gain": 1.0,
        "small": 1e-7,
        "name": "1",
        "text": "yes",
        "list": [1, 2],
        "mixed": [1.0, 2.5],
    }
    assert type(controller("own", text)["gain"]) is float
    again = compile_text(write_spec(robot_of(text))).result()
    assert ROS2_CONTROLLERS.render(again, Rendering()) == ROS2_CONTROLLERS.render(robot_of(text), Rendering())


def test_the_manager_has_parameters_and_no_type():
    text = f"{ROBOT}controllers: {{controller_manager: {{parameters: {{update_rate: 500}}}}}}\n"
    manager = yaml.safe_load(rendered(text))["controller_manager"]["ros__parameters"]
    assert manager["update_rate"] == 500
    assert "joint_trajectory_controller" in manager


def test_a_prefix_is_on_the_controller_and_all_that_it_names():
    part = Controller("arm", "a/B", "g", ["j"], ["l"], ["r"], "imu", "tool", ["position"], parameters={"joint": "j"})
    assert part.with_prefix("x_") == Controller(
        "x_arm", "a/B", "x_g", ["x_j"], ["x_l"], ["x_r"], "x_imu", "x_tool", ["position"], parameters={"joint": "j"}
    )
    manager = Controller("controller_manager", parameters={"update_rate": 1})
    assert manager.with_prefix("x_") is manager


@pytest.mark.parametrize(
    ("controllers", "message"),
    [
        (
            "base: {type: diff_drive_controller/DiffDriveController, left_wheels: [left], right_wheels: [right], "
            "parameters: {wheel_radius: 0.1}}, arm: {type: a/B, group: arm}",
            "LF7604 controller 'base' of type diff_drive_controller/DiffDriveController does not start without "
            "`wheel_separation` in `parameters`",
        ),
        (
            "ft: {type: force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster, frame: upper}, o: {type: a/B}",
            "LF7604 controller 'ft' of type force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster does not "
            "start without `sensor`",
        ),
        (
            "g: {type: position_controllers/JointGroupPositionController, joints: [elbow], "
            "state_interfaces: [position]}, o: {type: a/B}",
            "LF7605 a position_controllers/JointGroupPositionController has no 'state_interfaces'; that of 'g' is left "
            "out",
        ),
    ],
)
def test_what_a_class_needs_or_lacks_is_reported(controllers: str, message: str):
    assert reported(f"{ROBOT}{ARM_GROUP}controllers: {{{controllers}}}\n") == [message]


def test_a_joint_without_command_interface_is_reported():
    text = ROBOT.replace("elbow: {command_interfaces: [position], ", "elbow: {")
    trajectory = "{type: joint_trajectory_controller/JointTrajectoryController, joints: [shoulder, elbow]}"
    text += f"controllers: {{t: {trajectory}, o: {{type: a/B}}}}\n"
    assert reported(text) == [
        "LF7606 controller 't' does not start: joint 'elbow' has no command interface in `ros2_control`"
    ]


def test_a_robot_without_hardware_has_no_controllers():
    diagnostic = ROS2_CONTROLLERS.missing(robot_of("links: {base: }"))
    assert diagnostic is not None
    assert diagnostic.code.id == "LF7603"


def test_names_of_joints_groups_and_frames_are_checked():
    text = f"linkforge: 1\nname: robot\n{ROBOT}{ARM_GROUP}"
    text += "controllers: {o: {type: a/B, joints: [elbo], group: amr, frame: uper}}\n"
    assert [(one.code.id, one.span.text) for one in compile_text(text).diagnostics if one.span] == [
        ("LF4103", "elbo"),
        ("LF4104", "amr"),
        ("LF4102", "uper"),
    ]


def test_each_line_leads_to_its_place_in_the_spec():
    text = f"linkforge: 1\nname: robot\n{ROBOT}controllers:\n  own:\n    type: a/B\n    parameters: {{pid: {{p: 4}}}}\n"
    document = ROS2_CONTROLLERS.render(compile_text(text).result(), Rendering(has_map=True))[0]
    assert document.map is not None
    shown = {}
    for number, line in enumerate(document.text.splitlines(), start=1):
        if place := document.map.at(number):
            shown[line.strip()] = place.span.text
    assert shown["own:"] == "own"
    assert shown["type: a/B"] == "a/B"
    assert shown["p: 4"] == "4"


def test_names_in_parameters_are_reported_under_a_prefix(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(
        f"linkforge: 1\nname: arm\n{ROBOT}controllers:\n  own:\n    type: a/B\n"
        "    parameters: {gains: {elbow: {p: 1}, $(joint('shoulder')): {p: 2}}, tip: lower}\n"
    )
    both = tmp_path / "both.robot.yaml"
    both.write_text(
        "linkforge: 1\nname: both\nlinks: {table: }\nmodules: {arm: {use: arm.robot.yaml, parent: table, prefix: l_}}\n"
    )
    compilation = compile_file(both)
    found = [(one.code.id, one.span.text) for one in compilation.diagnostics if one.span]
    assert found == [("LF5704", "elbow"), ("LF5704", "lower")]
    written = yaml.safe_load(ROS2_CONTROLLERS.render(compilation.result(), Rendering())[0].text)
    assert list(written["l_own"]["ros__parameters"]["gains"]) == ["elbow", "l_shoulder"]
