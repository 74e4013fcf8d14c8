"""controllers.yaml, with the parameters that the controller manager and the packages of ros2_controllers declare."""

from pathlib import Path

import pytest
import yaml

from linkforge_compile import compile_file, compile_text
from linkforge_compile.core.models.controller import Controller
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.export_spec import write_spec
from linkforge_compile.formats import ROS2_CONTROLLERS, Rendering
from tests.cli.in_process import linkforge
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
ARM_GROUP = "semantic: {groups: {arm: {chain: {base_link: base, tip_link: lower}}, fixed: {links: [base]}}}\n"
TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
POSITIONS = "position_controllers/JointGroupPositionController"
FORWARD = "forward_command_controller/ForwardCommandController"


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
            "start without `sensor` or `interface_names` in `parameters`",
        ),
        (
            "g: {type: position_controllers/JointGroupPositionController, joints: [elbow], "
            "state_interfaces: [position]}, o: {type: a/B}",
            "LF7605 a position_controllers/JointGroupPositionController has no 'state_interfaces'; omitted for 'g'",
        ),
        (
            "t: {type: joint_trajectory_controller/JointTrajectoryController, group: fixed}, o: {type: a/B}",
            f"LF7604 controller 't' of type {TRAJECTORY} does not start without `joints`; no joint of group 'fixed' "
            "has a command interface in `ros2_control`",
        ),
        (
            "t: {type: joint_trajectory_controller/JointTrajectoryController, joints: [elbow, left]}, o: {type: a/B}",
            f"LF7604 controller 't' of type {TRAJECTORY} does not start without `command_interfaces`; its joints have "
            "none in common",
        ),
    ],
)
def test_what_a_class_needs_or_lacks_is_reported(controllers: str, message: str):
    assert reported(f"{ROBOT}{ARM_GROUP}controllers: {{{controllers}}}\n") == [message]


MANAGER_AND = "controller_manager: {{parameters: {{{}}}}}, o: {{type: a/B}}"
TRAJECTORY_WITH = (
    "t: {{type: joint_trajectory_controller/JointTrajectoryController, joints: [shoulder, elbow], "
    "parameters: {{{}}}}}, o: {{type: a/B}}"
)
OF_TRAJECTORIES = f"a {TRAJECTORY}"


@pytest.mark.parametrize(
    ("controllers", "parameters", "message"),
    [
        (
            MANAGER_AND,
            "update_rate: 500 Hz",
            "LF7612 'update_rate' of the controller manager accepts a whole number without a unit, found '500 Hz'",
        ),
        (
            MANAGER_AND,
            "update_rate: 500.0",
            "LF7612 'update_rate' of the controller manager accepts a whole number without a unit, found 500.0",
        ),
        (
            MANAGER_AND,
            "update_rates: 500",
            "LF7611 the controller manager has no parameter 'update_rates'; did you mean 'update_rate'?",
        ),
        (
            TRAJECTORY_WITH,
            "constraints: {goal_time: fast}",
            f"LF7612 'constraints.goal_time' of {OF_TRAJECTORIES} accepts a number, found 'fast'",
        ),
        (
            TRAJECTORY_WITH,
            "constraints: {stopped_velocity_tolerance: true}",
            f"LF7612 'constraints.stopped_velocity_tolerance' of {OF_TRAJECTORIES} accepts a number, found true",
        ),
        (
            TRAJECTORY_WITH,
            "constraints: 0.5",
            f"LF7612 'constraints' of {OF_TRAJECTORIES} accepts a map of parameters, found 0.5",
        ),
        (
            TRAJECTORY_WITH,
            "constraints: {goal_tme: 1}",
            f"LF7611 {OF_TRAJECTORIES} has no parameter 'goal_tme' in 'constraints'; did you mean 'goal_time'?",
        ),
        (
            TRAJECTORY_WITH,
            "constraints: {shouldr: {goal: 1}}",
            f"LF7611 {OF_TRAJECTORIES} has no parameter 'shouldr' in 'constraints'; did you mean 'shoulder'?",
        ),
    ],
)
def test_parameters_that_a_class_does_not_declare_are_reported(controllers: str, parameters: str, message: str):
    assert reported(f"{ROBOT}controllers: {{{controllers.format(parameters)}}}\n") == [message]


