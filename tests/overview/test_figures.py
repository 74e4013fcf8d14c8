"""Figures of robots, compared with what Pinocchio and trimesh find."""

import sysconfig
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import trimesh

from linkforge_compile import check_file, compile_text, render_urdf
from linkforge_compile.core import Robot
from linkforge_compile.overview.extent import reaches_from, zero_poses
from linkforge_compile.overview.figures import Figures, figures_of, mass_of
from linkforge_compile.overview.figures_text import render_figures
from tests.conftest import ROOT
from tests.consumers import pinocchio_model

pinocchio = pytest.importorskip("pinocchio")

REAL = Path(sysconfig.get_path("purelib")) / "cmeel.prefix/share/example-robot-data/robots"
ROBOTS = [
    ROOT / "examples/02_ur5e/ur5e.robot.yaml",
    ROOT / "examples/05_gripper/robotiq_2f_85.robot.yaml",
    ROOT / "examples/08_hand/hand.robot.yaml",
    ROOT / "examples/09_mobile_manipulator/mobile_manipulator.robot.yaml",
    REAL / "tiago_description/robots/tiago.urdf",
    REAL / "panda_description/urdf/panda.urdf",
    REAL / "pr2_description/urdf/pr2.urdf",
]

SLIDER = """\
linkforge: 1
name: slider
links:
  base: {inertial: {mass: 2 kg, origin: [0.1, 0.2, 0.3], inertia: {ixx: 1, iyy: 1, izz: 1}}}
  rail: {inertial: {mass: 1 kg, origin: {xyz: [0, 0, 0.4], rpy: [1, 2, 3]}, inertia: {ixx: 1, iyy: 1, izz: 1}}}
  carriage: {inertial: {mass: 0 kg, inertia: {ixx: 0, iyy: 0, izz: 0}}}
  follower: {inertial: {mass: 3 kg, origin: [0, 1, 0], inertia: {ixx: 1, iyy: 1, izz: 1}}}
  tip: {}
joints:
  turn: {type: continuous, parent: base, child: rail, axis: [1, 2, 2],
         origin: {xyz: [0.3, 0, 0.1], rpy: [0.4, 0.5, 0.6]}}
  slide: {type: prismatic, parent: rail, child: carriage, axis: [1, 1, 0], origin: {xyz: [0.1, 0.2, 0], rpy: [1, 0, 2]},
          limits: {lower: -80 cm, upper: 20 cm, effort: 1, velocity: 1}}
  follow: {type: prismatic, parent: carriage, child: follower, axis: -z, origin: [0, 0, 0.2],
           limits: {lower: -1 m, upper: 3 m, effort: 1, velocity: 1},
           mimic: {joint: slide, multiplier: -2, offset: 30 cm}}
  end: {type: fixed, parent: follower, child: tip, origin: [0, 0, 0.7]}
"""


def robot_of(path: Path) -> Robot:
    if not path.is_file():
        pytest.skip("example-robot-data is not installed")
    robot = check_file(path).robot
    assert robot is not None, path
    return robot


def names_of(path: Path) -> str:
    return path.name.partition(".")[0]


@pytest.fixture(scope="module", params=[None, *ROBOTS], ids=lambda path: names_of(path) if path else "slider")
def robot(request: pytest.FixtureRequest) -> Robot:
    return robot_of(request.param) if request.param else compile_text(SLIDER).result()


def test_the_centre_of_mass_is_that_of_pinocchio(robot: Robot):
    model = pinocchio_model(render_urdf(robot), free_flyer=True)
    theirs = pinocchio.centerOfMass(model, model.createData(), pinocchio.neutral(model))
    mass = mass_of(robot, zero_poses(robot))
    assert mass.total == pytest.approx(pinocchio.computeTotalMass(model), abs=1e-9)
    assert mass.centre == pytest.approx(theirs.tolist(), abs=1e-9)


def test_links_are_where_pinocchio_places_them_at_zero(robot: Robot):
    model = pinocchio_model(render_urdf(robot))
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, pinocchio.neutral(model))
    for link, pose in zero_poses(robot).items():
        placement = data.oMf[model.getFrameId(link, pinocchio.FrameType.BODY)]
        assert pose.xyz == pytest.approx(placement.translation.tolist(), abs=1e-9)
        turned = placement.rotation @ np.array([1.0, 2.0, 3.0])
        assert pose.turn.turned((1.0, 2.0, 3.0)) == pytest.approx(turned.tolist(), abs=1e-9)


