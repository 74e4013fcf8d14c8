"""MJCF: what it has no place for is reported, at the place in the spec."""

import mujoco
import pytest

from linkforge_compile.formats import MJCF, Rendering
from tests.consumers import mjcf_model
from tests.formats.mjcf import HEAD, compiled, document, every_report, reported

ROBOT = """
links: {base: , arm: {inertial: *unit}, hand: {inertial: *unit}}
joints:
  turn: {type: continuous, parent: base, child: arm, axis: z, limits: {effort: 5, velocity: 3}}
  drive: {type: planar, parent: arm, child: hand, axis: z}
"""

HARDWARE = """
ros2_control:
  arm:
    hardware_plugin: mock_components/GenericSystem
    joints: {NAME: {command_interfaces: [COMMAND], state_interfaces: [STATE]}}
"""


def hardware(name: str = "turn", command: str = "effort", state: str = "[position]") -> str:
    return ROBOT + HARDWARE.replace("NAME", name).replace("COMMAND", command).replace("[STATE]", state)


CASES = {
    "calibrations": ROBOT.replace("axis: z, limits", "axis: z, calibration: {rising: 1}, limits"),
    "limits of acceleration and jerk": ROBOT.replace("effort: 5,", "effort: 5, acceleration: 2,"),
    "limits of planar joints": ROBOT.replace("child: hand,", "child: hand, limits: {effort: 1, velocity: 1},"),
    "dynamics of planar joints": ROBOT.replace("child: hand,", "child: hand, dynamics: {damping: 1},"),
    "mimic with a joint of other than one axis": ROBOT.replace("limits: {", "mimic: {joint: drive}, limits: {"),
    "second coefficient of friction (mu2)": ROBOT.replace("arm: {", "arm: {physics: {mu: 1, mu2: 0.5}, "),
    "stiffness and damping of contacts (kp, kd)": ROBOT.replace("arm: {", "arm: {physics: {kp: 1e5}, "),
    "`self_collide: false`": ROBOT.replace("arm: {", "arm: {physics: {self_collide: false}, "),
    "actuators of planar joints": hardware("drive"),
    "actuators for the command interface 'acceleration'": hardware(command="acceleration"),
    "initial velocity": hardware(state="{velocity: {initial_value: 1}}"),
    "raw XML of a URDF": ROBOT.replace("arm: {", "arm: {visual: {sphere: 1, extra: <note/>}, "),
    "noise of cameras": ROBOT
    + "sensors: {eye: {type: camera, link: arm, camera: {noise: {type: gaussian, stddev: 0.1}}}}\n",
    "noise other than a standard deviation": ROBOT
    + "sensors: {imu: {type: imu, link: arm, imu: {angular_velocity_noise: {stddev: 0.1, mean: 1}}}}\n",
    "clip distances of cameras": ROBOT + "sensors: {eye: {type: camera, link: arm, camera: {far_clip: 9 m}}}\n",
}

OF_OTHER_PROGRAMS = {
    "gpios": ROBOT + "ros2_control: {io: {hardware_plugin: a/B, gpios: {pins: {command_interfaces: [out]}}}}\n",
    "sensors of hardware": ROBOT
    + "ros2_control: {io: {type: sensor, hardware_plugin: a/B, sensors: {force: {state_interfaces: [x]}}}}\n",
    "plugins of sensors": ROBOT
    + "sensors: {imu: {type: imu, link: arm, imu: {}, plugin: {name: publisher, filename: lib.so}}}\n",
}


@pytest.mark.parametrize("parts", CASES)
def test_a_part_without_counterpart_is_reported(parts: str):
    assert [one.partition(";")[0] for one in reported(CASES[parts])] == [f"LF7405 MJCF has no {parts}"]
    assert mjcf_model(compiled(CASES[parts])).nbody == 4


@pytest.mark.parametrize("parts", OF_OTHER_PROGRAMS)
def test_a_part_for_another_program_has_a_code_of_its_own(parts: str):
    found = [one.partition(";")[0] for one in reported(OF_OTHER_PROGRAMS[parts])]
    assert found == [f"LF7413 MuJoCo does not read {parts}"]


def test_settings_for_gazebo_are_reported_at_the_first_that_is_left_out():
    robot = ROBOT.replace("arm: {", "arm: {gazebo: {mu1: 0.5, maxVel: 1, minDepth: 0.1}, ")
    (found,) = [one for one in MJCF.limits(compiled(robot), {}) if one.code.id == "LF7413"]
    assert found.span is not None
    assert (HEAD + robot).splitlines()[found.span.line - 1][found.span.column - 1 :].startswith("1,")


def test_a_robot_without_hardware_has_a_note_that_nothing_drives_it():
    note = "LF7414 no joint of 'robot' has an actuator in the MJCF: `ros2_control` commands none of them"
    assert note in every_report(ROBOT)
    assert note not in every_report(hardware())