def test_declared_parameters_have_the_types_that_their_class_declares():
    text = f"""{ROBOT}
controllers:
  controller_manager:
    parameters:
      update_rate: 500
      diagnostics: {{threshold: {{controllers: {{periodicity: {{mean_error: {{warn: 5}}}}}}}}}}
      arm: {{fallback_controllers: [o]}}
      loaded_later: {{type: a/B, params_file: later.yaml}}
  arm:
    type: joint_trajectory_controller/JointTrajectoryController
    joints: [shoulder]
    parameters:
      update_rate: 50
      constraints.goal_time: 1
      constraints: {{shoulder: {{goal: 10 mm, trajectory: 1}}}}
      gains: {{shoulder: {{p: 100, antiwindup_strategy: none, angle_wraparound: true}}}}
  o: {{type: a/B, parameters: {{any: 1}}}}
"""
    assert reported(text) == []
    written = controller("arm", text)
    assert written["update_rate"] == 50
    assert type(written["update_rate"]) is int
    assert written["constraints"] == {"goal_time": 1.0, "shoulder": {"goal": 0.01, "trajectory": 1.0}}
    assert type(written["constraints"]["goal_time"]) is float
    assert type(written["gains"]["shoulder"]["p"]) is float
    manager = controller("controller_manager", text)
    assert type(manager["diagnostics"]["threshold"]["controllers"]["periodicity"]["mean_error"]["warn"]) is float


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        (
            "joints: [shoulder], parameters: {joints: [other]}",
            "LF7621 controller 'c' has 'joints' in `parameters`, and `joints` for the same; remove one of them",
        ),
        (
            "group: arm, parameters: {joints: [shoulder]}",
            "LF7621 controller 'c' has 'joints' in `parameters`, and `group` for the same; remove one of them",
        ),
        (
            "sensor: imu, parameters: {sensor_name: wrench}",
            "LF7621 controller 'c' has 'sensor_name' in `parameters`, and `sensor` for the same; remove one of them",
        ),
        ("parameters: {joints: [other], list: [1, 2.5], texts: ['1', a], flags: [true, false]}", ""),
    ],
)
def test_what_a_field_states_is_no_parameter_as_well(fields: str, message: str):
    text = f"{ROBOT}{ARM_GROUP}controllers: {{c: {{type: a/B, {fields}}}}}\n"
    assert reported(text) == [message] * bool(message)


@pytest.mark.parametrize(
    ("controller", "message"),
    [
        (
            "{type: forward_command_controller/ForwardCommandController, joints: [shoulder], "
            "command_interfaces: [position, velocity]}",
            "LF7622 a forward_command_controller/ForwardCommandController accepts one name in 'command_interfaces'; "
            "'velocity' of 'c' is omitted",
        ),
        (
            "{type: parallel_gripper_action_controller/GripperActionController, group: arm}",
            "LF7622 a parallel_gripper_action_controller/GripperActionController accepts one name in 'joints'; "
            "'elbow' of 'c' is omitted",
        ),
    ],
)
def test_items_that_are_not_written_are_reported(controller: str, message: str):
    assert reported(f"{ROBOT}{ARM_GROUP}controllers: {{c: {controller}, o: {{type: a/B}}}}\n") == [message]


@pytest.mark.parametrize("items", ["[1, a]", "[true, 1]", "[[1], [2]]", "[{a: 1}]", "[null]"])
@pytest.mark.parametrize("name", ["c", "controller_manager"])
def test_a_list_that_ros_refuses_is_an_error(items: str, name: str):
    type_ = "type: a/B, " if name == "c" else ""
    own = f"{{{type_}parameters: {{qos_overrides: {{list: {items}}}}}}}"
    text = f"{ROBOT}controllers: {{o: {{type: a/B}}, {name}: {own}}}\n"
    assert reported(text) == [
        f"LF7623 ROS 2 refuses a parameter file with this list, 'qos_overrides.list' of '{name}': items must be "
        "all numbers, all strings or all booleans"
    ]


