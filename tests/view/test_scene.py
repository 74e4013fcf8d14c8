"""The scene of a robot, against what Pinocchio and the spec say."""

import json
from pathlib import Path

import numpy as np
import pytest

from linkforge_compile import compile_file, compile_text, render_urdf
from linkforge_compile.core import Joint, JointType, Link, Robot
from linkforge_compile.core.models.joint import JointLimits
from linkforge_compile.view.files import RobotFiles, collect_files
from linkforge_compile.view.scene import Scene, make_scene
from tests.consumers import pinocchio_model

EXAMPLES = Path(__file__).parents[2] / "examples"
HEAD = "linkforge: 1\nname: r\n"


def scene_of(text: str) -> Scene:
    robot = compile_text(HEAD + text).result()
    return json.loads(json.dumps(make_scene(robot, collect_files(robot))))


def matrix(pose) -> np.ndarray:
    pin = pytest.importorskip("pinocchio")
    return pin.SE3(pin.Quaternion(np.array(pose["quaternion"])), np.array(pose["xyz"])).homogeneous


@pytest.mark.parametrize("example", ["07_quadruped/quadruped", "08_hand/hand", "02_ur5e/ur5e"])
def test_links_are_where_pinocchio_has_them(example: str):
    pin = pytest.importorskip("pinocchio")
    robot = compile_file(EXAMPLES / f"{example}.robot.yaml").result()
    scene = make_scene(robot, RobotFiles())
    model = pinocchio_model(render_urdf(robot))
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    joints = {joint["name"]: joint for joint in scene["joints"]}
    places = {}
    for link in scene["links"]:
        above = joints.get(link["parent"])
        places[link["name"]] = places[above["parent"]] @ matrix(above["origin"]) if above else np.eye(4)
        frame = data.oMf[model.getFrameId(link["name"])].homogeneous
        assert np.allclose(places[link["name"]], frame, atol=1e-9), link["name"]
    assert sum(link["mass"] or 0 for link in scene["links"]) == pytest.approx(sum(body.mass for body in model.inertias))


def test_a_computed_inertia_is_that_of_the_body():
    scene = scene_of("links: {a: {collision: {box: [1, 2, 3], origin: [0, 0, 1]}, inertial: {mass: 12}}}")
    (link,) = scene["links"]
    assert (link["mass"], link["center"]) == (12, [0, 0, 1])
    assert link["inertia"]["moments"] == pytest.approx([13, 10, 5, 0, 0, 0])


def test_shapes_have_sizes_colors_and_names():
    scene = scene_of("""
links:
  a:
    visual:
      - name: body
        box: [1, 2, 3]
        origin: {xyz: [0, 0, 1], rpy: [0, 0, 90 deg]}
        material: {name: red, color: [1, 0, 0]}
      - {cylinder: {radius: 1, length: 2}}
      - {capsule: {radius: 0.5, length: 2}}
    collision: {sphere: 0.5}
""")
    body, cylinder, capsule = scene["links"][0]["visuals"]
    assert (body["type"], body["size"], body["name"], body["color"]) == ("box", [1, 2, 3], "body", [1, 0, 0, 1])
    assert body["origin"]["xyz"] == [0, 0, 1]
    assert body["origin"]["quaternion"] == pytest.approx([0, 0, 0.5**0.5, 0.5**0.5])
    assert (cylinder["radius"], cylinder["length"]) == (1, 2)
    assert (capsule["type"], capsule["radius"], capsule["length"]) == ("capsule", 0.5, 2)
    assert "color" not in cylinder
    assert scene["links"][0]["collisions"][0]["radius"] == 0.5


JOINTS = """
links: {a: {}, b: {}, c: {}, d: {}, e: {}}
joints:
  turn: {type: continuous, parent: a, child: b, axis: [0, 0, 2]}
  bend: {type: revolute, parent: b, child: c, axis: x, limits: {lower: 1, upper: 3, effort: 5, velocity: 2}}
  slide: {type: prismatic, parent: c, child: d, axis: y, limits: {lower: -1, upper: 3, effort: 5, velocity: 2},
          mimic: {joint: bend, multiplier: 2, offset: -0.5}}
  free: {type: floating, parent: a, child: e}
semantic:
  groups: {arm: {joints: [bend]}}
  group_states: {arm: {home: {bend: 90 deg}}}
"""


def test_joints_have_limits_axes_and_where_they_start():
    scene = scene_of(JOINTS)
    joints = {joint["name"]: joint for joint in scene["joints"]}
    assert list(joints) == ["turn", "bend", "slide", "free"]
    assert (joints["turn"]["axis"], joints["turn"]["lower"], joints["turn"]["upper"]) == ([0, 0, 1], None, None)
    assert [joints["bend"][key] for key in ("lower", "upper", "effort", "velocity", "value")] == [1, 3, 5, 2, 2]
    assert joints["slide"]["mimic"] == {"joint": "bend", "multiplier": 2, "offset": -0.5}
    assert joints["slide"]["value"] == 0
    assert (joints["free"]["axis"], joints["free"]["lower"]) == (None, None)
    (home,) = scene["states"]
    assert (home["name"], home["group"]) == ("home", "arm")
    assert home["positions"]["bend"] == pytest.approx([np.pi / 2])


def test_a_part_has_its_place_and_its_module(tmp_path: Path):
    (tmp_path / "hand.robot.yaml").write_text("linkforge: 1\nname: hand\nlinks:\n  palm: {}\n", "utf-8")
    (tmp_path / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nlinks: {base: {}}\nmodules: {hand: {use: hand.robot.yaml, parent: base}}\n", "utf-8"
    )
    top = tmp_path / "top.robot.yaml"
    top.write_text(HEAD + "links: {stand: {}}\nmodules: {left: {use: arm.robot.yaml, parent: stand}}\n", "utf-8")
    robot = compile_file(top).result()
    scene = make_scene(robot, RobotFiles())
    modules = {link["name"]: link["module"] for link in scene["links"]}
    assert modules == {"stand": "", "left_base": "left", "left_hand_palm": "left/hand"}
    palm = next(link for link in scene["links"] if link["name"] == "left_hand_palm")
    assert Path(palm["source"]["file"]).name == "hand.robot.yaml"
    assert (palm["source"]["line"], palm["source"]["column"]) == (4, 3)


def test_any_graph_has_a_scene():
    def fixed(name: str, parent: str, child: str) -> Joint:
        return Joint(name, JointType.FIXED, parent, child)

    assert make_scene(Robot("empty"), RobotFiles())["links"] == []
    links = [Link(name) for name in "abcdef"]
    loops = [fixed("ab", "a", "b"), fixed("ac", "a", "c"), fixed("cb", "c", "b"), fixed("ef", "e", "f")]
    scene = make_scene(Robot("loops", links=links, joints=[*loops, fixed("fe", "f", "e")]), RobotFiles())
    assert {link["name"]: link["parent"] for link in scene["links"]} == {
        "a": None,
        "b": "ab",
        "c": "ac",
        "d": None,
        "e": None,
        "f": None,
    }
    assert [joint["name"] for joint in scene["joints"]] == ["ab", "ac"]


def test_a_joint_starts_within_its_limits():
    limits = JointLimits(lower=0.5, upper=1.5, effort=1, velocity=1)
    assert Joint("j", JointType.REVOLUTE, "a", "b", axis=[1.0, 0.0, 0.0], limits=limits).default_position == 1
