"""Vectors, poses and shapes."""

import math

import pytest

from linkforge_compile.core.exceptions import RobotMathError, RobotPhysicsError, ValidationErrorCode
from linkforge_compile.core.models.geometry import (
    Box,
    Capsule,
    Color,
    Cylinder,
    Geometry,
    GeometryType,
    Material,
    Mesh,
    Sphere,
    Transform,
    Vector3,
)
from linkforge_compile.core.models.joint import Joint, JointType

NO_NUMBERS = [math.nan, math.inf, -math.inf, 10**400]


def test_a_vector_unpacks_and_prints_its_numbers_as_they_were_given():
    x, y, z = Vector3(1, 2.0, -0.5)
    assert (x, y, z) == Vector3(1, 2.0, -0.5).to_tuple() == (1, 2.0, -0.5)
    assert str(Vector3(1, 2.0, 1e-7)) == "1 2.0 1e-07"


@pytest.mark.parametrize("number", NO_NUMBERS)
@pytest.mark.parametrize("position", [0, 1, 2])
def test_a_vector_refuses_what_is_no_number_at_its_position(number, position):
    numbers = [0.0, 0.0, 0.0]
    numbers[position] = number
    with pytest.raises(RobotMathError) as caught:
        Vector3(*numbers)
    assert caught.value.code is ValidationErrorCode.INVALID_VALUE
    assert caught.value.field == (position,)


def test_identity_is_the_default_pose_of_a_part():
    assert Transform.identity() == Transform() == Transform(Vector3(0, 0, 0), Vector3(0, 0, 0))
    assert str(Transform(Vector3(1, 2, 3))) == "xyz: 1 2 3, rpy: 0.0 0.0 0.0"


@pytest.mark.parametrize(
    ("shape", "kind", "volume"),
    [
        (Box(Vector3(1, 2, 3)), GeometryType.BOX, 6),
        (Cylinder(1, 2), GeometryType.CYLINDER, 2 * math.pi),
        (Sphere(3), GeometryType.SPHERE, 36 * math.pi),
        (Capsule(3, 2), GeometryType.CAPSULE, (18 + 36) * math.pi),
    ],
)
def test_a_shape_knows_its_kind_and_volume(shape, kind, volume):
    assert shape.type is kind
    assert shape.volume() == pytest.approx(volume, rel=1e-15)
    assert isinstance(shape, Geometry)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda bad: Box(Vector3(1, bad, 1)), (1,)),
        (lambda bad: Cylinder(bad, 1), ("radius",)),
        (lambda bad: Cylinder(1, bad), ("length",)),
        (Sphere, ("radius",)),
        (lambda bad: Capsule(bad, 1), ("radius",)),
        (lambda bad: Capsule(1, bad), ("length",)),
    ],
)
@pytest.mark.parametrize("bad", [0, -1.5])
def test_every_dimension_is_positive(make, field, bad):
    with pytest.raises(RobotPhysicsError, match="must be positive") as caught:
        make(bad)
    assert caught.value.code is ValidationErrorCode.PHYSICS_VIOLATION
    assert caught.value.field == field


@pytest.mark.parametrize("make", [Sphere, lambda bad: Cylinder(1, bad), lambda bad: Capsule(bad, 1)])
def test_a_dimension_is_a_number(make):
    for bad in (math.nan, math.inf):
        with pytest.raises(RobotMathError):
            make(bad)


def test_box_dimensions_are_refused_in_the_words_that_scripts_look_for():
    with pytest.raises(RobotPhysicsError, match="dimensions must be positive"):
        Box(Vector3(0, 1, 1))


def test_a_mesh_may_be_mirrored_and_nameless_but_not_flat():
    assert Mesh("").scale == Vector3(1, 1, 1)
    assert Mesh("hand.stl", Vector3(1, -1, 1)).type is GeometryType.MESH
    assert not hasattr(Mesh(""), "volume")
    with pytest.raises(RobotPhysicsError) as caught:
        Mesh("hand.stl", Vector3(1, 1, 0))
    assert caught.value.field == ("scale", 2)


@pytest.mark.parametrize("numbers", [[1, 2, 3], (1, 2, 3)])
def test_a_list_of_numbers_becomes_what_the_type_names(numbers):
    vector = Vector3(1, 2, 3)
    assert Box(numbers).size == Mesh("package://p/a.stl", scale=numbers).scale == Transform(numbers).xyz == vector
    assert Box(numbers).volume() == 6
    assert hash(Box(numbers)) == hash(Box(vector))
    assert Material("m", [1, 0, 0, 0.5]).color == Color(1, 0, 0, 0.5)
    assert Joint("j", JointType.CONTINUOUS, "a", "b", axis=[0, 0, 1]).axis == Vector3(0, 0, 1)


def test_a_list_with_a_number_that_is_refused_is_refused():
    with pytest.raises(RobotMathError):
        Box([1, 2, math.inf])
