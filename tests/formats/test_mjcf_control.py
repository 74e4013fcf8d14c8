"""MJCF: actuators, contacts, keyframes and sensors, as MuJoCo has them."""

import math

import numpy
import pytest

from linkforge_compile.formats import MJCF, Rendering
from tests.consumers import mjcf_model
from tests.formats.mjcf import compiled, document, reported

mujoco = pytest.importorskip("mujoco")

ARM = """
links:
  base: {collision: {sphere: 0.1}}
  upper: {inertial: *unit, collision: {sphere: 0.1}}
  lower: {inertial: *unit, collision: {sphere: 0.1}}
joints:
  shoulder:
    type: revolute
    parent: base
    child: upper
    axis: [0, 0, 1]
    limits: {lower: -1, upper: 2, effort: 5, velocity: 3}
  elbow:
    type: prismatic
    parent: upper
    child: lower
    axis: [1, 0, 0]
    origin: {xyz: [0.5, 0, 0]}
    limits: {lower: 0, upper: 0.5, effort: 7, velocity: 4}
"""

CONTROL = """
ros2_control:
  arm:
    hardware_plugin: mock_components/GenericSystem
    joints:
      shoulder: {command_interfaces: SHOULDER, state_interfaces: [position]}
      elbow: {command_interfaces: [effort], state_interfaces: [position]}
"""


def elements(text: str, path: str, **options: str) -> list[dict[str, str]]:
    return [{"": str(one.tag)} | dict(one.attrib) for one in document(text, **options).iterfind(path)]


@pytest.mark.parametrize(
    ("interface", "expected"),
    [
        (
            "{position: {kp: 200, kv: 20}}",
            {"": "position", "ctrlrange": "-1 2", "kp": "200", "kv": "20"},
        ),
        (
            "{position: {kp: 9, min: -0.5, max: 1}}",
            {"": "position", "ctrlrange": "-0.5 1", "kp": "9"},
        ),
        ("{velocity: {kv: 8}}", {"": "velocity", "ctrlrange": "-3 3", "kv": "8"}),
        ("[effort]", {"": "motor", "ctrlrange": "-5 5"}),
        ("[torque]", {"": "motor", "ctrlrange": "-5 5"}),
    ],
)
def test_a_command_interface_is_an_actuator(interface: str, expected: dict[str, str]):
    robot = ARM + CONTROL.replace("SHOULDER", interface)
    assert elements(robot, "actuator/*") == [
        expected | {"name": "shoulder", "joint": "shoulder"},
        {"": "motor", "name": "elbow", "joint": "elbow", "ctrlrange": "-7 7"},
    ]
    assert mjcf_model(compiled(robot)).nu == 2
    assert reported(robot) == []


def test_what_most_joints_have_is_in_their_class():
    names = ("one", "two", "three")
    joint = "{type: continuous, parent: base, child: NAME, axis: z, limits: {effort: 5, velocity: 3}}"
    robot = f"""
links: {{base: , {", ".join(f"{name}: {{inertial: *unit}}" for name in names)}}}
joints: {{{", ".join(f"{name}_joint: {joint.replace('NAME', name)}" for name in names)}}}
ros2_control:
  arm:
    hardware_plugin: mock_components/GenericSystem
    joints:
      one_joint: {{command_interfaces: {{position: {{kp: 200, kv: 20}}}}}}
      two_joint: {{command_interfaces: {{position: {{kp: 200, kv: 20}}}}}}
      three_joint: {{command_interfaces: {{position: {{kp: 300}}}}}}
"""
    assert elements(robot, "default/default[@class='joint']/*") == [
        {"": "joint", "actuatorfrcrange": "-5 5"},
        {"": "position", "kp": "200", "kv": "20"},
    ]
    assert [one.get("class") for one in elements(robot, "actuator/*")] == ["joint", "joint", None]
    model = mjcf_model(compiled(robot))
    assert model.jnt_actfrcrange.tolist() == [[-5, 5]] * 3
    assert model.actuator_gainprm[:, 0].tolist() == [200, 200, 300]
    assert model.actuator_biasprm[:, 2].tolist() == [-20, -20, 0]


def test_a_joint_has_one_actuator():
    robot = ARM + CONTROL.replace("SHOULDER", "[effort, velocity, torque_constant]")
    assert [one[""] for one in elements(robot, "actuator/*")] == ["motor", "motor"]
    assert reported(robot) == [
        "LF7407 joint 'shoulder' has an actuator for its command interface 'effort' only, not for 'velocity' "
        "and 'torque_constant' in the MJCF"
    ]


def test_an_actuator_without_a_gain_is_reported():
    assert reported(ARM + CONTROL.replace("SHOULDER", "[position]")) == [
        "LF7408 the position actuator of joint 'shoulder' has MuJoCo's gain of 1; write `kp` in its parameters"
    ]


