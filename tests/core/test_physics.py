"""Inertia of primitives: the textbook's values, and the laws that hold for any body."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.core.exceptions import RobotMathError, RobotPhysicsError, ValidationErrorCode
from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Mesh, Sphere, Transform, Vector3
from linkforge_compile.core.models.link import Inertial, InertiaTensor
from linkforge_compile.core.physics import (
    calculate_inertia,
    combined_inertial,
    inertial_of_shapes,
    rotated,
    rotation_matrix,
    shifted,
)
from tests.strategies import boxes, inertials, poses, primitives, rotations, sizes, tensors, vectors

HERE = Transform.identity()


def entries(tensor: InertiaTensor) -> tuple[float, ...]:
    return (tensor.ixx, tensor.iyy, tensor.izz, tensor.ixy, tensor.ixz, tensor.iyz)


def same(left: InertiaTensor, right: InertiaTensor, scale: float = 0.0) -> bool:
    size = max(scale, *(abs(entry) for entry in (*entries(left), *entries(right))))
    return entries(left) == pytest.approx(entries(right), rel=1e-9, abs=1e-12 * size)


@pytest.mark.parametrize(
    ("shape", "ixx", "izz"),
    [
        (Box(Vector3(1, 1, 2)), 12 * (1 + 4) / 12, 12 * (1 + 1) / 12),
        (Cylinder(2, 3), 12 * (3 * 4 + 9) / 12, 12 * 4 / 2),
        (Sphere(5), 12 * 2 / 5 * 25, 12 * 2 / 5 * 25),
    ],
)
def test_the_textbook_values(shape, ixx, izz):
    assert calculate_inertia(shape, 12) == InertiaTensor(ixx, ixx, izz)


def test_a_capsule_lies_between_the_ball_and_the_rod_that_it_becomes():
    assert same(calculate_inertia(Capsule(1, 1e-12), 3), calculate_inertia(Sphere(1), 3))
    assert same(calculate_inertia(Capsule(1e-12, 1), 3), calculate_inertia(Cylinder(1e-12, 1), 3))


def test_a_capsule_weighs_as_its_slices_do():
    capsule, count = Capsule(0.3, 0.5), 4000
    reach = capsule.length / 2 + capsule.radius
    across = along = volume = 0.0
    for index in range(count):
        height = reach * ((2 * index + 1) / count - 1)
        beyond = max(0.0, abs(height) - capsule.length / 2)
        disc = math.pi * (capsule.radius**2 - beyond**2) * (2 * reach / count)
        radius_squared = capsule.radius**2 - beyond**2
        volume += disc
        along += disc * radius_squared / 2
        across += disc * (radius_squared / 4 + height * height)
    tensor = calculate_inertia(capsule, capsule.volume())
    assert capsule.volume() == pytest.approx(volume, rel=1e-6)
    assert (tensor.ixx, tensor.izz) == pytest.approx((across, along), rel=1e-6)


def test_light_bodies_are_as_exact_as_heavy_ones():
    assert calculate_inertia(Sphere(1), 5e-9) == InertiaTensor(2e-9, 2e-9, 2e-9)
    assert calculate_inertia(Sphere(1), 0) == InertiaTensor(0, 0, 0)


def test_a_mesh_is_no_cube():
    with pytest.raises(RobotPhysicsError, match="is not a primitive") as caught:
        calculate_inertia(Mesh("hand.stl"), 1)
    assert caught.value.code is ValidationErrorCode.INVALID_VALUE
    with pytest.raises(RobotPhysicsError, match=r"hand\.stl"):
        inertial_of_shapes([(Sphere(1), HERE), (Mesh("hand.stl"), HERE)], mass=1)


def test_no_body_weighs_less_than_nothing():
    with pytest.raises(RobotPhysicsError):
        calculate_inertia(Sphere(1), -1)


def test_rpy_turns_about_x_first_and_z_last():
    quarter = math.pi / 2
    turn = rotation_matrix(Vector3(quarter, 0, quarter))
    y_axis_lands_at = tuple(row[1] for row in turn)
    assert y_axis_lands_at == pytest.approx((0, 0, 1), abs=1e-15)


def test_a_quarter_turn_about_z_swaps_x_and_y():
    turned = rotated(InertiaTensor(1, 2, 3, 0.1, 0.2, 0.3), Vector3(0, 0, math.pi / 2))
    assert same(turned, InertiaTensor(2, 1, 3, -0.1, -0.3, 0.2))


@given(tensors, rotations)
def test_turning_a_body_keeps_its_trace(tensor, rpy):
    turned = rotated(tensor, rpy)
    scale = max(1e-300, *(abs(entry) for entry in entries(tensor)))
    assert turned.ixx + turned.iyy + turned.izz == pytest.approx(
        tensor.ixx + tensor.iyy + tensor.izz, abs=1e-12 * scale
    )


@given(tensors, sizes, vectors)
def test_moving_there_is_moving_back(tensor, mass, lever_arm):
    opposite = Vector3(*(-number for number in lever_arm))
    assert shifted(tensor, mass, lever_arm) == shifted(tensor, mass, opposite)


@given(boxes, sizes, st.sampled_from([0, 1, 2]), poses)
def test_two_halves_of_a_box_are_the_box(box, mass, axis, pose):
    extents = list(box.size)
    quarter = extents[axis] / 4
    extents[axis] /= 2
    half = Box(Vector3(*extents))
    offset = [row[axis] * quarter for row in rotation_matrix(pose.rpy)]
    halves = [
        (half, Transform(Vector3(*(at + sign * step for at, step in zip(pose.xyz, offset, strict=True))), pose.rpy))
        for sign in (-1, 1)
    ]
    whole, sawn = inertial_of_shapes([(box, pose)], mass=mass), inertial_of_shapes(halves, mass=mass)
    # Far from the origin a place has few digits left, and so has what follows from differences of places.
    blur = 1e-9 * max(1, *(abs(number) for number in pose.xyz))
    assert sawn.mass == whole.mass == mass
    assert tuple(sawn.origin.xyz) == pytest.approx(tuple(whole.origin.xyz), abs=blur)
    assert same(sawn.inertia, whole.inertia, scale=mass * max(box.size) * max(1, blur * 1e12))


@given(st.lists(inertials.filter(lambda body: body.mass > 0), min_size=2, max_size=4))
def test_joining_in_two_steps_is_joining_in_one(bodies):
    at_once = combined_inertial(bodies)
    in_steps = combined_inertial([combined_inertial(bodies[:2]), *bodies[2:]])
    reach = max(1, *(abs(number) for body in bodies for number in body.origin.xyz))
    assert in_steps.mass == pytest.approx(at_once.mass, rel=1e-15)
    assert tuple(in_steps.origin.xyz) == pytest.approx(tuple(at_once.origin.xyz), abs=1e-9 * reach)
    assert same(in_steps.inertia, at_once.inertia, scale=at_once.mass * reach * reach)


def test_a_dumbbell_turns_about_its_common_centre():
    ball = InertiaTensor(0.1, 0.1, 0.1)
    dumbbell = combined_inertial(
        [Inertial(1, Transform(Vector3(0, 0, 3)), ball), Inertial(3, Transform(Vector3(0, 0, -1)), ball)]
    )
    assert dumbbell == Inertial(4, Transform(Vector3(0, 0, 0)), InertiaTensor(12.2, 12.2, 0.2))


@given(primitives, sizes, poses)
def test_one_shape_keeps_its_mass_and_place_exactly(shape, mass, pose):
    body = inertial_of_shapes([(shape, pose)], mass=mass)
    assert body.mass == mass
    assert body.origin == Transform(pose.xyz)
    assert body.inertia == rotated(calculate_inertia(shape, mass), pose.rpy)


@given(primitives, sizes)
def test_density_is_mass_by_volume(shape, density):
    body = inertial_of_shapes([(shape, HERE)], density=density)
    assert body.mass == density * shape.volume()


def test_mass_is_spread_by_volume():
    body = inertial_of_shapes(
        [(Box(Vector3(1, 1, 1)), HERE), (Box(Vector3(3, 1, 1)), Transform(Vector3(2, 0, 0)))], mass=4
    )
    assert (body.mass, body.origin) == (4, Transform(Vector3(1.5, 0, 0)))
    assert same(body.inertia, calculate_inertia(Box(Vector3(4, 1, 1)), 4))


@pytest.mark.parametrize(
    ("shapes", "amount", "code", "field"),
    [
        ([], {"mass": 1}, ValidationErrorCode.VALUE_EMPTY, ()),
        ([(Sphere(1), HERE)], {}, ValidationErrorCode.INVALID_VALUE, ("mass",)),
        ([(Sphere(1), HERE)], {"mass": 1, "density": 1}, ValidationErrorCode.INVALID_VALUE, ("mass",)),
        ([(Sphere(1), HERE)], {"mass": 0}, ValidationErrorCode.OUT_OF_RANGE, ("mass",)),
        ([(Sphere(1), HERE)], {"density": -1}, ValidationErrorCode.OUT_OF_RANGE, ("density",)),
        ([(Sphere(1e-150), HERE)], {"mass": 1}, ValidationErrorCode.OUT_OF_RANGE, ("volume",)),
    ],
)
def test_what_cannot_be_computed_is_refused(shapes, amount, code, field):
    with pytest.raises(RobotPhysicsError) as caught:
        inertial_of_shapes(shapes, **amount)
    assert caught.value.code is code
    assert caught.value.field == field


@pytest.mark.parametrize("amount", [{"mass": math.nan}, {"mass": math.inf}, {"density": 1e308}])
def test_what_no_double_holds_is_refused(amount):
    with pytest.raises(RobotMathError):
        inertial_of_shapes([(Sphere(1), HERE), (Box(Vector3(9, 9, 9)), HERE)], **amount)


def test_bodies_without_mass_have_no_centre():
    with pytest.raises(RobotPhysicsError, match="must be above 0"):
        combined_inertial([Inertial(0), Inertial(0)])
