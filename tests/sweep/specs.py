"""The specs that the tests of sweeps compile."""

from pathlib import Path

ARM = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 0.8 m, minimum: 0.2 m, maximum: 2 m}
  fingers: {type: integer, default: 2, minimum: 1, maximum: 5}
  tool: {type: string, default: hand, enum: [hand, hook]}
  bend: {type: angle, default: 0 deg}
  is_long: {type: boolean, default: false}
  offset: {type: vector, default: [0, 0, 0]}
  title: {type: string, default: arm}
variables:
  half: $(reach / 2)
variants:
  sim: {bend: 10 deg}
  real: {bend: 20 deg}
links:
  base: {visual: {box: [0.1, 0.1, 0.1]}, inertial: {mass: 3 kg}}
  upper: {visual: {box: [0.05, 0.05, $(half)]}, inertial: {mass: 2 kg}}
  $(tool)_$(i): {for: {i: $(fingers)}, visual: {sphere: 0.02}, inertial: {mass: 0.1 kg}}
joints:
  shoulder:
    type: revolute
    parent: base
    child: upper
    axis: y
    limits: {lower: -90 deg, upper: 90 deg, effort: 1, velocity: 1}
  $(tool)_joint_$(i):
    for: {i: $(fingers)}
    type: fixed
    parent: upper
    child: $(tool)_$(i)
    origin: {xyz: [0, 0, $(half)], rpy: [$(bend), 0, 0]}
semantic:
  groups: {arm: {joints: [shoulder]}}
"""


def write_arm(folder: Path) -> Path:
    """Write the spec of an arm and return its path."""
    path = folder / "arm.robot.yaml"
    path.write_text(ARM)
    return path
