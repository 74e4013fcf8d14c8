"""Names in SDF: those of shapes, which share them with sensors, and what contact sensors refer to."""

from pathlib import Path

import pytest
from lxml import etree

from linkforge_compile import compile_text
from linkforge_compile.formats import SDF
from linkforge_compile.formats.render import render_urdf
from tests.formats.sdf import HEAD, compiled, document, read, reported
from tests.libsdformat import read_with_libsdformat

ONE_NAME = """
links:
  base:
    inertial: *unit
    visual: {box: [1, 1, 1], name: pad}
    collision: [{box: [1, 1, 1], name: pad}, {box: [1, 1, 1], name: eye}]
sensors:
  eye: {type: camera, link: base}
  touch: {type: contact, link: base, contact: {collision: pad}}
  touch_eye: {type: contact, link: base, contact: {collision: eye}}
"""


def felt(sensor) -> str | None:
    return etree.fromstring(sensor["xml"]).findtext("contact/collision")


def test_a_shape_with_the_name_of_another_part_is_renamed(tmp_path: Path):
    """Sensors keep their names, then collisions; contact sensors refer to the new names."""
    base = read(ONE_NAME, tmp_path).links["base"]
    assert [shape["name"] for shape in base["collisions"]] == ["pad", "eye_collision"]
    assert [shape["name"] for shape in base["visuals"]] == ["pad_visual"]
    assert [felt(sensor) for sensor in base["sensors"]] == [None, "pad", "eye_collision"]
    message = "LF7509 the shapes and sensors of a link share their names in SDF, so"
    assert reported(ONE_NAME) == [
        f"{message} collision 'eye' of 'base' is 'eye_collision' there",
        f"{message} visual 'pad' of 'base' is 'pad_visual' there",
    ]


SHAPES = """
links:
  base:
    inertial: *unit
    collision: [{sphere: 1}, {sphere: 1, name: pad}, {sphere: 1}]
    visual: [{sphere: 1}, {sphere: 1}]
"""


def test_a_shape_without_a_name_has_that_of_a_converted_urdf(tmp_path: Path):
    converted = read_with_libsdformat(render_urdf(compiled(SHAPES)), tmp_path, suffix=".urdf").links["base"]
    ours = read(SHAPES, tmp_path).links["base"]
    for kind, unnamed in (("collisions", (0, 2)), ("visuals", (0, 1))):
        assert [ours[kind][number]["name"] for number in unnamed] == [
            converted[kind][number]["name"] for number in unnamed
        ]


BUMPERS = """
links:
  base: {inertial: *unit, collision: [{sphere: 1}, {sphere: 1, name: pad}]}
  tip: {collision: [{sphere: 2, name: pad}]}
  top: {collision: [{sphere: 3}]}
joints:
  out: {type: fixed, parent: base, child: tip}
  up: {type: fixed, parent: base, child: top}
"""


@pytest.mark.parametrize(
    ("link", "collision", "expected"),
    [
        ("base", "base_collision", "base_collision"),
        ("base", "pad", "pad"),
        ("tip", "pad", "pad_collision"),
        ("base", "top_collision", "top_collision"),
        ("base", "base_fixed_joint_lump__pad_collision_1", "pad"),
        ("tip", "base_fixed_joint_lump__pad_collision_2", "pad_collision"),
        ("base", "base_fixed_joint_lump__top_collision_3", "top_collision"),
    ],
)
def test_a_contact_sensor_feels_what_it_names(link: str, collision: str, expected: str, tmp_path: Path):
    """Also by the name that a collision has where Gazebo converts the URDF, and in raw XML."""
    contact = f"<sensor name='raw' type='contact'><contact><collision>{collision}</collision></contact></sensor>"
    text = BUMPERS + (
        f"sensors: {{typed: {{type: contact, link: {link}, contact: {{collision: {collision}}}}}}}\n"
        f'gazebo: {{reference: {link}, extra: "{contact}"}}\n'
    )
    sensors = read(text, tmp_path).links["base"]["sensors"]
    assert [(sensor["name"], felt(sensor)) for sensor in sensors] == [("raw", expected), ("typed", expected)]


def test_a_contact_sensor_without_its_collision_is_reported():
    text = BUMPERS + "sensors: {touch: {type: contact, link: base, contact: {collision: top_colision}}}\n"
    assert reported(text)[1:] == [
        "LF7511 contact sensor 'touch' detects nothing, because link 'base' has no collision 'top_colision' in the "
        "SDF; "
        "did you mean 'top_collision'?"
    ]


@pytest.mark.parametrize("name", ["world", "__pad__", "a::b"])
@pytest.mark.parametrize(
    "text",
    [
        "links: {{base: {{inertial: *unit, visual: {{sphere: 1, name: '{name}'}}}}}}",
        "links: {{base: {{inertial: *unit, collision: {{sphere: 1, name: '{name}'}}}}}}",
        "links: {{base: {{inertial: *unit}}}}\nsensors: {{'{name}': {{type: imu, link: base}}}}",
        'links: {{base: {{inertial: *unit, gazebo: {{extra: <sensor name="{name}" type="imu"/>}}}}}}',
    ],
)
def test_a_reserved_name_is_refused(text: str, name: str):
    (message,) = reported(text.format(name=name))
    assert message.startswith("LF7505 ")
    assert f"'{name}'" in message


@pytest.mark.parametrize("name", ["world", "__m__"])
def test_a_reserved_name_of_a_robot_is_refused(name: str):
    head = HEAD.replace("name: robot", f"name: '{name}'")
    robot = compile_text(f"{head}links: {{base: {{inertial: *unit}}}}").result()
    assert [one.code.id for one in SDF.limits(robot, {})] == ["LF7505"]


def test_raw_elements_with_the_name_of_another_part_are_refused():
    text = """
links: {base: {inertial: *unit, gazebo: {extra: <sensor name="imu" type="imu"/>}}}
sensors: {imu: {type: imu, link: base}}
gazebo: {extra: [<frame name="base"/>, <plugin name="base" filename="x.so"/>]}
"""
    assert reported(text) == [
        "LF7510 Gazebo refuses two parts of 'robot' with the name 'base'; rename one of them",
        "LF7510 Gazebo refuses two parts of 'base' with the name 'imu'; rename one of them",
    ]


def test_a_link_has_each_name_once():
    names = [part.get("name") for part in document(ONE_NAME).find(".//link") if part.get("name")]
    assert len(names) == len(set(names))
