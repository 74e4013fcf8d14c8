"""Maps that expressions merge: parameters that depend on the model."""

from dataclasses import replace
from unittest.mock import Mock, patch

import pytest

from linkforge_compile import compile_text, render_urdf
from linkforge_compile.expressions.functions import FUNCTIONS
from linkforge_compile.limits import Limit

SPEC = """\
linkforge: 1
name: cart
parameters: {model: {type: string, default: mini}}
variables:
  common: {port: can0, rate: 500}
  models:
    mini: {can_ids: {left: 3, right: 4}}
    maxi: {can_ids: {left: 11, rate: 1000}}
links: {base: }
ros2_control:
  drive:
    type: sensor
    hardware_plugin: cart/Drive
    parameters: $(merge(common, models[model].can_ids))
    sensors: {imu: {state_interfaces: [yaw]}}
"""


@pytest.mark.parametrize(
    ("model", "parameters"),
    [
        ("mini", ["port=can0", "rate=500", "left=3", "right=4"]),
        ("maxi", ["port=can0", "rate=1000", "left=11"]),
    ],
)
def test_parameters_of_hardware_are_those_of_all_maps_and_the_last_one_wins(model: str, parameters: list[str]):
    robot = compile_text(SPEC, parameters={"model": model}).result()
    assert [f"{name}={text}" for name, text in robot.ros2_controls["drive"].parameters.items()] == parameters
    for parameter in parameters:
        name, _, text = parameter.partition("=")
        assert f'<param name="{name}">{text}</param>' in render_urdf(robot)


def test_merging_large_maps_again_and_again_is_stopped_by_the_entries_that_are_merged():
    merge = Mock(wraps=FUNCTIONS["merge"].compute)
    entries = ", ".join(f"k{number}: {number}" for number in range(10_000))
    link = "l_$(i): {for: {i: 400}, when: '$(len(merge(big, other)) > i)'}"
    spec = f"linkforge: 1\nname: r\nvariables: {{big: {{{entries}}}, other: {{k: 1}}}}\nlinks: {{{link}}}\n"
    with patch.dict(FUNCTIONS, merge=replace(FUNCTIONS["merge"], compute=merge)):
        found = compile_text(spec).diagnostics
    assert [one.code.id for one in found] == ["LF3301"]
    merged = sum(len(part) for call in merge.call_args_list for part in call.args)
    assert Limit.STEPS.most // 2 < merged <= Limit.STEPS.most
