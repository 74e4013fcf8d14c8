"""A 0 that is set without need is written, and stays in the spec that is written back."""

import pytest

from linkforge_compile import compile_text, render_urdf, write_spec

SPEC = """
linkforge: 1
name: r
links: {base: , arm: }
joints: {j: {type: continuous, parent: base, child: arm, axis: z}}
transmissions:
  t: {type: transmission_interface/SimpleTransmission, joints: {j: {OFFSET}}, actuators: {m: {OFFSET}}}
sensors:
  eye: {type: camera, link: arm, camera: {noise: {stddev: 0.1, BIAS}}}
"""
STATED = SPEC.replace("OFFSET", "offset: 0").replace("BIAS", "bias_mean: 0, bias_stddev: 0")
UNSAID = SPEC.replace("OFFSET", "").replace(", BIAS", "")


@pytest.mark.parametrize(
    ("tag", "count"), [("<offset>0</offset>", 2), ("<bias_mean>0</bias_mean>", 1), ("<bias_stddev>0</bias_stddev>", 1)]
)
def test_a_stated_zero_is_written(tag: str, count: int):
    assert render_urdf(compile_text(STATED).result()).count(tag) == count
    assert tag not in render_urdf(compile_text(UNSAID).result())


@pytest.mark.parametrize("text", [STATED, UNSAID])
def test_the_spec_that_is_written_back_is_complete(text: str):
    robot = compile_text(text).result()
    again = compile_text(write_spec(robot)).result()
    assert render_urdf(again) == render_urdf(robot)
    assert again.transmissions[0] == robot.transmissions[0]
    assert again.sensors[0] == robot.sensors[0]
