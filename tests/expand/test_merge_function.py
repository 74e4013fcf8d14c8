"""Maps that expressions merge: parameters that depend on the model."""

import pytest

from linkforge_compile import compile_text, render_urdf

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


def test_merging_large_maps_again_and_again_is_stopped():
    entries = ", ".join(f"k{number}: {number}" for number in range(10_000))
    merges = "\n".join(f"  v{number}: $(merge(big, v{number - 1}))" for number in range(1, 400))
    head = f"linkforge: 1\nname: r\nvariables:\n  big: {{{entries}}}\n  v0: $(big)\n"
    spec = f"{head}{merges}\nlinks: {{a: {{when: $(len(v399) > 0)}}}}\n"
    assert "LF3301" in {one.code.id for one in compile_text(spec).diagnostics}