@pytest.mark.parametrize(("name", "is_valid"), [("arm_2", True), ("arm-2", False), ("2_arms", False), ("a/b", False)])
def test_the_name_of_a_controller_is_that_of_a_node(name: str, is_valid: bool):
    found = reported(f"{ROBOT}controllers: {{{name}: {{type: a/B}}}}\n")
    assert [one[:6] for one in found] == ["LF7624"] * (not is_valid)


def test_a_force_torque_sensor_may_have_the_names_of_its_interfaces_instead():
    type_ = "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster"
    names = "{interface_names: {force: {x: wrench/force.x}}}"
    text = f"{ROBOT}controllers: {{ft: {{type: {type_}, frame: upper, parameters: {names}}}, o: {{type: a/B}}}}\n"
    assert reported(text) == []


def test_a_list_that_ros_refuses_is_one_error():
    type_ = "joint_trajectory_controller/JointTrajectoryController"
    own = f"{{type: {type_}, group: arm, parameters: {{command_joints: [1, a]}}}}"
    found = reported(f"{ROBOT}{ARM_GROUP}controllers: {{c: {own}, o: {{type: a/B}}}}\n")
    assert [one[:6] for one in found] == ["LF7623"]


@pytest.mark.parametrize("name", ["c", "controller_manager"])
def test_a_list_with_a_faulty_item_is_one_error(tmp_path: Path, name: str):
    type_ = "type: a/B, " if name == "c" else ""
    own = f"{{{type_}parameters: {{qos_overrides: {{list: [1, $(nix)]}}}}}}"
    text = f"linkforge: 1\nname: robot\n{ROBOT}controllers: {{o: {{type: a/B}}, {name}: {own}}}\n"
    (tmp_path / "robot.robot.yaml").write_text(text)
    run = linkforge("compile", "robot.robot.yaml", "--format", "ros2_controllers", "-o", "-", cwd=tmp_path)
    assert "[LF3107]" in run.stderr
    assert run.stderr.count("error: ") == 1


@pytest.mark.parametrize(
    ("in_parameters", "in_fields"),
    [
        (f"type: {POSITIONS}, parameters: {{joints: [elbow, left]}}", f"type: {POSITIONS}, joints: [elbow, left]"),
        (
            f"type: {FORWARD}, group: arm, parameters: {{interface_name: effort}}",
            f"type: {FORWARD}, group: arm, command_interfaces: [effort]",
        ),
        (
            "type: effort_controllers/GripperActionController, parameters: {joint: elbow, max_effort: 1}",
            "type: effort_controllers/GripperActionController, joints: [elbow], parameters: {max_effort: 1}",
        ),
        (
            f"type: {TRAJECTORY}, group: arm, parameters: {{state_interfaces: [position, effort]}}",
            f"type: {TRAJECTORY}, group: arm, state_interfaces: [position, effort]",
        ),
    ],
)
def test_a_parameter_of_a_field_is_checked_as_that_field(in_parameters: str, in_fields: str):
    start = f"{ROBOT}{ARM_GROUP}controllers: {{o: {{type: a/B}}, c: "
    found = reported(f"{start}{{{in_parameters}}}}}\n")
    assert found == reported(f"{start}{{{in_fields}}}}}\n")
    assert found
    assert controller("c", f"{start}{{{in_parameters}}}}}\n") == controller("c", f"{start}{{{in_fields}}}}}\n")


def test_joints_in_parameters_of_other_classes_of_ros2_controllers_are_checked():
    parameters = "{joints: [elbwo], frame_id: world, gpios: [a]}"
    own = f"{{type: admittance_controller/AdmittanceController, parameters: {parameters}}}"
    text = f"linkforge: 1\nname: robot\n{ROBOT}controllers: {{own: {own}, o: {{type: a/B}}}}\n"
    found = [(one.code.id, one.span.text) for one in compile_text(text).diagnostics if one.span]
    assert found == [("LF4103", "elbwo")]


def test_joints_in_parameters_are_commanded():
    own = f"{{type: {POSITIONS}, parameters: {{joints: [shoulder, elbow]}}}}"
    assert reported(f"{ROBOT}controllers: {{c: {own}}}\n") == [
        "LF7607 no controller commands joint 'left'; the same for 'right'"
    ]


