"""Real readers accept the output, and find the values of the robot in it."""

import pytest

from linkforge_compile.core.models.geometry import Capsule
from linkforge_compile.core.models.link import Collision, Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.formats.render import render_urdf
from tests.consumers import check_urdf, mujoco_model, pinocchio_model
from tests.formats.everything import everything

ROBOT = everything()


@pytest.mark.parametrize("pretty", [True, False])
def test_urdfdom_finds_the_root(pretty: bool):
    assert check_urdf(render_urdf(ROBOT, pretty=pretty, banner="made by us")) == "base"


def test_pinocchio_finds_the_same_mass_and_freedom():
    text = render_urdf(ROBOT)
    assert pinocchio_model(text).nv == ROBOT.degrees_of_freedom
    floating = pinocchio_model(text, free_flyer=True)
    assert sum(inertia.mass for inertia in floating.inertias) == pytest.approx(ROBOT.total_mass, rel=1e-12)


def test_mujoco_finds_the_same_mass_and_freedom():
    model = mujoco_model(render_urdf(ROBOT))
    assert model.nv == ROBOT.degrees_of_freedom
    assert sum(model.body_mass) == pytest.approx(ROBOT.total_mass, rel=1e-12)


def test_urdfdom_reads_a_capsule_because_the_file_states_its_version():
    text = render_urdf(Robot("r", links=[Link("base", collisions=[Collision(Capsule(0.1, 0.2))])]))
    assert check_urdf(text) == "base"
    with pytest.raises(AssertionError, match="capsule"):
        check_urdf(text.replace(' version="1.1"', ""))