def random_positions(model, generator: np.random.Generator) -> np.ndarray:
    """Return positions of which each third is at a limit."""
    lower, upper = model.lowerPositionLimit, model.upperPositionLimit
    share = np.clip(generator.uniform(-0.5, 1.5, model.nq), 0, 1)
    positions = lower + share * (upper - lower)
    for joint in model.joints:
        if joint.nq == 2 and joint.nv == 1:
            angle = generator.uniform(-np.pi, np.pi)
            positions[joint.idx_q : joint.idx_q + 2] = np.cos(angle), np.sin(angle)
    return positions


def test_no_sampled_position_is_out_of_reach(robot: Robot):
    urdf = render_urdf(robot)
    try:
        model = pinocchio.buildModelFromXML(urdf, True)  # joints with mimic follow
    except ValueError:  # the leader comes later, which Pinocchio does not read: all joints move freely
        model = pinocchio_model(urdf)
    data, generator = model.createData(), np.random.default_rng(7)
    root = next(iter(zero_poses(robot)))
    bounds = {link: reach.bound for link, reach in reaches_from(robot, root).items()}
    frames = {link: model.getFrameId(link, pinocchio.FrameType.BODY) for link in bounds}
    farthest = dict.fromkeys(bounds, 0.0)
    for _ in range(200):
        pinocchio.framesForwardKinematics(model, data, random_positions(model, generator))
        for link, frame in frames.items():
            farthest[link] = max(farthest[link], np.linalg.norm(data.oMf[frame].translation))
    assert set(bounds) == {link.name for link in robot.links}
    for link, distance in farthest.items():
        assert distance <= bounds[link] + 1e-9, link


def test_the_reach_of_a_straight_chain_is_exact():
    links = "".join(f"  l{number}: {{}}\n" for number in range(5))
    joints = "".join(
        f"  j{a}: {{type: continuous, parent: l{a}, child: l{b}, axis: z, origin: [{b}, 0, 0]}}\n"
        for a, b in pairwise(range(5))
    )
    figures = figures_of(compile_text(f"linkforge: 1\nname: chain\nlinks:\n{links}joints:\n{joints}").result())
    assert figures.reach == (10.0, "l0", "l4")


def test_links_below_a_floating_joint_have_no_reach():
    spec = "linkforge: 1\nname: free\nlinks: {a: {}, b: {}, c: {}}\njoints:\n"
    spec += "  f: {type: floating, parent: a, child: b}\n  g: {type: fixed, parent: b, child: c}\n"
    figures = figures_of(compile_text(spec).result())
    assert (figures.reach, figures.degrees_of_freedom) == ((0.0, "a", "a"), 6)
    assert (figures.mass.centre, list(figures.mass.links_without)) == (None, ["a", "b", "c"])


SHAPES = """\
linkforge: 1
name: shapes
links:
  base: {}
  tilted:
    visual:
      - {GEOMETRY, origin: {xyz: [0.1, -0.2, 0.3], rpy: [0.3, 0.7, -1.1]}}
joints:
  mount: {type: fixed, parent: base, child: tilted, origin: {xyz: [1, 2, 3], rpy: [0.2, -0.4, 0.9]}}
"""

GEOMETRIES = {
    "box: [0.2, 0.4, 0.6]": trimesh.creation.box((0.2, 0.4, 0.6)),
    "sphere: 0.3": trimesh.creation.icosphere(subdivisions=5, radius=0.3),
    "cylinder: {radius: 0.2, length: 0.7}": trimesh.creation.cylinder(0.2, 0.7, sections=4096),
    "capsule: {radius: 0.2, length: 0.7}": trimesh.creation.capsule(0.7, 0.2, count=[256, 256]),
    "mesh: {file: part.stl, scale: [0.5, -2, 3]}": trimesh.creation.icosphere(subdivisions=2, radius=0.1),
}