def test_names_in_parameters_of_fields_are_checked_at_their_place():
    imu = "type: imu_sensor_broadcaster/IMUSensorBroadcaster, parameters: {sensor_name: imv, frame_id: uper}"
    text = f"linkforge: 1\nname: robot\n{ROBOT}controllers:\n  i: {{{imu}}}\n"
    text += f"  j: {{type: {POSITIONS}, parameters: {{joints: [shoulder, elbo]}}}}\n"
    compilation = compile_text(text, formats=("ros2_controllers",))
    assert [(one.code.id, one.span.text) for one in compilation.diagnostics if one.span] == [
        ("LF4110", "imv"),
        ("LF4102", "uper"),
        ("LF4103", "elbo"),
    ]


@pytest.mark.parametrize(("name", "codes"), [("elbow", ["LF5704"]), ("$(joint('elbow'))", []), ("elbo", ["LF4103"])])
def test_a_name_in_parameters_of_a_field_is_one_fault_under_a_prefix(tmp_path: Path, name: str, codes: list[str]):
    own = f"controllers: {{c: {{type: {POSITIONS}, parameters: {{joints: [{name}]}}}}}}\n"
    (tmp_path / "arm.robot.yaml").write_text(f"linkforge: 1\nname: arm\n{ROBOT}{own}")
    module = "{use: arm.robot.yaml, parent: table, prefix: l_}"
    both = tmp_path / "both.robot.yaml"
    both.write_text(f"linkforge: 1\nname: both\nlinks: {{table: }}\nmodules: {{arm: {module}}}\n")
    diagnostics = compile_file(both, formats=("ros2_controllers",)).diagnostics
    assert [one.code.id for one in diagnostics if one.code.id != "LF7607"] == codes


def test_a_misspelled_class_and_a_wrong_group_are_reported_in_one_run():
    text = f"linkforge: 1\nname: robot\n{ROBOT}{ARM_GROUP}"
    other = f"{{type: {POSITIONS}, joints: [$(joint('elbow'))]}}"
    text += f"controllers: {{c: {{type: {TRAJECTORY}s, group: amr}}, d: {other}}}\n"
    found = compile_text(text, formats=("ros2_controllers",)).diagnostics
    assert sorted(one.code.id for one in found) == ["LF3091", "LF4104", "LF7613"]


def test_a_broadcaster_commands_no_joint():
    states = "{type: joint_state_broadcaster/JointStateBroadcaster, joints: [shoulder, elbow, left, right]}"
    arm = "{type: position_controllers/JointGroupPositionController, joints: [shoulder, elbow]}"
    assert reported(f"{ROBOT}controllers: {{states: {states}, arm: {arm}}}\n") == [
        "LF7607 no controller commands joint 'left'; the same for 'right'"
    ]


def test_a_joint_without_command_interface_is_reported():
    text = ROBOT.replace("elbow: {command_interfaces: [position], ", "elbow: {")
    trajectory = "{type: joint_trajectory_controller/JointTrajectoryController, joints: [shoulder, elbow]}"
    text += f"controllers: {{t: {trajectory}, o: {{type: a/B}}}}\n"
    assert reported(text) == [
        "LF7606 controller 't' does not start: joint 'elbow' has no command interface in `ros2_control`"
    ]


@pytest.mark.parametrize(
    ("controllers", "messages"),
    [
        (
            "t: {type: joint_trajectory_controller/JointTrajectoryController, joints: [shoulder, elbow], "
            "command_interfaces: [velocity], state_interfaces: [position, effrt], "
            "parameters: {gains: {shoulder: {p: 1}, elbow: {p: 1}}}}",
            [
                "LF7606 controller 't' does not start: joint 'elbow' has no command interface 'velocity' in "
                "`ros2_control`",
                "LF7606 controller 't' does not start: joint 'shoulder' has no state interface 'effrt' in "
                "`ros2_control`; did you mean 'effort'?; the same for 'elbow'",
            ],
        ),
        (
            "g: {type: effort_controllers/GripperActionController, joints: [elbow]}",
            ["LF7606 controller 'g' does not start: joint 'elbow' has no command interface 'effort' in `ros2_control`"],
        ),
        (
            "g: {type: velocity_controllers/JointGroupVelocityController, group: arm}",
            [
                "LF7606 controller 'g' does not start: joint 'elbow' has no command interface 'velocity' in "
                "`ros2_control`"
            ],
        ),
        (
            "t: {type: joint_trajectory_controller/JointTrajectoryController, joints: [elbow], "
            "command_interfaces: [effort], parameters: {command_joints: [pid/elbow], gains: {elbow: {p: 1}}}}",
            [],
        ),
    ],
)
def test_interfaces_that_joints_do_not_have_are_reported(controllers: str, messages: list[str]):
    assert reported(f"{ROBOT}{ARM_GROUP}controllers: {{{controllers}, o: {{type: a/B}}}}\n") == messages


