"""Gazebo elements and plugins."""

import math

import pytest

from linkforge_compile.core.exceptions import RobotMathError, RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin

PLUGIN = GazeboPlugin("control", "libcontrol.so", {"rate": "100"})


@pytest.mark.parametrize(
    ("make", "code", "field"),
    [
        (lambda: GazeboPlugin(" ", "lib.so"), ValidationErrorCode.NAME_EMPTY, "name"),
        (lambda: GazeboPlugin("control", "\t"), ValidationErrorCode.VALUE_EMPTY, "filename"),
        (lambda: GazeboElement(" "), ValidationErrorCode.NAME_EMPTY, "reference"),
        (lambda: GazeboElement(stop_cfm=-1), ValidationErrorCode.INVALID_VALUE, "stop_cfm"),
        (lambda: GazeboElement(stop_erp=1.1), ValidationErrorCode.INVALID_VALUE, "stop_erp"),
        (lambda: GazeboElement(stop_erp=math.nan), ValidationErrorCode.INVALID_VALUE, "stop_erp"),
    ],
)
def test_what_no_simulator_accepts_is_refused(make, code, field):
    with pytest.raises(RobotValidationError) as caught:
        make()
    assert caught.value.code is code
    assert caught.value.field == (field,)


def test_the_words_that_scripts_look_for():
    with pytest.raises(RobotValidationError, match="stop_cfm must be >= 0"):
        GazeboElement(stop_cfm=-0.1)
    with pytest.raises(RobotValidationError, match=r"stop_erp must be in \[0.0, 1.0\]"):
        GazeboElement(stop_erp=-0.1)


def test_infinity_is_refused():
    with pytest.raises(RobotMathError):
        GazeboElement(stop_cfm=math.inf)


def test_parameters_and_properties_cannot_be_changed():
    element = GazeboElement("base", {"mu1": "0.5"}, [PLUGIN])
    with pytest.raises(TypeError):
        PLUGIN.parameters["rate"] = "1"
    with pytest.raises(TypeError):
        element.properties["mu1"] = "1"
    assert element.properties == {"mu1": "0.5"}


def test_raw_xml_is_not_compared():
    assert GazeboPlugin("control", "lib.so", raw_xml="<rate>1</rate>") == GazeboPlugin("control", "lib.so")


def test_elements_with_plugins_hash():
    assert (
        len(
            {
                GazeboElement("base", {"a": "1", "b": "2"}, [PLUGIN]),
                GazeboElement("base", {"b": "2", "a": "1"}, (PLUGIN,)),
            }
        )
        == 1
    )


def test_a_class_of_gazebo_sim_keeps_its_name():
    plugin = GazeboPlugin("gz::sim::systems::Imu", "gz-sim-imu-system")
    assert plugin.with_prefix("left_") == plugin


def test_a_prefix_reaches_the_reference_and_the_names_of_plugins():
    element = GazeboElement("base", {"material": "base"}, [PLUGIN], material="Gazebo/Red").with_prefix("left_")
    assert element.reference == "left_base"
    assert element.plugins[0].name == "left_control"
    assert element.properties == {"material": "base"}
    assert element.material == "Gazebo/Red"
    assert GazeboElement().with_prefix("left_").reference is None