def test_a_fixed_base_of_a_robot_that_moves_in_the_world_has_a_note():
    moving = ROBOT + "semantic: {virtual_joints: {odom: {type: planar, parent_frame: world, child_link: base}}}\n"
    note = "LF7415 virtual joint 'odom' is planar, but the robot is fixed to the world in the MJCF"
    assert [one.partition(";")[0] for one in reported(moving)] == [note]
    assert not any("LF7415" in one for one in reported(moving, base="free"))


def test_a_loss_is_reported_at_its_place():
    found = {one.message: one.span for one in MJCF.limits(compiled(CASES["raw XML of a URDF"]), {})}
    span = found["MJCF has no raw XML of a URDF; omitted for 'arm'"]
    lines = (HEAD + CASES["raw XML of a URDF"]).splitlines()
    assert span is not None
    assert lines[span.line - 1][span.column - 1 :].startswith("<note/>")


def test_the_axis_of_a_fixed_joint_is_no_loss():
    weld = "drive: {type: fixed, parent: arm, child: hand, extra: <axis xyz='0 0 1'/>}"
    assert reported(ROBOT.replace("drive: {type: planar, parent: arm, child: hand, axis: z}", weld)) == []


def test_namespaces_are_no_loss():
    assert reported("extra_attributes: {xmlns:xacro: http://www.ros.org/wiki/xacro}" + ROBOT) == []


@pytest.mark.parametrize("stated", ["physics: {mu: 0.5}", "gazebo: {mu1: 0.5}", "gazebo: {mu1: 0.5, mu2: 0.5}"])
def test_friction_is_that_of_the_link(stated: str):
    robot = ROBOT.replace("arm: {", f"arm: {{collision: {{sphere: 1}}, {stated}, ")
    assert list(mjcf_model(compiled(robot)).geom_friction[0]) == [0.5, 0.005, 0.0001]
    assert reported(robot) == []


@pytest.mark.parametrize(("mu", "dimensions"), [(0.5, 3), (0, 1)])
def test_friction_holds_on_the_ground_which_has_more(mu: float, dimensions: int):
    robot = ROBOT.replace("arm: {", f"arm: {{collision: {{sphere: 1}}, physics: {{mu: {mu}}}, ")
    spec = mujoco.MjSpec.from_string(MJCF.render(compiled(robot), Rendering({}))[0].text)
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[9, 9, 1], pos=[0, 0, -0.99])
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    (contact,) = data.contact
    assert contact.dim == dimensions
    assert contact.friction[0] == pytest.approx(max(mu, 1e-5))


def test_velocity_limits_are_lost_unless_they_limit_a_command():
    lost = "LF7411 MuJoCo does not limit velocities; the limit of joint 'turn' is omitted"
    assert lost in every_report(ROBOT)
    assert lost in every_report(hardware(command="effort"))
    assert lost not in every_report(hardware(command="velocity"))


def test_sensors_send_no_messages():
    lost = "LF7412 MuJoCo measures at every step and sends no messages; rate, topic and frame of 'imu' are omitted"
    imu = "sensors: {imu: {type: imu, link: arm, imu: {}}}\n"
    assert lost in every_report(ROBOT + imu.replace("imu: {}", "imu: {}, topic: /imu"))
    assert lost not in every_report(ROBOT + imu)


TAKEN = """
links: {base: {inertial: *unit}, arm: {inertial: *unit}, hand: {inertial: *unit}}
joints:
  NAME: {type: continuous, parent: base, child: arm, axis: z}
  drive: {type: planar, parent: arm, child: hand, axis: z}
"""


@pytest.mark.parametrize(
    ("name", "base", "owner"),
    [("drive_yaw", "fixed", "a part of planar joint 'drive'"), ("base_free", "free", "the free joint of link 'base'")],
)
def test_a_joint_with_a_name_that_is_made_is_an_error(name: str, base: str, owner: str):
    robot = TAKEN.replace("NAME", name)
    message = f"LF7410 MuJoCo refuses two joints with the same name, and '{name}' is also the name of {owner}"
    assert reported(robot, base=base) == [f"{message}; rename this one"]
    with pytest.raises(ValueError, match="repeated name"):
        mjcf_model(compiled(robot), base=base)


def test_the_free_joint_has_its_name_only_if_the_base_is_free():
    assert reported(TAKEN.replace("NAME", "base_free")) == []


def test_a_state_with_a_name_that_is_made_is_an_error():
    states = """
semantic:
  groups: {a: {joints: [turn]}, b: {joints: [turn]}, c: {joints: [turn]}}
  group_states: {a: {home: {turn: 0}}, b: {home: {turn: 1}}, c: {a_home: {turn: 2}}}
"""
    assert reported(ROBOT + states) == [
        "LF7410 MuJoCo refuses two keyframes with the same name, and 'a_home' is also the name of state "
        "'home' of group 'a'; rename this one"
    ]


def test_initial_values_are_a_keyframe():
    robot = hardware(state="{position: {initial_value: 0.25}}")
    keys = [dict(key.attrib) for key in document(robot).iterfind("keyframe/key")]
    assert keys == [{"name": "initial_positions", "qpos": "0.25 0 0 0", "ctrl": "0"}]
    assert reported(robot) == []