@pytest.mark.parametrize(
    ("group", "controllers", "code"),
    [
        ("base_link: base, tip_link: lower", "group: amr", "LF4104"),
        ("base_link: base, tip_link: lower", "joints: [elbo]", "LF4103"),
        ("base_link: base, tip_link: lowr", "group: arm", "LF4102"),
    ],
)
def test_what_follows_from_a_wrong_name_is_not_reported(group: str, controllers: str, code: str):
    trajectory = f"{{type: joint_trajectory_controller/JointTrajectoryController, {controllers}}}"
    text = f"{ROBOT}semantic: {{groups: {{arm: {{chain: {{{group}}}}}}}}}\ncontrollers: {{t: {trajectory}}}\n"
    compilation = compile_text(f"linkforge: 1\nname: robot\n{text}", formats=("moveit",))
    assert {one.code.id for one in compilation.diagnostics} - {"LF7601", "LF7615"} == {code}


def test_joints_that_nothing_moves_without_gains_are_reported():
    start = f"{ROBOT}controllers: {{o: {{type: a/B}}, t: {{type: {TRAJECTORY}, joints: [left, right], parameters: "
    assert reported(f"{start}{{gains: {{left: {{p: 1}}}}}}}}}}\n") == [
        "LF7614 controller 't' does not move joint 'right': it commands only velocity, and its `gains` are 0; write "
        "`right: {p: …}` in `gains` of its `parameters`"
    ]
    assert reported(f"{start}{{gains.left.p: 1.0, gains: {{right: {{ff_velocity_scale: 1}}}}}}}}}}\n") == []
    assert reported(f"{start}{{open_loop_control: true}}}}}}\n") == []


@pytest.mark.parametrize(
    ("controller", "codes"),
    [
        (f"type: {TRAJECTORY}, parameters: {{joints: shoulder}}", ["LF7612"]),
        (f"type: {TRAJECTORY}, parameters: {{joints: [shoulder, 1]}}", ["LF7623"]),
        (f"type: {TRAJECTORY}, parameters: {{joints: [shoulder, elbo]}}", ["LF4103"]),
        (f"type: {TRAJECTORY}, parameters: {{joints: [shoulder], command_interfaces: position}}", ["LF7612"]),
        (f"type: {TRAJECTORY}, joints: [$(joint('elbow'))]", ["LF3091"]),
        (f"type: {TRAJECTORY}, group: arm, left_wheels: [left]", ["LF7605"]),
        (f"type: {FORWARD}, group: arm, command_interfaces: [position, effort]", ["LF7622"]),
        ("type: position_controllers/GripperActionController, joints: [elbow, left]", ["LF7622"]),
        ("type: position_controllers/GripperActionController, joints: [elbow, elbo]", ["LF4103"]),
        ("type: position_controllers/GripperActionController, joints: [elbow, elbow]", ["LF4160"]),
    ],
)
def test_a_fault_of_a_controller_is_reported_once(controller: str, codes: list[str]):
    text = f"linkforge: 1\nname: robot\n{ROBOT}{ARM_GROUP}controllers: {{o: {{type: a/B}}, c: {{{controller}}}}}\n"
    assert [one.code.id for one in compile_text(text, formats=("ros2_controllers",)).diagnostics] == codes


