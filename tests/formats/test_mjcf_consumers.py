"""MuJoCo finds in our MJCF what Pinocchio finds in our URDF: masses, freedom, and where links are."""

from pathlib import Path

import numpy
import pytest

from linkforge_compile import compile_file
from linkforge_compile.core import Robot
from linkforge_compile.diagnostics.codes.simulators import IMPOSSIBLE_FOR_MUJOCO, MASSLESS_IN_MUJOCO
from linkforge_compile.formats import MJCF
from linkforge_compile.formats.render import render_urdf
from tests.conftest import ROOT
from tests.consumers import mjcf_model, pinocchio_model
from tests.importers.robots import OF_EXAMPLES, STEP

mujoco = pytest.importorskip("mujoco")
pinocchio = pytest.importorskip("pinocchio")

EXAMPLES = sorted((ROOT / "examples").rglob("*.robot.yaml"))
TOLERANCE = 1e-9


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_the_same_to_mujoco_and_pinocchio(path: Path):
    robot = compile_file(path).robot
    assert robot is not None
    require_same_kinematics(robot)
    require_same_dynamics(robot)


@pytest.mark.parametrize("path", OF_EXAMPLES[::STEP], ids=lambda path: path.stem)
def test_real_robots_are_the_same_to_mujoco_and_pinocchio(path: Path):
    """Their meshes are loaded as well; where a tensor was changed for MuJoCo, and reported, dynamics differ."""
    robot = compile_file(path).robot
    assert robot is not None
    require_same_kinematics(robot, states=10)
    codes = {one.code for one in MJCF.limits(robot, {"base": "free"})}
    if not codes & {IMPOSSIBLE_FOR_MUJOCO, MASSLESS_IN_MUJOCO}:
        require_same_dynamics(robot)


def require_same_kinematics(robot: Robot, states: int = 100) -> None:
    """Compare the poses of all links at random states, with the root link at the origin."""
    ours, reference = mjcf_model(robot), pinocchio_model(render_urdf(robot))
    data, data_of_reference = mujoco.MjData(ours), reference.createData()
    assert ours.nv == reference.nv
    root = root_name(robot)
    names = list(robot.links.names)
    bodies = [ours.body("world" if name == root == "world" else name).id for name in names]
    frames = [reference.getFrameId(name, pinocchio.FrameType.BODY) for name in names]
    for state in range(states):
        q = random_state(reference, seed=state)
        set_state(ours, data, reference, q)
        mujoco.mj_kinematics(ours, data)
        pinocchio.framesForwardKinematics(reference, data_of_reference, q)
        poses = [data_of_reference.oMf[frame] for frame in frames]
        positions, turns = [pose.translation for pose in poses], [pose.rotation.ravel() for pose in poses]
        numpy.testing.assert_allclose(data.xpos[bodies], positions, rtol=0, atol=TOLERANCE)
        numpy.testing.assert_allclose(data.xmat[bodies], turns, rtol=0, atol=TOLERANCE)


def require_same_dynamics(robot: Robot) -> None:
    """Compare the total mass, and the joint space inertia with a floating base, whose frame is at the origin."""
    if root_name(robot) == "world":
        return  # MuJoCo's world cannot float
    ours, reference = mjcf_model(robot, base="free"), pinocchio_model(render_urdf(robot), free_flyer=True)
    data, data_of_reference = mujoco.MjData(ours), reference.createData()
    mass = sum(inertia.mass for inertia in reference.inertias)
    assert ours.body_mass.sum() == pytest.approx(mass, abs=TOLERANCE)
    assert ours.nv == reference.nv
    q = random_state(reference, seed=1)
    q[:7] = 0, 0, 0, 0, 0, 0, 1
    set_state(ours, data, reference, q)
    mujoco.mj_kinematics(ours, data)
    mujoco.mj_comPos(ours, data)
    mujoco.mj_makeM(ours, data)
    found = numpy.zeros((ours.nv, ours.nv))
    mujoco.mj_fullM(ours, data, found)
    wanted = pinocchio.crba(reference, data_of_reference, q)
    wanted = numpy.triu(wanted) + numpy.triu(wanted, 1).T
    order = [*range(6), *(index_in(reference, ours.joint(number).name) for number in range(1, ours.njnt))]
    numpy.testing.assert_allclose(found, wanted[numpy.ix_(order, order)], rtol=0, atol=TOLERANCE * max(1, mass))


def root_name(robot: Robot) -> str:
    children = {joint.child for joint in robot.joints}
    return next(link.name for link in robot.links if link.name not in children)


def random_state(reference, seed: int) -> numpy.ndarray:
    return pinocchio.integrate(
        reference, pinocchio.neutral(reference), numpy.random.default_rng(seed).uniform(-3, 3, reference.nv)
    )


def index_in(reference, joint: str) -> int:
    return reference.joints[reference.getJointId(joint)].idx_v


def set_state(ours, data, reference, q: numpy.ndarray) -> None:
    """Set the positions of MuJoCo's joints to those of the joints of Pinocchio that have their names."""
    for number in range(ours.njnt):
        joint = ours.joint(number)
        if not reference.existJointName(joint.name):
            continue  # the base
        at = reference.joints[reference.getJointId(joint.name)]
        if at.nq == 1:
            data.qpos[joint.qposadr] = q[at.idx_q]
        else:  # a turn without bounds is a cosine and a sine
            cosine, sine = q[at.idx_q : at.idx_q + 2]
            data.qpos[joint.qposadr] = numpy.arctan2(sine, cosine)
