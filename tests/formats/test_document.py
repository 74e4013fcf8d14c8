"""What holds for a document as a whole: its head, its layout, its escapes, its bytes."""

import math
import os
import subprocess
import sys

import pytest
from lxml import etree

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.geometry import Capsule, Color, Material, Mesh, Sphere, Transform, Vector3
from linkforge_compile.core.models.link import Collision, Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics.codes.formats import OTHER_QUATERNION
from linkforge_compile.formats import FORMATS, URDF
from linkforge_compile.formats.render import render_srdf, render_urdf
from tests.conftest import ROOT

ARM = Robot("arm", links=[Link("base", collisions=[Collision(Sphere(0.5))]), Link("tool0")])


def mesh(resource: str) -> Robot:
    return Robot("r", links=[Link("base", visuals=[Visual(Mesh(resource))])])


def test_every_format_is_in_the_table():
    assert [(one.name, one.suffix) for one in FORMATS] == [
        ("urdf", ".urdf"),
        ("srdf", ".srdf"),
        ("sdf", ".sdf"),
        ("mjcf", ".mjcf"),
        ("joint_limits", "_joint_limits.yaml"),
        ("ros2_controllers", "_controllers.yaml"),
        ("moveit", "_moveit_config"),
    ]


def test_a_document_declares_itself_and_ends_its_last_line():
    assert render_urdf(Robot("r")) == '<?xml version="1.0"?>\n<robot name="r"/>\n'


def test_without_pretty_everything_is_on_one_line():
    assert render_urdf(ARM, pretty=False, banner="one\ntwo") == (
        '<?xml version="1.0"?><!-- one two --><robot name="arm"><link name="base"><collision><geometry>'
        '<sphere radius="0.5"/></geometry></collision></link><link name="tool0"/></robot>\n'
    )


def test_a_banner_is_a_comment_below_the_declaration():
    assert render_srdf(Robot("r"), banner="made by us") == (
        '<?xml version="1.0"?>\n<!-- made by us -->\n<robot name="r"/>\n'
    )


def test_a_banner_of_several_lines_is_one_comment():
    assert render_srdf(Robot("r"), banner="made by us\n\nfrom arm.robot.yaml") == (
        '<?xml version="1.0"?>\n<!--\n  made by us\n\n  from arm.robot.yaml\n-->\n<robot name="r"/>\n'
    )


def test_a_material_is_before_or_after_the_links():
    red, blue = Material("red", Color(1, 0, 0), after_links=True), Material("blue", Color(0, 0, 1))
    document = etree.fromstring(
        render_urdf(Robot("r", materials={"red": red, "blue": blue}, links=[Link("a")])).encode()
    )
    assert [child.get("name") for child in document] == ["blue", "a", "red"]


@pytest.mark.parametrize("banner", ["a --> <evil/>", "---", "ends-", "\x07\ufffe\ud800", "<!--"])
def test_a_banner_cannot_end_its_comment(banner: str):
    document = etree.fromstring(render_urdf(Robot("r"), banner=banner).encode())
    assert document.getprevious().tag is etree.Comment
    assert len(document) == 0


def test_markup_in_a_value_is_text():
    assert '<mesh filename="a&amp;b&lt;c&gt;&quot;d\'.stl"/>' in render_urdf(mesh("a&b<c>\"d'.stl"))


def test_line_ends_and_tabs_of_a_value_survive_reading():
    assert 'filename="a&#10;b&#9;c&#13;"' in render_urdf(mesh("a\nb\tc\r"))


@pytest.mark.parametrize("bad", ["\x00", "\x07", "\x1f", "\ufffe", "\ud800"])
def test_what_xml_cannot_hold_is_refused_by_name(bad: str):
    with pytest.raises(RobotGeneratorError, match=rf"XML cannot hold the character U\+{ord(bad):04X}, found in 'a"):
        render_urdf(mesh(f"a{bad}"))


def test_an_attribute_is_not_stated_twice():
    robot = Robot("r", links=[Link("base", extra_attributes=[("name", "other")])])
    with pytest.raises(RobotGeneratorError, match="the attribute 'name' is stated twice"):
        render_urdf(robot)


def test_the_version_is_written_if_somebody_stated_it():
    assert '<robot name="r">' in render_urdf(mesh("a"))
    assert '<robot name="r" version="1.0"/>' in render_urdf(Robot("r", "1.0", version_stated=True))


def test_a_capsule_makes_the_file_state_the_version_that_has_capsules():
    capsule = [Link("base", collisions=[Collision(Capsule(0.1, 0.2))])]
    assert '<robot name="r" version="1.1">' in render_urdf(Robot("r", links=capsule))
    assert '<robot name="r" version="1.2">' in render_urdf(Robot("r", "1.2", links=capsule))


def test_a_robot_keeps_its_extras():
    robot = Robot("r", extra_elements=["<drake:joint/>"], extra_attributes=[("xmlns:drake", "http://drake.mit.edu")])
    assert render_urdf(robot) == (
        '<?xml version="1.0"?>\n<robot name="r" xmlns:drake="http://drake.mit.edu">\n  <drake:joint/>\n</robot>\n'
    )


def test_the_order_is_the_authors():
    robot = Robot(
        "r",
        links=[Link("z"), Link("a"), Link("m")],
        materials={name: Material(name, Color(0, 0, 0)) for name in ("y", "b")},
    )
    names = [line.split('"')[1] for line in render_urdf(robot).splitlines() if "name=" in line]
    assert names == ["r", "y", "b", "z", "a", "m"]


def test_bytes_are_the_same_in_every_process():
    script = (
        "from tests.formats.everything import everything; from linkforge_compile.formats.render import *; "
        "robot = everything(); print(render_urdf(robot) + render_srdf(robot))"
    )
    outputs = {
        subprocess.run(
            [sys.executable, "-c", script],
            cwd=ROOT,
            env=os.environ | {"PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
            timeout=60,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(outputs) == 1


@pytest.mark.parametrize("version", [None, "1.0", "1.1"])
@pytest.mark.parametrize("shape", [Sphere(1), Capsule(1, 2)])
def test_a_rotation_is_written_where_readers_of_the_version_expect_it(version: str | None, shape: Sphere | Capsule):
    half = Transform(rpy=Vector3(0, 0, math.pi), extra_attributes=[("quat_xyzw", "0 0 1 0")])
    links = [Link("base", visuals=[Visual(shape, half)])]
    document = render_urdf(Robot("r", version or "1.1", version_stated=bool(version), links=links))
    reads_quaternions = 'version="1.1"' in document
    assert reads_quaternions is (version == "1.1" or (version is None and isinstance(shape, Capsule)))
    assert 'quat_xyzw="0 0 1 0"/>' in document
    assert ("rpy" in document) is not reads_quaternions, (
        "urdfdom ignores the quaternion of 1.0, and refuses both in 1.1"
    )


@pytest.mark.parametrize("shape", [Sphere(1), Capsule(1, 2)])
def test_a_quaternion_that_differs_from_rpy_is_reported_for_its_readers(shape: Sphere | Capsule):
    robot = Robot(
        "r", links=[Link("a", visuals=[Visual(shape, Transform(extra_attributes=[("quat_xyzw", "0 0 1 0")]))])]
    )
    diagnostics = [one for one in URDF.limits(robot, {}) if one.code is OTHER_QUATERNION]
    assert len(diagnostics) == isinstance(shape, Capsule)