@pytest.mark.parametrize(
    ("type_", "intended"),
    [
        ("joint_trajectory_controller/JointTrajectoryControler", TRAJECTORY),
        ("joint_trajectory_controler/JointTrajectoryController", TRAJECTORY),
        ("position_controllers/GripperActionControler", "position_controllers/GripperActionController"),
        ("gpio_controllers/GpioController", "gpio_controllers/GpioCommandController"),
        ("ur_controllers/ScaledJointTrajectoryController", None),
        ("my_joint_trajectory_controller/JointTrajectoryController", None),
        ("pid_controller/PidController", None),
    ],
)
def test_misspelled_classes_of_ros2_controllers_are_reported(type_: str, intended: str | None):
    expected = [f"LF7613 there is no controller class '{type_}'; did you mean '{intended}'?"] if intended else []
    assert reported(f"{ROBOT}controllers: {{o: {{type: {type_}}}}}\n") == expected


@pytest.mark.parametrize("manager", ["", "controllers: {controller_manager: {parameters: {update_rate: 50}}}"])
def test_a_robot_without_hardware_has_no_controllers(manager: str):
    diagnostic = ROS2_CONTROLLERS.missing(robot_of(f"links: {{base: }}\n{manager}\n"))
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
    text += "  controller_manager: {parameters: {update_rate: 500}}\n"
    document = ROS2_CONTROLLERS.render(compile_text(text).result(), Rendering(has_map=True))[0]
    assert document.map is not None
    shown = {}
    for number, line in enumerate(document.text.splitlines(), start=1):
        if place := document.map.at(number):
            shown[line.strip()] = place.span.text
    assert shown["own:"] == "own"
    assert shown["type: a/B"] == "a/B"
    assert shown["p: 4"] == "4"
    assert shown["update_rate: 500"] == "500"


ARM_WITH_MANAGER = f"""linkforge: 1
name: arm
{ROBOT}
controllers:
  hold: {{type: a/B}}
  move: {{type: a/B, joints: [elbow]}}
  controller_manager:
    parameters:
      update_rate: 500
      hardware_components_initial_state: {{inactive: [all], shutdown_on_initial_state_failure: false}}
      move: {{type: a/B, fallback_controllers: [hold]}}
      later.type: c/D
      later.fallback_controllers: [hold]
"""


def two_arms(folder: Path, own: str = "", of_right: str = "") -> Path:
    (folder / "arm.robot.yaml").write_text(ARM_WITH_MANAGER)
    (folder / "right.robot.yaml").write_text(of_right or ARM_WITH_MANAGER)
    both = folder / "both.robot.yaml"
    both.write_text(
        "linkforge: 1\nname: both\nlinks: {table: }\nmodules:\n"
        "  left: {use: arm.robot.yaml, parent: table, prefix: l_}\n"
        f"  right: {{use: right.robot.yaml, parent: table, prefix: r_}}\n{own}"
    )
    return both


def manager_of(spec: Path) -> dict[str, object]:
    return nodes_in(ROS2_CONTROLLERS.render(compile_file(spec).result(), Rendering())[0].text)["controller_manager"]


def test_names_in_parameters_of_the_manager_take_the_prefix(tmp_path: Path):
    compilation = compile_file(two_arms(tmp_path))
    assert not [one for one in compilation.diagnostics if one.code.id in {"LF4112", "LF5704"}]
    assert manager_of(tmp_path / "both.robot.yaml") == {
        "update_rate": 500,
        "hardware_components_initial_state.inactive": ["l_all", "r_all"],
        "hardware_components_initial_state.shutdown_on_initial_state_failure": False,
        "l_hold.type": "a/B",
        "l_move.type": "a/B",
        "l_move.fallback_controllers": ["l_hold"],
        "l_later.type": "c/D",
        "l_later.fallback_controllers": ["l_hold"],
        "r_hold.type": "a/B",
        "r_move.type": "a/B",
        "r_move.fallback_controllers": ["r_hold"],
        "r_later.type": "c/D",
        "r_later.fallback_controllers": ["r_hold"],
    }


def test_names_of_faulty_hardware_and_controllers_are_one_fault_each():
    faulty = ROBOT.replace("  all:\n", "  grip: {joints: {}}\n  all:\n")
    start = "hardware_components_initial_state: {inactive: [grip, all]}"
    manager = f"controller_manager: {{parameters: {{{start}, move: {{fallback_controllers: [hold]}}}}}}"
    text = f"linkforge: 1\nname: robot\n{faulty}controllers: {{move: {{type: a/B}}, hold: {{typ: a/B}}, {manager}}}\n"
    assert [one.code.id for one in compile_text(text).diagnostics if one.code.id != "LF6112"] == ["LF5005", "LF2101"]


