"""Where the page has the links of robots, against Pinocchio."""

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkforge_compile import Robot, compile_file, compile_text, render_urdf
from linkforge_compile.view.files import RobotFiles
from linkforge_compile.view.html import html_of
from linkforge_compile.view.scene import SceneJoint, make_scene
from tests.conftest import ROOT
from tests.consumers import pinocchio_model

EXAMPLES = (
    "02_ur5e/ur5e",
    "05_gripper/ur5e_gripper",
    "06_rover/rover",
    "07_quadruped/quadruped",
    "08_hand/hand",
    "09_mobile_manipulator/mobile_manipulator",
)
CORPUS = ("robotiq_2f_85", "kinova_gen3_7dof_2f85", "anymal", "interbotix_wx250s", "turtlebot4_standard", "franka_fr3")

ALL_KINDS = """\
linkforge: 1
name: kinds
links: {a: , b: , c: , d: , e: , f: , g: , h: }
joints:
  slide:
    {type: prismatic, parent: a, child: b, origin: {xyz: [1, 2, 3], rpy: [0.1, 0.2, 0.3]}, axis: [1, 2, -1],
     limits: {lower: -0.5, upper: 0.7, effort: 1, velocity: 1}}
  turn: {type: continuous, parent: b, child: c, origin: {rpy: [1, -1, 2]}, axis: [0, 1, 1]}
  follow:
    {type: revolute, parent: c, child: d, origin: [0, 0, 1], axis: x,
     mimic: {joint: slide, multiplier: -2, offset: 0.3},
     limits: {lower: -3, upper: 3, effort: 1, velocity: 1}}
  chain:
    {type: prismatic, parent: d, child: e, origin: [0, 1, 0], axis: z, mimic: {joint: follow, multiplier: 0.5},
     limits: {lower: -3, upper: 3, effort: 1, velocity: 1}}
  weld: {type: fixed, parent: e, child: f, origin: {xyz: [0, 0, 1], rpy: [0, 1, 0]}}
  glide: {type: planar, parent: f, child: g, origin: {xyz: [1, 0, 1], rpy: [0, 0.5, 0]}, axis: z}
  float: {type: floating, parent: g, child: h, origin: {xyz: [0, 2, 1], rpy: [1, 0, 0]}}
"""


def require_links_where_pinocchio_has_them(robot: Robot, show: Callable[[str], Any]) -> None:
    """Compare the places of all links in the world at random positions, which the page gets as a user sets them."""
    pin = pytest.importorskip("pinocchio")
    scene = make_scene(robot, RobotFiles(), {"panels": False})
    tab = show(html_of(scene, RobotFiles()))
    model = pinocchio_model(render_urdf(robot))
    data = model.createData()
    for seed in range(3):
        positions = random_positions(scene["joints"], random.Random(seed))
        free = {joint["name"] for joint in scene["joints"] if joint["mimic"] is None}
        tab.evaluate("p => linkforge.set(p)", {name: at for name, at in positions.items() if name in free})
        names = [link["name"] for link in scene["links"]]
        places = tab.evaluate("names => names.map(name => linkforge.transform(name))", names)
        pin.framesForwardKinematics(model, data, configuration(model, positions))
        for name, place in zip(names, places, strict=True):
            expected = data.oMf[model.getFrameId(name, pin.BODY)].homogeneous
            assert np.allclose(np.reshape(place, (4, 4)), expected, rtol=0, atol=1e-6), name


def random_positions(joints: list[SceneJoint], chance: random.Random) -> dict[str, float]:
    """Return a position of each movable joint: within the limits, or where a mimic joint follows."""
    by_name = {joint["name"]: joint for joint in joints if joint["type"] in ("revolute", "continuous", "prismatic")}
    free = {
        name: chance.uniform(-3 if joint["lower"] is None else joint["lower"], joint["upper"] or 3)
        for name, joint in by_name.items()
    }

    def position(name: str) -> float:
        mimic = by_name[name]["mimic"]
        return mimic["multiplier"] * position(mimic["joint"]) + mimic["offset"] if mimic else free[name]

    return {name: position(name) for name in by_name}


def configuration(model: Any, positions: dict[str, float]) -> np.ndarray:
    q = pytest.importorskip("pinocchio").neutral(model)  # where the page has planar and floating joints
    for name, position in positions.items():
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = (
            position if joint.nq == 1 else (np.cos(position), np.sin(position))  # a continuous joint
        )
    return q


@pytest.mark.parametrize("example", EXAMPLES)
def test_links_of_examples_are_where_pinocchio_has_them(example: str, show: Callable[[str], Any]):
    robot = compile_file(ROOT / "examples" / f"{example}.robot.yaml").result()
    require_links_where_pinocchio_has_them(robot, show)


@pytest.mark.parametrize("name", CORPUS)
def test_links_of_real_robots_are_where_pinocchio_has_them(name: str, shared: Path, show: Callable[[str], Any]):
    robot = compile_file(shared / "corpus" / f"{name}.urdf").result()
    require_links_where_pinocchio_has_them(robot, show)


def test_links_of_every_kind_of_joint_are_where_pinocchio_has_them(show: Callable[[str], Any]):
    require_links_where_pinocchio_has_them(compile_text(ALL_KINDS).result(), show)
