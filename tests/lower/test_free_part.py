"""Free parts: text passes as it was written, and what is nested becomes elements."""

import pickle
from collections.abc import Mapping

import pytest

from linkforge_compile.core import GazeboPlugin
from tests.lower.specs import robot_of

PLUGIN = """
    name: cart
    links: {base: }
    gazebo:
      plugins:
        drive:
          filename: libdrive.so
          parameters:
            x: %s
"""


def parameters(value: str) -> Mapping[str, object]:
    [block] = robot_of(PLUGIN % value).gazebo_elements
    return block.plugins[0].parameters


@pytest.mark.parametrize("text", ["1.10", "1e6", "yes", "007", "0x1F", "true", "3 mm", "null", "~", "1:30"])
def test_a_scalar_passes_as_it_was_written(text: str):
    assert parameters(text) == {"x": text}


def test_nothing_written_is_as_if_not_written_but_an_empty_text_is_an_element():
    assert parameters("") == {}
    assert parameters('""') == {"x": ""}


def test_a_map_is_child_elements_and_a_list_repeats_its_tag():
    assert parameters("{a: 1, b: {c: [2, 3]}}") == {"x": {"a": "1", "b": {"c": ("2", "3")}}}


def test_a_key_with_an_underscore_is_an_attribute_or_the_text():
    assert parameters("{_type: gaussian, _text: wide, mean: 0}") == {
        "x": {"_type": "gaussian", "_text": "wide", "mean": "0"}
    }


def test_nothing_written_inside_is_left_out_as_well():
    assert parameters("{a: , b: [1, ''], c: {}}") == {"x": {"b": ("1", ""), "c": {}}}


def test_an_attribute_holds_text():
    assert parameters(
        "{_type: [a, b], c: 1}   # E[LF5001]:20 _type takes text, found a list",
    ) == {"x": {"c": "1"}}


def test_what_plugins_read_never_changes():
    gains = {"p": [1, 2]}
    plugin = GazeboPlugin("drive", "libdrive.so", {"gains": gains})
    gains["p"].append(3)
    assert plugin.parameters == {"gains": {"p": (1, 2)}}
    assert pickle.loads(pickle.dumps(plugin)) == plugin
    assert hash(plugin) == hash(GazeboPlugin("drive", "libdrive.so", {"gains": {"p": (1, 2)}}))


def test_parameters_of_hardware_are_text_and_nothing_else():
    robot = robot_of("""
        name: arm
        links: {base: , upper: }
        joints: {shoulder: {type: continuous, parent: base, child: upper, axis: z}}
        ros2_control:
          arm:
            hardware_plugin: arm/System
            parameters: {factor: 1.10, gains: {p: 1}}   # E[LF5001]:39 gains takes text, found a map
            joints: {shoulder: {state_interfaces: [position]}}
    """)
    assert robot.ros2_control("arm").parameters == {"factor": "1.10"}
