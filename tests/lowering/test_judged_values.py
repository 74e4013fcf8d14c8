"""What lowering makes without asking constructors is what they would make: they refuse none of it, and change none."""

import re
from dataclasses import fields, replace
from itertools import count

import pytest

from linkforge_compile.core import Link
from linkforge_compile.core.part import Part
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.lowering import lower
from tests.lowering.specs import Spec

SHAPES = [
    "box: [0.1, 0.2, 0.3]",
    "box: {size: [0.1, 0.2, 0.3]}",
    "cylinder: {radius: 0.1, length: 0.5}",
    "capsule: {radius: 0.1, length: 0.5}",
    "sphere: 0.1",
    "sphere: {radius: 0.1}",
    "mesh: {file: a.stl, scale: [1.5, 1.5, 1.5]}",
    "mesh: {file: a.stl, scale: 2.5}",
]
LINKS = [
    *(f"visual: {{{shape}, origin: {{xyz: [0.1, 0, 0], rpy: [0, 0, 0.2]}}}}" for shape in SHAPES),
    "collision: {sphere: 0.1, origin: [0.1, 0.2, 0.3], name: round, extra: '<a/>'}",
    "inertial: {mass: 1.5, origin: [0, 0, 0.1], inertia: {ixx: 1, iyy: 1, izz: 1, ixy: 0.1, ixz: 0.1, iyz: 0.1}}",
    "inertial: {mass: 1.5, inertia: {ixx: 0.1, iyy: 0.1, izz: 0.1}, extra_attributes: {a: b}}",
]
LIMITS = "limits: {lower: -1.5, upper: 1.5, effort: 50, velocity: 2}"
JOINTS = [
    f"type: revolute, parent: base, child: arm, axis: [0, 1, 0], {LIMITS}",
    f"type: prismatic, parent: base, child: arm, axis: z, {LIMITS}, dynamics: {{damping: 0.1, friction: 0.05}}",
    "type: continuous, parent: base, child: arm, axis: [0, 1.7e308, 0.5], limits: {effort: 50, velocity: 2}",
    "type: planar, parent: base, child: arm, axis: x, dynamics: {friction: 0.05}",
    "type: fixed, parent: base, child: arm, origin: {rpy: [0, 0, 0.1]}, extra_inside: {parent: {extra: '<a/>'}}",
]
SPECS = [f"links: {{base: {{{link}}}, arm: }}" for link in LINKS]
SPECS += [f"links: {{base: , arm: }}\njoints: {{elbow: {{{joint}}}}}" for joint in JOINTS]
ODD = ["0", "-3", "1e308", ".nan", "''", "[]"]
WORD = re.compile(r"(?<=[\[ ])(?:-?[\d.e]+|base|arm|revolute|prismatic)(?=[],}])")


@pytest.mark.parametrize("spec", SPECS)
def test_constructors_take_what_is_made_without_them(spec):
    made = parts_of(spec)
    assert made > 2
    for word in WORD.finditer(spec):
        for odd in ODD:
            parts_of(f"{spec[: word.start()]}{odd}{spec[word.end() :]}")


def parts_of(spec: str) -> int:
    """Lower a spec, ask the constructor of each part of its robot for the part, and count them."""
    sink = Diagnostics()
    robot = lower(Spec(spec).instance(sink, count()), sink).robot
    assert robot is not None
    return sum(map(constructed, (*robot.links, *robot.joints)))


def constructed(value: object) -> int:
    if isinstance(value, tuple):
        return sum(map(constructed, value))
    if not isinstance(value, Part | Link):
        return 0
    values = values_of(value)
    assert values_of(replace(value)) == values
    # Constructors keep an integer, which is written without a point.
    assert not [field for field in fields(value) if "float" in field.type and values[field.name][0] is int]
    return 1 + sum(constructed(one) for _, one in values.values())


def values_of(part: Part | Link) -> dict[str, tuple[type, object]]:
    values = {field.name: getattr(part, field.name) for field in fields(part)}
    return {name: (type(value), value) for name, value in values.items()}
