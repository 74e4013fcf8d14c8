"""Examples in MuJoCo: the golden file of the quadruped, and robots that hold a pose against gravity."""

import subprocess
import sys
from pathlib import Path

import numpy
import pytest

from linkforge_compile import compile_file
from linkforge_compile.formats import MJCF, Rendering
from tests.conftest import ROOT

mujoco = pytest.importorskip("mujoco")

QUADRUPED = ROOT / "examples" / "07_quadruped"
SECONDS = 2.0


def test_the_quadruped_compiles_to_the_mjcf_next_to_it(tmp_path: Path, update_golden: bool):
    """Renew it with --update-golden, and read the diff."""
    golden = QUADRUPED / "quadruped_mujoco.mjcf"
    written = golden if update_golden else tmp_path / golden.name
    spec = QUADRUPED / "quadruped_mujoco.robot.yaml"
    words = ("-m", "linkforge_compile", "compile", str(spec), "-o", str(written), "--base", "free")
    run = subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False, timeout=60)
    assert run.returncode == 0, run.stderr
    assert written.read_bytes() == golden.read_bytes()


def test_the_quadruped_stands_on_the_ground():
    model = mujoco.MjModel.from_xml_path(str(QUADRUPED / "scene.xml"))
    data = simulated(model, "standing")
    height = model.key("standing").qpos[2]
    assert data.body("trunk").xpos[2] == pytest.approx(height, rel=0.2)
    assert data.body("trunk").xmat[8] > 0.99, "the trunk is level"
    assert data.joint("trunk_free").qvel == pytest.approx(numpy.zeros(6), abs=0.01)
    feet = {model.body(model.geom_bodyid[geom]).name for contact in data.contact for geom in contact.geom}
    assert feet == {"world"} | {f"{end}_{side}_foot" for end in ("front", "rear") for side in ("left", "right")}


def test_the_scene_of_the_docs_attaches_a_robot_with_its_keyframes(tmp_path: Path):
    page = (ROOT / "docs" / "how-to" / "mujoco.md").read_text()
    scene = next(one for one in page.split("```xml\n") if "<attach" in one).partition("```")[0]
    golden = (QUADRUPED / "quadruped_mujoco.mjcf").read_text()
    (tmp_path / "arm.mjcf").write_text(golden.replace('"trunk"', '"base"'))
    (tmp_path / "scene.xml").write_text(scene)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    assert model.nq == 7 + 7 + 12
    assert model.key("robot_standing").qpos[2] == 0.322


UR5E = f"""
linkforge: 1
name: ur5e
links: {{world: }}
modules: {{arm: {{use: {ROOT}/examples/02_ur5e/ur5e_arm.robot.yaml, parent: world, joint: base_joint, prefix: ""}}}}
x-drive: &drive {{command_interfaces: {{position: {{kp: 4000, kv: 200}}}}, state_interfaces: [position]}}
ros2_control:
  arm:
    hardware_plugin: mock_components/GenericSystem
    joints:
      shoulder_pan_joint: *drive
      shoulder_lift_joint: *drive
      elbow_joint: *drive
      wrist_1_joint: *drive
      wrist_2_joint: *drive
      wrist_3_joint: *drive
"""


def test_the_ur5e_holds_a_state(tmp_path: Path):
    spec = tmp_path / "ur5e.robot.yaml"
    spec.write_text(UR5E)
    robot = compile_file(spec, allow_outside=True).result()
    model = mujoco.MjModel.from_xml_string(MJCF.render(robot, Rendering())[0].text)
    for state in ("home", "up"):
        data = simulated(model, state)
        numpy.testing.assert_allclose(data.qpos, model.key(state).qpos, atol=0.03)
        numpy.testing.assert_allclose(data.qvel, 0, atol=1e-3)


def test_the_fingers_of_a_gripper_follow_its_drive():
    robot = compile_file(ROOT / "examples" / "05_gripper" / "robotiq_2f_85.robot.yaml").result()
    model = mujoco.MjModel.from_xml_string(MJCF.render(robot, Rendering())[0].text)
    model.actuator_gainprm[:, 0], model.actuator_biasprm[:, 1:3] = 50, (-50, -5)  # the example states no gains
    data = mujoco.MjData(model)
    data.ctrl[:] = 0.6
    while data.time < SECONDS:
        mujoco.mj_step(model, data)
    for joint in robot.joints:
        if joint.mimic:
            leader = data.joint(joint.mimic.joint).qpos
            assert data.joint(joint.name).qpos == pytest.approx(joint.mimic.multiplier * leader, abs=0.02)


def simulated(model, key: str):
    """Return the state some seconds after a keyframe, whose commands are held."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(key).id)
    while data.time < SECONDS:
        mujoco.mj_step(model, data)
    assert numpy.isfinite(data.qpos).all()
    assert not any(warning.number for warning in data.warning), "MuJoCo resets a state that diverges"
    return data