@pytest.mark.parametrize("geometry", GEOMETRIES, ids=lambda text: text.partition(":")[0])
def test_the_size_is_that_of_the_turned_shape(geometry: str, tmp_path: Path):
    solid = GEOMETRIES[geometry].copy()
    if "mesh" in geometry:
        (tmp_path / "part.stl").write_bytes(solid.export(file_type="stl"))
        solid.vertices *= (0.5, -2, 3)
    elif "capsule" in geometry:
        solid.apply_translation(-solid.bounding_box.centroid)
    (tmp_path / "shapes.robot.yaml").write_text(SHAPES.replace("GEOMETRY", geometry))
    robot = robot_of(tmp_path / "shapes.robot.yaml")
    for turn, move in (((0.3, 0.7, -1.1), (0.1, -0.2, 0.3)), ((0.2, -0.4, 0.9), (1, 2, 3))):
        solid.apply_transform(trimesh.transformations.euler_matrix(*turn, "sxyz"))
        solid.apply_translation(move)
    box = figures_of(robot).extent.box
    assert box is not None
    assert [*box.low, *box.high] == pytest.approx(solid.bounds.flatten().tolist(), abs=1e-3)
    if "box" in geometry:
        assert [*box.low, *box.high] == pytest.approx(solid.bounds.flatten().tolist(), abs=1e-12)


def figures_in(folder: Path, **files: bytes) -> Figures:
    """Return the figures of a robot with a box and a mesh for each file, and one that is missing."""
    links = "".join(f"  {name}: {{visual: {{mesh: {name}.stl}}}}\n" for name in (*files, "missing"))
    joints = "".join(f"  to_{name}: {{type: fixed, parent: base, child: {name}}}\n" for name in (*files, "missing"))
    for name, content in files.items():
        (folder / f"{name}.stl").write_bytes(content)
    text = f"linkforge: 1\nname: r\nlinks:\n  base: {{visual: {{box: [1, 2, 3]}}}}\n{links}joints:\n{joints}"
    spec = folder / "r.robot.yaml"
    spec.write_text(text)
    return figures_of(robot_of(spec))


def test_meshes_that_cannot_be_measured_are_left_out_with_the_reason(tmp_path: Path):
    figures = figures_in(tmp_path, good=trimesh.creation.box((4, 1, 1)).export(file_type="stl"), bad=b"solid nothing")
    assert figures.extent.box is not None
    assert figures.extent.box.sides == pytest.approx((4, 2, 3))
    assert figures.extent.left_out.keys() == {"bad.stl", "missing.stl"}
    assert [(mesh.resource, mesh.size) for mesh in figures.meshes] == [
        ("good.stl", 684),
        ("bad.stl", 13),
        ("missing.stl", None),
    ]
    assert figures.meshes[-1].missing == figures.extent.left_out["missing.stl"] == "the file is not found"


def test_without_the_extra_only_primitive_shapes_are_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(__import__("sys").modules, "trimesh", None)
    figures = figures_in(tmp_path, good=trimesh.creation.box((4, 1, 1)).export(file_type="stl"))
    assert figures.extent.box is not None
    assert figures.extent.box.sides == pytest.approx((1, 2, 3))
    assert "linkforge-compile[mesh]" in figures.extent.left_out["good.stl"]


def test_a_mesh_outside_of_the_folders_of_a_spec_is_not_read(tmp_path: Path):
    (tmp_path / "own").mkdir()
    (tmp_path / "secret.stl").write_bytes(trimesh.creation.box((4, 1, 1)).export(file_type="stl"))
    spec = tmp_path / "own" / "r.robot.yaml"
    spec.write_text("linkforge: 1\nname: r\nlinks: {base: {visual: {mesh: ../secret.stl}}}\n")
    figures = figures_of(robot_of(spec))
    assert (figures.extent.box, figures.meshes[0].size) == (None, None)
    assert "outside" in (figures.meshes[0].missing or "")


def test_a_robot_of_a_millimetre_is_not_rounded_to_another_one():
    text = "linkforge: 1\nname: micro\nlinks: {chip: {visual: {box: [0.125 mm, 0.125 mm, 0.85 mm]}}}\n"
    lines = "\n".join(render_figures(figures_of(compile_text(text).result()), None))
    assert "0.000125 x 0.000125 x 0.00085 m" in lines
    assert "from [-6.25e-5, -6.25e-5," in lines