def test_disabled_collisions_and_joints_at_a_static_body_are_exclusions():
    robot = ARM + "semantic: {disabled_collisions: {base: {upper: Adjacent, lower: Never}}}\n"
    pairs = [(one["body1"], one["body2"]) for one in elements(robot, "contact/exclude")]
    assert pairs == [("base", "upper"), ("base", "lower")]
    assert elements(ARM, "contact/exclude") == [{"": "exclude", "body1": "base", "body2": "upper"}]
    assert elements(ARM, "contact/exclude", base="free") == [], "MuJoCo excludes parents that move by itself"


FRAMES = """
links:
  base: {collision: {sphere: 0.1}}
  flange:
  arm_frame: {inertial: *unit}
  arm: {collision: {sphere: 0.1}}
joints:
  weld: {type: fixed, parent: base, child: flange}
  turn: {type: continuous, parent: flange, child: arm_frame, axis: [0, 0, 1]}
  hold: {type: fixed, parent: arm_frame, child: arm}
"""


def test_frames_between_shapes_do_not_make_them_collide():
    assert contacts(FRAMES) == 0
    assert [(one["body1"], one["body2"]) for one in elements(FRAMES, "contact/exclude")] == [("arm", "base")]
    beside = FRAMES.replace("parent: base, child: flange", "parent: flange, child: base")
    assert contacts(beside) == 0


def test_the_world_collides_with_what_moves_in_it():
    robot = FRAMES.replace("base", "world")
    assert elements(robot, "contact/exclude") == [], "an exclusion would hold for the ground of a scene, too"
    assert contacts(robot) == 1


def test_links_without_default_collisions_touch_enabled_ones_alone():
    robot = """
links: {base: SHAPE, left: SHAPE, right: SHAPE}
joints:
  a: {type: floating, parent: base, child: left}
  b: {type: floating, parent: base, child: right}
semantic: {no_default_collision_links: [left]}
""".replace("SHAPE", "{inertial: *unit, collision: {sphere: 1}}")
    assert contacts(robot) == 1
    enabled = robot.replace("[left]", "[left], enabled_collisions: {left: {right: }}")
    assert contacts(enabled) == 2


def contacts(text: str) -> int:
    """Return how many contacts MuJoCo finds in a robot at rest."""
    model = mjcf_model(compiled(text))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return int(data.ncon)


def test_adjacent_links_do_not_collide():
    for base in ("fixed", "free"):
        robot = ARM.replace("base: {", "base: {inertial: *unit, ").replace("xyz: [0.5, 0, 0]", "xyz: [5, 0, 0]")
        model = mjcf_model(compiled(robot), base=base)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        assert data.ncon == 0, base


STATES = """
semantic:
  groups: {arm: {joints: [shoulder, elbow]}, tool: {joints: [elbow]}}
  group_states:
    arm: {home: {shoulder: 0.5, elbow: 0.25}, ready: {shoulder: 1}}
    tool: {home: {elbow: 0.125}}
"""


def test_states_of_groups_are_keyframes():
    robot = ARM + CONTROL.replace("SHOULDER", "{position: {kp: 200}}") + STATES
    keys = {one["name"]: (one["qpos"], one["ctrl"]) for one in elements(robot, "keyframe/key")}
    assert keys == {"arm_home": ("0.5 0.25", "0.5 0"), "ready": ("1 0", "1 0"), "tool_home": ("0 0.125", "0 0")}
    assert mjcf_model(compiled(robot)).nkey == 3


def test_a_keyframe_of_a_free_base_begins_with_its_pose():
    robot = ARM.replace("base: {", "base: {inertial: *unit, ") + STATES
    model = mjcf_model(compiled(robot), base="free")
    numpy.testing.assert_array_equal(model.key("ready").qpos, [0, 0, 0, 1, 0, 0, 0, 1, 0])


def test_a_virtual_joint_is_the_pose_of_a_free_base():
    robot = """
links: {base: {inertial: *unit}, arm: {inertial: *unit}}
joints: {turn: {type: continuous, parent: base, child: arm, axis: z}}
semantic:
  virtual_joints: {floor: {type: floating, parent_frame: world, child_link: base}}
  groups: {body: {joints: [floor, turn]}}
  group_states: {body: {stand: {floor: [1, 2, 3, 1, 0, 0, 0], turn: 0.5}}}
"""
    key = mjcf_model(compiled(robot), base="free").key("stand")
    numpy.testing.assert_array_equal(key.qpos, [1, 2, 3, 0, 1, 0, 0, 0.5])
    assert mjcf_model(compiled(robot)).key("stand").qpos == [0.5]


