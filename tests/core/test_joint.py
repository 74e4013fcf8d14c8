"""Joints: what each type needs, what none may be, and what a prefix reaches."""

import math

import pytest

from linkforge_compile.core.exceptions import RobotMathError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.joint import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)

X = Vector3(1, 0, 0)
DEGREES = {"fixed": 0, "revolute": 1, "continuous": 1, "prismatic": 1, "planar": 2, "floating": 6}
HAS_AXIS = {"revolute", "continuous", "prismatic", "planar"}
NEEDS_LIMITS = {"revolute", "prismatic"}


def refusal(make) -> RobotValidationError:
    with pytest.raises(RobotValidationError) as caught:
        make()
    return caught.value


def joint(kind: str, **fields) -> Joint:
    if kind in HAS_AXIS:
        fields.setdefault("axis", X)
    if kind in NEEDS_LIMITS:
        fields.setdefault("limits", JointLimits(-1, 1))
    return Joint("elbow", kind, "upper", "lower", **fields)


@pytest.mark.parametrize("kind", JointType)
def test_every_type_has_its_degrees_of_freedom_also_when_given_as_text(kind):
    assert joint(kind).degrees_of_freedom == joint(str(kind)).degrees_of_freedom == DEGREES[kind]


def test_an_unknown_type_is_stored_and_fails_on_use():
    with pytest.raises(KeyError):
        _ = joint("screw").degrees_of_freedom


@pytest.mark.parametrize("kind", JointType)
def test_an_axis_is_for_joints_that_move_along_one(kind):
    if kind in HAS_AXIS:
        assert refusal(lambda: joint(kind, axis=None)).field == ("axis",)
    else:
        assert refusal(lambda: joint(kind, axis=X)).field == ("axis",)


def test_limits_are_needed_optional_or_forbidden():
    for kind in NEEDS_LIMITS:
        assert refusal(lambda kind=kind: joint(kind, limits=None)).field == ("limits",)
    for kind in ("continuous", "planar", "floating"):
        assert joint(kind, limits=JointLimits()).limits == joint(kind, limits=JointLimits(effort=10.0)).limits
    assert refusal(lambda: joint("fixed", limits=JointLimits())).code is ValidationErrorCode.INVALID_VALUE


def test_a_fixed_joint_may_have_dynamics_mimic_and_calibration():
    assert joint("fixed", dynamics=JointDynamics(1), mimic=JointMimic("a"), calibration=JointCalibration(0.1))


@pytest.mark.parametrize(
    ("fields", "code", "target", "field"),
    [
        (("", "fixed", "a", "a"), ValidationErrorCode.NAME_EMPTY, "JointName", ("name",)),
        (("el bow", "fixed", "", "a"), ValidationErrorCode.INVALID_NAME, "JointName", ("name",)),
        (("elbow", "revolute", "", "a"), ValidationErrorCode.NAME_EMPTY, "ParentLink", ("parent",)),
        (("elbow", "revolute", "a", ""), ValidationErrorCode.NAME_EMPTY, "ChildLink", ("child",)),
        (("elbow", "revolute", "a", "a"), ValidationErrorCode.INVALID_VALUE, "JointTopology", ("child",)),
        (("elbow", "revolute", "a", "b"), ValidationErrorCode.INVALID_VALUE, "JointAxis", ("axis",)),
    ],
)
def test_names_are_checked_before_the_type(fields, code, target, field):
    error = refusal(lambda: Joint(*fields))
    assert (error.code, error.target, error.field) == (code, target, field)


def test_a_joint_from_a_link_to_itself_is_refused_in_the_words_that_scripts_look_for():
    assert "cannot be the same" in str(refusal(lambda: Joint("elbow", "fixed", "a", "a")))


@pytest.mark.parametrize("name", ["ur5e/wrist.3", "2nd_elbow", "-", "Ellbogengelenk-ä"])
def test_names_that_urdf_readers_accept_are_joint_names(name):
    assert Joint(name, JointType.FIXED, "a", "b").name == name


@pytest.mark.parametrize("axis", [(0, 0, 0), (1e-10, 0, 0), (2, 0, 0), (0.57735, 0.57735, 0.57735), (1e200, 0, 0)])
def test_an_axis_is_a_unit_vector_to_the_ninth_digit(axis):
    assert refusal(lambda: joint("continuous", axis=Vector3(*axis))).code is ValidationErrorCode.INVALID_VALUE


def test_an_axis_that_is_not_normalized_is_kept_with_the_unit_one():
    read = joint("continuous", axis_as_written=Vector3(2, 0, 0))
    assert read.axis_as_written == Vector3(2, 0, 0)
    assert read == joint("continuous")
    assert read.with_prefix("left_").axis_as_written == Vector3(2, 0, 0)


def test_a_prefix_reaches_the_joint_its_links_and_the_joint_it_follows():
    arm = joint("fixed", mimic=JointMimic("knee", 2, 0.5)).with_prefix("left_")
    assert (arm.name, arm.parent, arm.child, arm.mimic) == (
        "left_elbow",
        "left_upper",
        "left_lower",
        JointMimic("left_knee", 2, 0.5),
    )


def test_limits_may_be_one_sided_or_equal_and_default_to_ten_and_one():
    assert (JointLimits().effort, JointLimits().velocity) == (10.0, 1.0)
    assert JointLimits(lower=5).upper is None
    assert JointLimits(1, 1).lower == 1


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: JointLimits(1, 0), "lower"),
        (lambda: JointLimits(effort=-1), "effort"),
        (lambda: JointLimits(velocity=-1), "velocity"),
        (lambda: JointLimits(effort=-math.inf), "effort"),
        (lambda: JointDynamics(damping=-1), "damping"),
        (lambda: JointDynamics(friction=-1), "friction"),
    ],
)
def test_what_cannot_be_is_out_of_range(make, field):
    error = refusal(make)
    assert error.code is ValidationErrorCode.OUT_OF_RANGE
    assert error.field == (field,)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
@pytest.mark.parametrize(
    ("kind", "field"),
    [
        (JointLimits, "upper"),
        (JointLimits, "effort"),
        (JointDynamics, "friction"),
        (lambda **bad: JointMimic("knee", **bad), "multiplier"),
        (JointSafetyController, "k_velocity"),
        (JointCalibration, "falling"),
    ],
)
def test_nan_and_infinity_are_refused(kind, field, bad):
    with pytest.raises(RobotMathError) as caught:
        kind(**{field: bad})
    assert caught.value.field == (field,)