def test_the_file_that_uses_modules_states_the_initial_state_of_their_hardware(tmp_path: Path):
    states = "{unconfigured: [l_all], shutdown_on_initial_state_failure: true}"
    parameters = f"{{hardware_components_initial_state: {states}}}"
    spec = two_arms(tmp_path, own=f"controllers: {{controller_manager: {{parameters: {parameters}}}}}\n")
    manager = manager_of(spec)
    start = "hardware_components_initial_state"
    assert manager[f"{start}.unconfigured"] == ["l_all"]
    assert manager[f"{start}.inactive"] == ["r_all"]
    assert manager[f"{start}.shutdown_on_initial_state_failure"] is True


def test_names_in_lists_are_merged_however_their_keys_are_written(tmp_path: Path):
    maps = "hardware_components_initial_state: {inactive: [all], shutdown_on_initial_state_failure: false}"
    dots = "hardware_components_initial_state.inactive: [all]"
    assert maps in ARM_WITH_MANAGER
    spec = two_arms(tmp_path, of_right=ARM_WITH_MANAGER.replace(maps, dots))
    assert manager_of(spec)["hardware_components_initial_state.inactive"] == ["l_all", "r_all"]
    own = "{hardware_components_initial_state.unconfigured: [l_all]}"
    spec = two_arms(tmp_path, own=f"controllers: {{controller_manager: {{parameters: {own}}}}}\n")
    assert manager_of(spec)["hardware_components_initial_state.inactive"] == ["r_all"]


@pytest.mark.parametrize(
    ("parameters", "key", "place"),
    [
        ("constraints.goal_time: 1.0, constraints: {goal_time: 2.0}", "constraints.goal_time", "goal_time"),
        ("constraints: {shoulder: {goal: 1}, shoulder.goal: 1}", "constraints.shoulder.goal", "goal"),
    ],
)
def test_a_parameter_is_written_once_with_a_dot_or_in_a_map(parameters: str, key: str, place: str):
    own = f"controllers: {{own: {{type: {TRAJECTORY}, joints: [elbow], parameters: {{{parameters}}}}}}}"
    (found,) = compile_text(f"linkforge: 1\nname: robot\n{ROBOT}{own}\n").diagnostics
    assert found.code.id == "LF1101"
    assert found.message == f"the key '{key}' is written twice; a dot is the same as a map in a map"
    assert found.span
    assert found.span.text == place


def test_a_value_does_not_hide_the_parameters_below_its_name():
    text = f"{ROBOT}controllers: {{own: {{type: a/B, parameters: {{pid: 1, pid.p: 2, off: null, off.by: 3}}}}}}\n"
    assert nodes_in(rendered(text))["own"] == {"pid": 1, "pid.p": 2, "off.by": 3}


def test_a_joint_with_dots_in_its_name_has_gains():
    robot = ROBOT.replace("elbow", "arm.elbow").replace(
        "command_interfaces: [position]", "command_interfaces: [effort]"
    )
    own = f"{{type: {TRAJECTORY}, joints: [arm.elbow], parameters: {{gains: {{arm.elbow: {{p: 1, pp: 2}}}}}}}}"
    text = f"{robot}controllers: {{own: {own}, o: {{type: a/B}}}}\n"
    assert [one.split(";")[0] for one in reported(text)] == [
        f"LF7611 {OF_TRAJECTORIES} has no parameter 'pp' in 'gains.arm.elbow'"
    ]
    assert type(nodes_in(rendered(text))["own"]["gains.arm.elbow.p"]) is float


def test_modules_may_not_disagree_about_a_parameter_in_a_map(tmp_path: Path):
    other = ARM_WITH_MANAGER.replace("failure: false", "failure: true")
    (found,) = compile_file(two_arms(tmp_path, of_right=other)).diagnostics
    assert found.code.id == "LF4111"
    assert "'hardware_components_initial_state.shutdown_on_initial_state_failure'" in found.message
    assert [note.span.text for note in found.notes if note.span] == ["false", "true"]
    assert [note.message for note in found.notes] == ["in module 'left' it is false", "in module 'right' it is true"]


