"""`linkforge info`; tests/overview compares its figures with those of other programs."""

import json
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge

FINGER = """\
linkforge: 1
name: finger
links: {tip: {visual: {box: [10 mm, 10 mm, 40 mm]}, inertial: {mass: 20 g}}}
"""

ARM = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 800 mm}
  tool: {type: string}
variants:
  lab: {reach: 50 cm}
modules:
  finger: {use: finger.robot.yaml, parent: carriage}
links:
  base: {visual: {box: [20 cm, 20 cm, 10 cm]}, inertial: {mass: 4 kg}}
  upper: {visual: {mesh: "package://nowhere/upper.stl"}, inertial: {mass: 1 kg, inertia: {ixx: 1, iyy: 1, izz: 1}}}
  carriage: {}
  helper: {visual: {box: [1 cm, 1 cm, 1 cm]}, inertial: {mass: 1 kg}}
joints:
  lift: {type: revolute, parent: base, child: upper, axis: y, limits: {lower: 0, upper: 1, effort: 9, velocity: 1}}
  slide: {type: prismatic, parent: upper, child: carriage, axis: z, origin: [0, 0, $(reach)],
          limits: {lower: -10 cm, upper: 5 cm, effort: 9, velocity: 1}}
  help: {type: revolute, parent: base, child: helper, axis: y, limits: {lower: 0, upper: 1, effort: 9, velocity: 1},
         mimic: {joint: lift}}
sensors:
  eye: {type: camera, link: carriage}
ros2_control:
  drive: {hardware_plugin: mock_components/GenericSystem, joints: {lift: {command_interfaces: [position]}}}
controllers:
  mover: {type: joint_trajectory_controller/JointTrajectoryController, joints: [lift], command_interfaces: [position],
          state_interfaces: [position]}
semantic:
  groups:
    whole: {chain: {base_link: base, tip_link: finger_tip}}
    hand: {links: [finger_tip]}
  group_states:
    whole: {home: {lift: 10 deg, slide: 0}}
  end_effectors:
    gripper: {group: hand, parent_link: carriage}
"""

FIGURES = """\
arm: 5 links, 4 joints

joints          2 revolute, 1 prismatic, 1 fixed
freedom         2 degrees of freedom; 1 joint with mimic not counted
mass            6.02 kg
                without mass: carriage
centre of mass  [0, 0, 0.002658] m in base, every joint at 0
reach           at most 0.85 m, carriage from base
size            0.2 x 0.2 x 0.87 m, every joint at 0; from [-0.1, -0.1, -0.05] to [0.1, 0.1, 0.82]
                without 1 mesh: package 'nowhere' is not found; specify its folder with `--package
                nowhere=FOLDER`
meshes          1 file, 0 bytes
                missing  package://nowhere/upper.stl
                package 'nowhere' is not found; specify its folder with `--package nowhere=FOLDER`
sensors         eye: camera of carriage
hardware        drive: system mock_components/GenericSystem of lift
controllers     mover: joint_trajectory_controller/JointTrajectoryController of lift
group           whole: lift, slide
                states home
                reach at most 0.85 m, finger_tip from base
group           hand: no joint that moves independently
end effector    gripper: group hand on carriage
parameters      reach = 800 mm, tool (required)
variants        lab
modules         finger (1 link)
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    (tmp_path / "finger.robot.yaml").write_text(FINGER)
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    return tmp_path


def test_the_figures_of_a_robot_with_everything(arm: Path):
    run = linkforge("info", "arm.robot.yaml", "tool:=none", "-q", cwd=arm)
    assert (run.stdout, run.stderr, run.returncode) == (FIGURES, "", 0)


def test_parameters_and_variants_change_the_figures(arm: Path):
    run = linkforge("info", "arm.robot.yaml", "-p", "tool=none", "--variant", "lab", "--json", cwd=arm)
    document = json.loads(run.stdout)
    assert document["reach"] == {"bound": 0.55, "start": "base", "link": "carriage"}
    assert document["joints"] == {"revolute": 2, "prismatic": 1, "fixed": 1}
    assert document["groups"][0]["joints"] == ["lift", "slide"]
    assert document["parameters"]["tool"] == {"type": "string", "default": None}
    assert (document["variants"], document["modules"]) == (["lab"], {"finger": 1})
    assert document["meshes"][0]["size"] is None


def test_a_urdf_and_standard_input_have_figures(arm: Path):
    urdf = linkforge("compile", "arm.robot.yaml", "tool:=none", "-q", cwd=arm).stdout
    (arm / "arm.urdf").write_text(urdf)
    of_file = linkforge("info", "arm.urdf", "-q", cwd=arm)
    of_stdin = linkforge("info", "-", "-q", cwd=arm, stdin=urdf)
    assert (of_file.returncode, of_file.stdout) == (0, of_stdin.stdout), of_file.stderr
    assert "mass            6.02 kg\n" in of_file.stdout


def test_a_spec_with_errors_has_no_figures(arm: Path):
    run = linkforge("info", "arm.robot.yaml", cwd=arm)
    assert (run.returncode, run.stdout) == (1, "")
    assert "tool" in run.stderr


def test_names_of_files_do_not_drive_the_terminal(arm: Path):
    text = FINGER.replace("box: [10 mm, 10 mm, 40 mm]", r'mesh: "a\x1b[2Jb.stl"')
    (arm / "finger.robot.yaml").write_text(text)
    run = linkforge("info", "finger.robot.yaml", "-q", cwd=arm)
    assert "b.stl" in run.stdout + run.stderr
    assert "\033" not in run.stdout + run.stderr