def test_a_joint_that_a_state_leaves_out_is_in_its_range():
    robot = ARM.replace("lower: 0, upper: 0.5", "lower: 0.25, upper: 0.75") + STATES
    model = mjcf_model(compiled(robot))
    numpy.testing.assert_array_equal(model.key("ready").qpos, [1, 0.5])


def test_stiff_drives_choose_an_implicit_integrator_which_a_scene_replaces():
    implicit, explicit = mujoco.mjtIntegrator.mjINT_IMPLICITFAST, mujoco.mjtIntegrator.mjINT_EULER
    driven = compiled(ARM + CONTROL.replace("SHOULDER", "{position: {kp: 200, kv: 20}}"))
    assert mjcf_model(compiled(ARM)).opt.integrator == explicit
    assert mjcf_model(driven).opt.integrator == implicit
    robot = {"robot.mjcf": MJCF.render(driven, Rendering())[0].text.encode()}
    scene = '<mujoco><include file="robot.mjcf"/><option integrator="Euler"/></mujoco>'
    assert mujoco.MjModel.from_xml_string(scene, assets=robot).opt.integrator == explicit


def test_a_joint_that_mimics_follows_in_a_keyframe():
    robot = ARM.replace("axis: [1, 0, 0]", "axis: [1, 0, 0]\n    mimic: {joint: shoulder, multiplier: 2, offset: 0.25}")
    states = "semantic: {groups: {arm: {joints: [shoulder]}}, group_states: {arm: {ready: {shoulder: 1}}}}\n"
    assert [one["qpos"] for one in elements(robot + states, "keyframe/key")] == ["1 2.25"]


SENSORS = """
sensors:
  imu:
    type: imu
    link: upper
    origin: {xyz: [0, 0, 0.5], rpy: [0, 0, 90 deg]}
    imu: {angular_velocity_noise: {stddev: 0.25}}
  eye: {type: camera, link: lower, camera: {horizontal_fov: 90 deg, width: 200, height: 100}}
  wrench: {type: force_torque, link: lower, force_torque: {}}
"""


def test_sensors_measure_at_sites():
    robot = ARM + SENSORS
    assert elements(robot, "sensor/*") == [
        {"": "gyro", "name": "imu_gyro", "site": "imu", "noise": "0.25"},
        {"": "accelerometer", "name": "imu_accel", "site": "imu"},
        {"": "framequat", "name": "imu_quat", "objtype": "site", "objname": "imu"},
        {"": "force", "name": "wrench_force", "site": "wrench"},
        {"": "torque", "name": "wrench_torque", "site": "wrench"},
    ]
    model = mjcf_model(compiled(robot))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    numpy.testing.assert_allclose(data.site("imu").xpos, [0, 0, 0.5], atol=1e-12)
    numpy.testing.assert_allclose(data.sensor("imu_quat").data, [math.sqrt(0.5), 0, 0, math.sqrt(0.5)], atol=1e-12)


def test_a_camera_looks_where_gazebos_does():
    model = mjcf_model(compiled(ARM + SENSORS))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    right, up, back = data.cam("eye").xmat.reshape(3, 3).T
    numpy.testing.assert_allclose([right, up, back], [[0, -1, 0], [0, 0, 1], [-1, 0, 0]], atol=1e-12)
    assert model.cam("eye").fovy == pytest.approx(2 * math.degrees(math.atan(0.5)))


def test_mujoco_senses_the_force_of_the_parent_on_the_child():
    """The sign is as Gazebo has it for `parent_to_child`; with the default, `child_to_parent`, it is reported."""
    robot = """
links: {base: , weight: {inertial: *unit}}
joints: {weld: {type: fixed, parent: base, child: weight}}
sensors: {wrench: {type: force_torque, link: weight, force_torque: {DIRECTION}}}
"""
    model = mjcf_model(compiled(robot.replace("DIRECTION", "measure_direction: parent_to_child")))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.sensor("wrench_force").data[2] == pytest.approx(9.81)
    assert reported(robot.replace("DIRECTION", "measure_direction: parent_to_child")) == []
    assert reported(robot.replace("DIRECTION", "")) == [
        "LF7409 MuJoCo measures the force of the parent on the child, so the signs of 'wrench' are opposite"
    ]


def test_sensors_without_counterpart_are_reported_by_type():
    robot = (
        ARM
        + """
sensors:
  scan: {type: lidar, link: base, lidar: {}}
  back: {type: lidar, link: base, lidar: {}}
  wrench: {type: force_torque, link: lower, force_torque: {frame: parent}}
"""
    )
    assert reported(robot) == [
        "LF7405 MJCF has no sensors of type lidar; omitted for 'scan'; the same for 'back'",
        "LF7405 MJCF has no force-torque sensors in the frame of the parent; omitted for 'wrench'",
    ]
