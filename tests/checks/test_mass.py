import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.checks.extents import extent_of
from linkforge_compile.core import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    InertiaTensor,
    Link,
    Mesh,
    Robot,
    Sphere,
    Transform,
    Vector3,
)
from linkforge_compile.core.physics import inertial_of_shapes
from tests.checks.robots import fixed, told

BEAM = Box(Vector3(0.3, 0.04, 0.04))
SLANTED = Transform(rpy=Vector3(0.3, 0.0, math.pi / 4))


def of(inertial: Inertial, geometry: Geometry = BEAM, pose: Transform = SLANTED) -> Robot:
    return Robot("r", links=[Link("a", inertial, collisions=[Collision(geometry, pose)])])


def scaled(tensor: InertiaTensor, factor: float, products: float = 1.0) -> InertiaTensor:
    moments = [factor * one for one in (tensor.ixx, tensor.iyy, tensor.izz)]
    return InertiaTensor(*moments, *(factor * products * one for one in (tensor.ixy, tensor.ixz, tensor.iyz)))


sizes = st.floats(0.01, 2.0)
shapes = (
    st.builds(Box, st.builds(Vector3, sizes, sizes, sizes))
    | st.builds(Cylinder, sizes, sizes)
    | st.builds(Sphere, sizes)
)
angles = st.floats(-3.0, 3.0)
poses = st.builds(Transform, st.builds(Vector3, sizes, sizes, sizes), st.builds(Vector3, angles, angles, angles))


@given(shapes, poses, st.floats(100.0, 10_000.0))
def test_whatever_is_computed_from_shapes_is_fine(shape: Geometry, pose: Transform, density: float):
    assert told(of(inertial_of_shapes([(shape, pose)], density=density), shape, pose)) == []


@pytest.mark.parametrize(
    ("factor", "unit"), [(1e3, "g*m^2"), (1e4, "kg*cm^2"), (1e6, "kg*mm^2"), (1e7, "g*cm^2"), (1e9, "g*mm^2")]
)
def test_an_inertia_in_another_unit_is_told_with_the_unit(factor: float, unit: str):
    right = inertial_of_shapes([(BEAM, SLANTED)], mass=2.0)
    (message,) = told(of(Inertial(2.0, right.origin, scaled(right.inertia, factor))))
    assert message.startswith("LF6032 inertia of link 'a' is ")
    assert message.endswith(f"; write the unit if it is in {unit}")


@pytest.mark.parametrize("products", [-1.0, -0.8])
def test_products_of_the_other_sign_are_told(products: float):
    right = inertial_of_shapes([(BEAM, SLANTED)], mass=2.0)
    (message,) = told(of(Inertial(2.0, right.origin, scaled(right.inertia, 1.0, products))))
    assert message.startswith("LF6036")


def test_products_are_compared_in_the_axes_of_the_link():
    straight = inertial_of_shapes([(BEAM, Transform())], mass=2.0).inertia
    assert told(of(Inertial(2.0, SLANTED, straight))) == []


def test_a_hollow_or_lopsided_body_is_fine():
    right = inertial_of_shapes([(BEAM, SLANTED)], mass=2.0)
    for factor in (0.05, 3.0):
        assert told(of(Inertial(2.0, Transform(Vector3(0.1, 0, 0)), scaled(right.inertia, factor)))) == []


def test_meshes_are_not_measured():
    tiny = InertiaTensor(1e-9, 1e-9, 1e-9)
    assert told(of(Inertial(1e5, Transform(Vector3(0, 0, 50)), tiny), Mesh("package://nowhere/a.stl"))) == []


def test_small_parts_of_the_whole_are_not_judged():
    marker = Link(
        "imu", Inertial(0.001, inertia=InertiaTensor(1e-3, 1e-3, 1e-3)), collisions=[Collision(Sphere(0.0005))]
    )
    base = Link("base", inertial_of_shapes([(BEAM, Transform())], mass=2.0), collisions=[Collision(BEAM)])
    assert told(Robot("r", links=[base, marker], joints=[fixed("glue", "base", "imu")])) == []
    assert [one[:6] for one in told(Robot("r", links=[marker]))] == ["LF6031", "LF6032"]


def test_the_box_around_shapes_holds_them_turned_and_moved():
    extent = extent_of(
        [Collision(BEAM, Transform(Vector3(1, 0, 0), Vector3(0, 0, math.pi / 2))), Collision(Sphere(0.1))]
    )
    assert extent is not None
    assert extent.low == pytest.approx((-0.1, -0.15, -0.1))
    assert extent.high == pytest.approx((1.02, 0.15, 0.1))
    assert extent.distance((1.02, 0.15, 0.5)) == pytest.approx(0.4)
    assert extent.distance((0, 0, 0)) == 0
