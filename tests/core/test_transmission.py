"""Transmissions and their two factories."""

import math

import pytest

from linkforge_compile.core.exceptions import RobotMathError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.transmission import (
    Transmission,
    TransmissionActuator,
    TransmissionJoint,
    TransmissionType,
)

J, K = TransmissionJoint("j"), TransmissionJoint("k")
A, B = TransmissionActuator("a"), TransmissionActuator("b")


def test_an_end_has_position_and_a_reduction_of_one_by_default():
    assert (J.hardware_interfaces, J.mechanical_reduction, J.offset) == (("position",), 1.0, 0.0)
    assert TransmissionJoint("j", mechanical_reduction=None).mechanical_reduction is None
    assert TransmissionActuator("a", ["effort"], -50).hardware_interfaces == ("effort",)


def test_a_joint_is_no_actuator():
    assert TransmissionJoint("a") != TransmissionActuator("a")


@pytest.mark.parametrize("end", [TransmissionJoint, TransmissionActuator])
@pytest.mark.parametrize(
    ("fields", "code", "field"),
    [
        ({"name": ""}, ValidationErrorCode.NAME_EMPTY, "name"),
        ({"name": "a", "hardware_interfaces": []}, ValidationErrorCode.VALUE_EMPTY, "hardware_interfaces"),
        ({"name": "a", "mechanical_reduction": 1e-10}, ValidationErrorCode.INVALID_VALUE, "mechanical_reduction"),
    ],
)
def test_an_end_needs_name_interface_and_reduction(end, fields, code, field):
    with pytest.raises(RobotValidationError) as caught:
        end(**fields)
    assert caught.value.code is code
    assert caught.value.field == (field,)


def test_nan_is_refused():
    with pytest.raises(RobotMathError):
        TransmissionJoint("j", mechanical_reduction=math.nan)


@pytest.mark.parametrize(
    ("fields", "code", "field"),
    [
        (("", "x", [J], [A]), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (("t t", "", [J], [A]), ValidationErrorCode.VALUE_EMPTY, ("type",)),
        (("t t", "x", [J], [A]), ValidationErrorCode.INVALID_NAME, ("name",)),
        (("t", "x", [], [A]), ValidationErrorCode.VALUE_EMPTY, ("joints",)),
        (("t", "x", [J], []), ValidationErrorCode.VALUE_EMPTY, ("actuators",)),
        (("t", TransmissionType.SIMPLE, [J, J], [A]), ValidationErrorCode.INVALID_VALUE, ("joints",)),
        (("t", TransmissionType.DIFFERENTIAL, [J, K], [A]), ValidationErrorCode.INVALID_VALUE, ("actuators",)),
        (("t", str(TransmissionType.FOUR_BAR_LINKAGE), [J], [A]), ValidationErrorCode.INVALID_VALUE, ("joints",)),
        (("t", "x", [J, J], [A]), ValidationErrorCode.DUPLICATE_NAME, ("joints", "j")),
        (("t", "x", [J], [A, A]), ValidationErrorCode.DUPLICATE_NAME, ("actuators", "a")),
    ],
)
def test_what_moves_nothing_or_too_much_is_refused(fields, code, field):
    with pytest.raises(RobotValidationError) as caught:
        Transmission(*fields)
    assert caught.value.code is code
    assert caught.value.field == field


def test_another_plugin_may_have_any_number_of_ends():
    assert len(Transmission("t", "acme/Cable", [J, K], [A]).joints) == 2


def test_a_simple_transmission_gives_the_reduction_to_the_joint():
    made = Transmission.create_simple("t", "j", mechanical_reduction=50, hardware_interfaces=["effort"])
    assert made == Transmission(
        "t",
        TransmissionType.SIMPLE,
        [TransmissionJoint("j", ("effort",), 50)],
        [TransmissionActuator("j_motor", ("effort",), 1.0)],
    )


def test_a_differential_transmission_names_unnamed_motors():
    made = Transmission.create_differential("t", "j", "k", actuator2_name="b", mechanical_reduction=2)
    assert [joint.mechanical_reduction for joint in made.joints] == [2, 2]
    assert [actuator.name for actuator in made.actuators] == ["j_motor", "b"]
    assert all(end.hardware_interfaces == ("position",) for end in (*made.joints, *made.actuators))


def test_a_prefix_reaches_joints_and_actuators_but_no_parameters():
    made = Transmission("t", "x", [J], [A], {"joint": "j"}).with_prefix("left_")
    assert (made.name, made.joints[0].name, made.actuators[0].name) == ("left_t", "left_j", "left_a")
    assert made.parameters == {"joint": "j"}


def test_normalizing_makes_order_not_matter():
    ends = [TransmissionJoint("k"), TransmissionJoint("j", ["velocity", "position"])]
    other = [TransmissionJoint("j", ["position", "velocity"]), TransmissionJoint("k")]
    assert Transmission("t", "x", ends, [A, B]).normalized() == Transmission("t", "x", other, [B, A]).normalized()
