"""Laws of comparing: a robot is like itself, and no field of it can change in silence."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from itertools import islice

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkforge_compile.compare import compare, removed_public_names
from linkforge_compile.compare.context import CompareContext
from linkforge_compile.compare.robots import walk
from linkforge_compile.core import Robot, models
from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.models.geometry import Color, Material, Sphere, Vector3
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.part import Inside
from tests.core.test_schemas import CLASSES, WITHOUT_SCHEMA
from tests.export_spec.test_every_field import full, parts
from tests.strategies import robots

UNTOLD = {"source", "resource_resolver", "axis_as_written", "shape_order", "after_links"}
"""Fields that say where and how it was written."""


EXTRAS = {
    "extra_elements": [("<other/>",)],
    "extra_attributes": [(("other", "1"),)],
    "extra_inside": [(Inside("other", extra_elements=("<other/>",)),)],
}


def other_values(value: object) -> Iterator[object]:
    """Yield values that a field might have instead."""
    match value:
        case bool():
            yield not value
        case Enum():
            yield from (other for other in type(value) if other is not value)
        case int() | float():
            yield from (value * 1.25 + 0.03, value * 0.75 - 0.02, int(value) * 2 + 1, int(abs(value) * 3 + 1))
        case Interface():
            yield from (Interface("other"), Interface(value, {"other": "1"}))
            yield Interface(value, value.parameters, extra_elements=("<other/>",))
        case str():
            yield from (
                f"{value}_other",
                "sensor",
                "fixed",
                "parent",
                "parent_to_child",
                "child_to_parent",
                "planar",
                "arm",
                "finger",
            )
        case Vector3():
            yield from (Vector3(value.x * 0.5 + 0.1, value.y, value.z), Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0))
        case Mapping():
            yield {**value, "other": "1"}
            yield from ({other: value[other] for other in value if other != key} for key in value)
            yield from ({**value, key: new} for key in value for new in (*other_values(value[key]), (0.7,)))
        case tuple():
            for place, item in enumerate(value):
                yield (*value[:place], *value[place + 1 :])
                news = islice((new for _, new in changed_parts(item)), 2) if is_dataclass(item) else other_values(item)
                yield from ((*value[:place], new, *value[place + 1 :]) for new in news)
        case None:
            yield from ("other", 0.5, True)
        case _ if is_dataclass(value):
            yield from (new for _, new in changed_parts(value))


def changed_parts(part: object) -> Iterator[tuple[str, object]]:
    """Yield the field and the part with another value in it, wherever the constructor takes one."""
    for field in fields(part):
        if field.name.startswith("_") or field.name in UNTOLD:
            continue
        value = getattr(part, field.name)
        gone = (None,) if value is not None and field.default is None else ()
        for new in EXTRAS.get(field.name) or (*other_values(value), *gone):
            try:
                yield field.name, replace(part, **{field.name: new})
            except (RobotModelError, TypeError, ValueError, AttributeError):
                continue


PARTS = list(parts(full()))


@pytest.mark.parametrize("part", PARTS, ids=lambda part: type(part).__name__)
def test_no_change_of_a_single_field_is_silent(part: object):
    for field, other in changed_parts(part):
        if other != part:
            assert any(walk(("part",), part, other, CompareContext())), (field, other)
            assert any(walk(("part",), other, part, CompareContext())), (field, other)


def test_every_field_of_every_part_was_changed_by_that():
    changed = {(type(part), field) for part in PARTS for field, other in changed_parts(part) if other != part}
    kinds = [getattr(models, name) for name in {*CLASSES.values(), *WITHOUT_SCHEMA}]
    compared = {
        (kind.__name__, field.name) for kind in kinds if is_dataclass(kind) for field in fields(kind) if field.compare
    }
    # No other type of hardware takes the joints of that robot; `test_robots` changes it.
    assert compared - {(kind.__name__, field) for kind, field in changed} - {("Ros2Control", "type")} == set()


def test_no_field_of_a_robot_is_silent():
    robot = full()
    for field, new in {
        "name": "other", "version": "1.1", "materials": {}, "metadata": {"author": "you"}, "links": robot.links[:2],
        "joints": robot.joints[:1], "sensors": (), "transmissions": (), "ros2_controls": (), "gazebo_elements": (),
        "semantic": None, "extra_elements": (), "extra_attributes": (),
    }.items():  # fmt: skip
        other = robot.clone()
        setattr(other, field, new)
        assert compare(robot, other), field
        assert compare(other, robot), field


@settings(max_examples=15)
@given(robots())
def test_a_robot_is_like_itself(robot: Robot):
    assert compare(robot, robot.clone()) == ()
    assert removed_public_names(robot, robot.clone()) == ()


@settings(max_examples=15)
@given(robots(), robots())
def test_the_differences_of_any_two_robots_can_be_json(before: Robot, after: Robot):
    differences = compare(before, after)
    json.dumps([(one.kind, one.path, one.before, one.after, one.text) for one in differences], allow_nan=False)
    assert all(one.text for one in differences)


COLORS = {"red": Color(1, 0, 0), "green": Color(0, 1, 0)}
orders_of_shapes = st.lists(st.sampled_from(("collision", "visual", *COLORS)), max_size=6).flatmap(
    lambda looks: st.tuples(*[st.permutations(list(enumerate(looks, start=1)))] * 2)
)
"""Two orders of the same shapes: spheres by their radius [m], each a collision, a visual or a visual of a color."""


@settings(max_examples=20)
@given(orders_of_shapes)
def test_an_order_is_reported_exactly_if_mujoco_shows_another_color(orders: tuple[list[tuple[int, str]], ...]):
    before, after = (Robot("r", links=[link_of(shapes)]) for shapes in orders)
    seen, now_seen = map(seen_in_mujoco, orders)
    assert len(compare(before, after)) == sum(seen[shape] != now_seen[shape] for shape in seen)


def link_of(shapes: list[tuple[int, str]]) -> Link:
    paints = {look: Material(look, color) for look, color in COLORS.items()}
    return Link(
        "a",
        visuals=[Visual(Sphere(size), material=paints.get(look)) for size, look in shapes if look != "collision"],
        collisions=[Collision(Sphere(size)) for size, look in shapes if look == "collision"],
        shape_order=["collision" if look == "collision" else "visual" for _, look in shapes],
    )


def seen_in_mujoco(shapes: list[tuple[int, str]]) -> dict[int, str]:
    """Return the color of each shape: as its URDF reader goes on with the last color that it met."""
    color, seen = "", {}
    for size, look in shapes:
        color = look if look in COLORS else color
        seen[size] = color
    return seen
