"""ros2_control: hardware, its joints, sensors and gpios, and interfaces that are names with parameters."""

import copy
import pickle

import pytest

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.ros2_control import (
    Interface,
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)

POSITION = Interface("position", {"min": "-1", "max": "1"})
J = Ros2ControlJoint("j", ["position"], ["position", "velocity"])
READ = Ros2ControlJoint("j", state_interfaces=["position"])


def test_an_interface_compares_hashes_sorts_and_prints_as_its_name():
    assert POSITION == "position" == POSITION
    assert POSITION != "velocity"
    assert hash(POSITION) == hash("position")
    assert f"{POSITION}" == "position"
    assert sorted([Interface("velocity"), "effort", POSITION]) == ["effort", "position", "velocity"]
    assert "position" in Ros2ControlJoint("j", [POSITION]).command_interfaces
    assert Ros2ControlJoint("j", [POSITION]) == Ros2ControlJoint("j", ["position"])


def test_two_interfaces_compare_their_parameters_too():
    assert Interface("position", {"max": "1", "min": "-1"}) == POSITION
    assert Interface("position") != POSITION
    assert Interface("position", POSITION.parameters, extra_elements=["<limits/>"]) != POSITION


def test_an_interface_keeps_its_parameters_in_copies_and_pickles():
    for twin in (copy.deepcopy(POSITION), pickle.loads(pickle.dumps(POSITION))):
        assert twin == POSITION
        assert twin.parameters == {"min": "-1", "max": "1"}


def test_an_interface_cannot_be_changed():
    with pytest.raises(AttributeError):
        POSITION.parameters = {}


def test_a_bare_name_is_an_interface_without_parameters():
    assert Interface.of("effort").parameters == {}
    assert Interface.of(POSITION) is POSITION


def test_parameters_of_interfaces_live_through_prefix_and_sorting():
    joint = Ros2ControlJoint("j", ["velocity", POSITION]).with_prefix("left_").normalized()
    assert joint.command_interfaces[0].parameters == POSITION.parameters


@pytest.mark.parametrize(
    ("make", "code", "field"),
    [
        (lambda: Ros2ControlJoint("", ["position"]), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: Ros2ControlJoint("j"), ValidationErrorCode.VALUE_EMPTY, ()),
        (lambda: Ros2ControlSensor(""), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: Ros2ControlGpio(""), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: Ros2Control("", hardware_plugin="p"), ValidationErrorCode.NAME_EMPTY, ("name",)),
        (lambda: Ros2Control("arm", "robot", "p"), ValidationErrorCode.INVALID_VALUE, ("type",)),
        (lambda: Ros2Control("arm"), ValidationErrorCode.VALUE_EMPTY, ("hardware_plugin",)),
        (lambda: Ros2Control("arm", "system", "p", [J, J]), ValidationErrorCode.DUPLICATE_NAME, ("joints", "j")),
        (lambda: Ros2Control("arm", "actuator", "p"), ValidationErrorCode.INVALID_VALUE, ("joints",)),
        (
            lambda: Ros2Control("arm", "sensor", "p", [J]),
            ValidationErrorCode.INVALID_VALUE,
            ("joints", "j", "command_interfaces"),
        ),
        (
            lambda: Ros2Control("arm", "system", "p", sensors=[Ros2ControlSensor("s")] * 2),
            ValidationErrorCode.DUPLICATE_NAME,
            ("sensors", "s"),
        ),
        (
            lambda: Ros2Control("arm", "system", "p", gpios=[Ros2ControlGpio("led")] * 2),
            ValidationErrorCode.DUPLICATE_NAME,
            ("gpios", "led"),
        ),
    ],
)
def test_hardware_that_ros2_control_refuses_is_refused(make, code, field):
    with pytest.raises(RobotValidationError) as caught:
        make()
    assert caught.value.code is code
    assert caught.value.field == field


def test_each_type_of_hardware_accepts_its_own_parts():
    assert Ros2Control("arm", "actuator", "p", [J]).joints == (J,)
    assert Ros2Control("arm", "sensor", "p", [READ]).joints == (READ,)
    assert Ros2Control("arm", hardware_plugin="p").type == "system"


def test_a_prefix_reaches_joints_sensors_and_gpios_but_no_parameters():
    arm = Ros2Control(
        "arm", "system", "p", [J], [Ros2ControlSensor("s")], {"port": "j"}, gpios=[Ros2ControlGpio("led", ["on"])]
    ).with_prefix("left_")
    assert (arm.name, arm.joints[0].name, arm.sensors[0].name, arm.gpios[0].name) == (
        "left_arm",
        "left_j",
        "left_s",
        "left_led",
    )
    assert arm.parameters == {"port": "j"}


def test_normalizing_makes_order_not_matter():
    pins = [Ros2ControlGpio("a", ["y", "x"]), Ros2ControlGpio("b")]
    turned = [Ros2ControlGpio("b"), Ros2ControlGpio("a", ["x", "y"])]
    forth, back = (Ros2Control("arm", "system", "p", gpios=gpios).normalized() for gpios in (pins, turned))
    assert forth == back