def test_derived_values_lead_to_what_they_follow_from():
    text = f"linkforge: 1\nname: robot\n{ROBOT}{ARM_GROUP}"
    document = ROS2_CONTROLLERS.render(compile_text(text).result(), Rendering(has_map=True))[0]
    assert document.map is not None
    places = {line.strip(): document.map.at(at) for at, line in enumerate(document.text.splitlines(), start=1)}
    found = {line: place.span.text for line, place in places.items() if place}
    assert found["joints: [shoulder, elbow]"] == "arm"
    assert found["command_interfaces: [position]"] == "[velocity, position]"
    assert found["state_interfaces: [position, velocity]"] == "[velocity, position, effort]"


def test_parameters_of_merged_managers_lead_to_the_files_of_their_modules(tmp_path: Path):
    other = ARM_WITH_MANAGER.replace("update_rate: 500", "handle_exceptions: true")
    robot = compile_file(two_arms(tmp_path, of_right=other)).result()
    document = ROS2_CONTROLLERS.render(robot, Rendering(has_map=True))[0]
    assert document.map is not None
    places = {line.strip(): document.map.at(at) for at, line in enumerate(document.text.splitlines(), start=1)}
    found = {line: place.span.file.name for line, place in places.items() if place}
    assert found["update_rate: 500"].endswith("arm.robot.yaml")
    assert found["handle_exceptions: true"].endswith("right.robot.yaml")
    assert found["r_later:"].endswith("right.robot.yaml")
    assert found["type: c/D"].endswith("right.robot.yaml")


@pytest.mark.parametrize("parameters", ["own: {type: c/D}", "own.type: c/D"])
def test_the_manager_has_no_other_class_of_a_controller(parameters: str):
    manager = f"controller_manager: {{parameters: {{{parameters}}}}}"
    assert reported(f"{ROBOT}controllers: {{own: {{type: a/B}}, {manager}}}\n") == [
        "LF7621 controller 'own' has 'type' in `parameters` of 'controller_manager', and `type` for the same; remove "
        "one of them"
    ]


@pytest.mark.parametrize(("name", "value"), [("own", "5"), ("update_rate", "3")])
def test_the_manager_has_no_value_under_the_name_of_a_controller(name: str, value: str):
    manager = f"controller_manager: {{parameters: {{{name}: {value}}}}}"
    assert reported(f"{ROBOT}controllers: {{{name}: {{type: a/B}}, {manager}}}\n") == [
        f"LF7621 controller '{name}' has '{name}' in `parameters` of 'controller_manager', which is a value and "
        "no map of its parameters; remove it, or rename the controller"
    ]


def test_a_fallback_of_a_robot_with_default_controllers_exists():
    fallbacks = "[arm_controler, arm_controller, joint_state_broadcaster]"
    manager = f"controller_manager: {{parameters: {{arm_controller: {{fallback_controllers: {fallbacks}}}}}}}"
    text = f"linkforge: 1\nname: robot\n{ROBOT}{ARM_GROUP}controllers: {{{manager}}}\n"
    (found,) = (one for one in compile_text(text).diagnostics if one.code.id == "LF4112")
    assert found.span
    assert found.span.text == "arm_controler"


@pytest.mark.parametrize(
    "parameters", ["own: {type: a/B, params_file: a.yaml}", "own.type: a/B, own.params_file: a.yaml"]
)
def test_a_class_that_the_manager_has_as_well_is_written_once(parameters: str):
    text = f"{ROBOT}controllers: {{own: {{type: a/B}}, controller_manager: {{parameters: {{{parameters}}}}}}}\n"
    assert reported(text) == []
    manager = nodes_in(rendered(text))["controller_manager"]
    assert manager == {"update_rate": 100, "own.type": "a/B", "own.params_file": "a.yaml"}


def test_a_controller_that_the_manager_loads_is_no_default_controller():
    manager = "controller_manager: {parameters: {arm_controller: {type: a/B, params_file: arm.yaml}}}"
    nodes = nodes_in(rendered(f"{ROBOT}{ARM_GROUP}controllers: {{{manager}}}\n"))
    assert nodes["controller_manager"]["arm_controller.type"] == "a/B"
    assert "arm_controller" not in nodes


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
