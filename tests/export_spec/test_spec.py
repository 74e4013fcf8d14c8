"""A robot as a spec: the language's short forms, its order, and nothing that it fills in by itself."""

from dataclasses import replace
from textwrap import dedent

import pytest
import yaml

from linkforge_compile import compile_text, write_spec
from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.geometry import Box, Color, Material, Mesh, Sphere, Transform, Vector3
from linkforge_compile.core.models.joint import Joint, JointDynamics, JointLimits, JointType
from linkforge_compile.core.models.link import Collision, Inertial, InertiaTensor, Link, LinkPhysics, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface, Ros2Control, Ros2ControlJoint
from linkforge_compile.core.models.sensor import CameraInfo, Sensor, SensorType
from linkforge_compile.core.models.srdf import GroupState, PlanningGroup, SemanticRobotDescription
from linkforge_compile.core.models.srdf_collisions import CollisionPair

STEEL = Material("steel", Color(0.6, 0.6, 0.65))


def spec(**parts: object) -> str:
    """Return the lines of a spec after its name."""
    return write_spec(Robot("r", **parts)).removeprefix("linkforge: 1\nname: r\n").lstrip("\n")


def lines(text: str) -> str:
    return dedent(text).lstrip("\n")


def test_a_link_is_written_in_the_shortest_forms():
    ball = Visual(Sphere(0.1), Transform(Vector3(0, 0, 1)), STEEL)
    link = Link("ball", visuals=[ball], collisions=[Collision(ball.geometry, ball.origin)])
    assert spec(materials={"steel": STEEL}, links=[link, Link("tool0")]) == lines("""
        materials:
          steel: {color: [0.6, 0.6, 0.65]}

        links:
          ball: {visual: {sphere: 0.1, origin: [0, 0, 1], material: steel}, collision: visual}
          tool0: {}
    """)


@pytest.mark.parametrize(
    ("shape_order", "written"),
    [
        ("", "visual, collision"),
        ("v", "visual, collision"),
        ("ccvv", "collision, visual"),
        ("vcvc", "visual, collision, shape_order: pairs"),
        ("vc", "visual, collision, shape_order: pairs"),
        ("cvcv", "collision, visual, shape_order: pairs"),
        ("cvvc", "collision, visual, shape_order: [collision, visual, visual, collision]"),
        ("cvvcvvc", "collision, visual, shape_order: [collision, visual, visual, collision]"),
    ],
)
def test_the_order_of_shapes_is_written_in_the_shortest_form(shape_order: str, written: str):
    balls = [Sphere(1), Sphere(2)]
    kinds = [{"v": "visual", "c": "collision"}[letter] for letter in shape_order]
    link = Link("a", visuals=list(map(Visual, balls)), collisions=list(map(Collision, balls)), shape_order=kinds)
    section = yaml.safe_load(spec(links=[link]))["links"]["a"]
    order = section.get("shape_order")
    words = [key for key in section if key != "shape_order"]
    order_text = ", ".join([*words, *([f"shape_order: {order}".replace("'", "")] if order else [])])
    assert order_text == written


def test_what_differs_between_visual_and_collision_is_written_twice():
    visual, collision = Visual(Sphere(0.1)), Collision(Sphere(0.1), name="hull")
    assert spec(links=[Link("a", visuals=[visual], collisions=[collision])]) == lines("""
        links:
          a: {visual: {sphere: 0.1}, collision: {name: hull, sphere: 0.1}}
    """)


def test_a_material_that_is_not_the_robots_is_written_where_it_is_used():
    visuals = [Visual(Sphere(1), material=one) for one in (Material("red", Color(1, 0, 0, 0.5)), STEEL)]
    painted = replace(STEEL, texture="steel.png")
    assert spec(materials={"steel": painted}, links=[Link("a", visuals=visuals)]) == lines("""
        materials:
          steel: {color: [0.6, 0.6, 0.65], texture: steel.png}

        links:
          a:
            visual:
              - {sphere: 1, material: {name: red, color: [1, 0, 0, 0.5]}}
              - {sphere: 1, material: {name: steel, color: [0.6, 0.6, 0.65]}}
    """)


@pytest.mark.parametrize(
    ("scale", "expected"),
    [
        ((1, 1, 1), "mesh: a.stl"),
        ((0.001, 0.001, 0.001), "mesh: {file: a.stl, scale: 0.001}"),
    ],
)
def test_a_mesh_without_scale_writes_none(scale: tuple[float, float, float], expected: str):
    link = Link("a", visuals=[Visual(Mesh("a.stl", Vector3(*scale)))])
    assert spec(links=[link]) == f"links:\n  a: {{visual: {{{expected}}}}}\n"


def test_the_tensor_is_written_even_where_it_could_be_computed():
    body = Link("a", Inertial(2, inertia=InertiaTensor(1, 1, 1, 0, 0.5)), LinkPhysics(mu=0.5, gravity=False))
    assert spec(links=[body]) == lines("""
        links:
          a:
            inertial: {mass: 2, inertia: {ixx: 1, iyy: 1, izz: 1, ixz: 0.5}}
            physics: {gravity: false, mu: 0.5}
    """)


def test_an_axis_is_a_letter_or_what_was_once_written():
    limits = JointLimits(-7, 7, 10, 1)
    joints = [
        Joint("one", JointType.REVOLUTE, "a", "b", axis=Vector3(0, 0, -1), limits=limits, dynamics=JointDynamics()),
        Joint("two", JointType.CONTINUOUS, "b", "c", axis=Vector3(0, 1, 0), axis_as_written=Vector3(0, 2, 0)),
    ]
    assert spec(links=[Link("a"), Link("b"), Link("c")], joints=joints) == lines("""
        links:
          a: {}
          b: {}
          c: {}

        joints:
          one:
            type: revolute
            parent: a
            child: b
            axis: -z
            limits: {lower: -7 rad, upper: 7 rad, effort: 10, velocity: 1}
            dynamics: {}
          two: {type: continuous, parent: b, child: c, axis: [0, 2, 0]}
    """)


def test_empty_links_at_the_end_are_frames():
    joints = [
        Joint("tool0_joint", JointType.FIXED, "base", "tool0", Transform(Vector3(0, 0, 1))),
        Joint("eye", JointType.FIXED, "tool0", "camera"),
    ]
    assert spec(links=map(Link, ["base", "tool0", "camera"]), joints=joints) == lines("""
        links:
          base: {}

        frames:
          tool0: {parent: base, origin: [0, 0, 1]}
          camera: {parent: tool0, joint: eye}
    """)


def test_a_bare_link_that_others_hang_on_is_no_frame():
    text = "linkforge: 1\nname: r\nlinks: {b: , world: }\njoints: {j: {type: fixed, parent: world, child: b}}\n"
    robot = compile_text(text).result()
    assert compile_text(write_spec(robot)).result() == robot


def test_empty_links_before_others_stay_links_for_the_sake_of_their_order():
    joints = [Joint(f"{name}_joint", JointType.FIXED, "base", name) for name in ("tool0", "body")]
    assert spec(links=[Link("base"), Link("tool0"), Link("body", Inertial(1))], joints=joints) == lines("""
        links:
          base: {}
          tool0: {}
          body: {inertial: {mass: 1, inertia: {ixx: 1e-9, iyy: 1e-9, izz: 1e-9}}}

        joints:
          tool0_joint: {type: fixed, parent: base, child: tool0}
          body_joint: {type: fixed, parent: base, child: body}
    """)


def test_a_block_follows_its_subject_if_the_order_allows():
    blocks = [
        GazeboElement("b", {"mu1": "0.9", "other": "1.10"}),
        GazeboElement("b", static=True),
        GazeboElement("a", {"kp": "1e6"}, [GazeboPlugin("p", "p.so"), GazeboPlugin("p", "q.so")]),
        GazeboElement("b", {"later": ""}),
    ]
    assert spec(links=[Link("a"), Link("b")], gazebo_elements=blocks) == lines("""
        links:
          a: {}
          b:
            gazebo: [{mu1: 0.9, properties: {other: 1.10}}, {static: true}]

        gazebo:
          - reference: a
            properties: {kp: 1e6}
            plugins: [{name: p, filename: p.so}, {name: p, filename: q.so}]
          - {reference: b, properties: {later: ""}}
    """)


def test_free_parts_are_written_as_they_are_read():
    noise = {
        "noise": {"_type": "gaussian", "mean": "0", "text": "null", "big": "1e400"},
        "bias": ("1.0", "yes"),
        "none": "",
    }
    plugin = GazeboPlugin("p", "p.so", noise)
    assert spec(gazebo_elements=[GazeboElement(plugins=[plugin])]) == lines("""
        gazebo:
          plugins:
            p:
              filename: p.so
              parameters:
                noise: {_type: gaussian, mean: 0, text: "null", big: "1e400"}
                bias: [1.0, "yes"]
                none: ""
    """)


def test_an_interface_with_parameters_makes_a_map_of_its_list():
    joint = Ros2ControlJoint("j", [Interface("position", {"min": "-1"}), "velocity"], ["position"])
    assert spec(
        ros2_controls=[Ros2Control("arm", "system", "mock/System", [joint], parameters={"slow": "007"})]
    ) == lines("""
        ros2_control:
          arm:
            hardware_plugin: mock/System
            parameters: {slow: 007}
            joints:
              j: {command_interfaces: {position: {min: -1}, velocity: {}}, state_interfaces: [position]}
    """)


def test_a_sensor_leaves_out_what_its_type_has_by_itself():
    eye = Sensor("eye", SensorType.CAMERA, "head", 10, camera_info=CameraInfo(width=320), topic="rgb")
    assert spec(sensors=[eye]) == lines("""
        sensors:
          eye: {type: camera, link: head, update_rate: 10, topic: rgb, camera: {width: 320}}
    """)


def test_states_and_pairs_of_one_name_come_together():
    semantic = SemanticRobotDescription(
        groups=[PlanningGroup("arm", joints=["j"])],
        group_states=[
            GroupState("up", "arm", {"j": 1.5}),
            GroupState("flat", "hand", {"k": [1, 2]}),
            GroupState("down", "arm"),
        ],
        disabled_collisions=[CollisionPair("a", "b", "Never"), CollisionPair("c", "d"), CollisionPair("a", "d")],
    )
    assert spec(semantic=semantic) == lines("""
        semantic:
          groups: {arm: {joints: [j]}}
          group_states:
            arm: {up: {j: 1.5}, down: {}}
            hand: {flat: {k: [1, 2]}}
          disabled_collisions: {a: {b: Never, d: null}, c: {d: null}}
    """)


def test_text_that_looks_like_an_expression_is_none():
    robot = Robot("r", links=[Link("a", visuals=[Visual(Mesh("$(find arm)/a.stl"))])], metadata={"note": "$$(x)"})
    assert "mesh: $$(find arm)/a.stl" in write_spec(robot)
    again = compile_text(write_spec(robot)).result()
    assert again.links == robot.links
    assert again.metadata == robot.metadata


def test_raw_xml_and_metadata_are_kept():
    robot = Robot(
        "r",
        "1.0",
        metadata={"author": "me", "parts": [1, 2.5, True, None], "since": {"year": "2026"}},
        links=[Link("a", extra_elements=["<x/>", "<y>\n  <z/>\n</y>"], extra_attributes=[("type", "1")])],
        extra_elements=["<self/>"],
        version_stated=True,
    )
    assert write_spec(robot) == lines("""
        linkforge: 1
        name: r
        version: "1.0"

        metadata:
          author: me
          parts: [1, 2.5, true, null]
          since: {year: "2026"}

        links:
          a:
            extra:
              - <x/>
              - |-
                <y>
                  <z/>
                </y>
            extra_attributes: {type: 1}

        extra: <self/>
    """)
    assert compile_text(write_spec(robot)).result() == robot


def test_what_people_wrote_about_the_robot_comes_back_as_written():
    robot = compile_text("""
linkforge: 1
name: r
description: "It's an arm: $$(x)"
metadata: {version: 1.10, rev: 007, sha: 1e6, on: yes, count: 3, share: 0.5, made: $(1 / 4), of: [1.0, 0x10]}
links: {a: }
""").result()
    assert robot.metadata == {
        **{"version": "1.10", "rev": "007", "sha": "1e6", "on": "yes"},
        **{"count": 3, "share": 0.5, "made": 0.25, "of": ["1.0", "0x10"]},
    }
    written = write_spec(robot)
    assert '''description: "It's an arm: $$(x)"''' in written
    again = compile_text(written).result()
    assert again == robot
    assert write_spec(again) == written


def test_two_things_of_one_name_cannot_be_written():
    sensor = Sensor("eye", SensorType.RAY, "a")
    with pytest.raises(RobotGeneratorError, match="a spec can have only one sensor 'eye', found two"):
        write_spec(Robot("r", links=[Link("a")], sensors=[sensor, sensor]))
    pair = CollisionPair("a", "b")
    with pytest.raises(RobotGeneratorError, match="one collision pair of 'a' 'b', found two"):
        write_spec(Robot("r", semantic=SemanticRobotDescription(disabled_collisions=[pair, pair])))


def test_a_built_robot_compiles_to_itself():
    arm = Link("arm", Inertial(1, inertia=InertiaTensor(1, 1, 1)), visuals=[Visual(Box(Vector3(1, 1, 1)))])
    limits = JointLimits(-1, 1, 10, 1)
    joint = Joint("hinge", JointType.REVOLUTE, "base", "arm", axis=Vector3(0, 1, 0), limits=limits)
    robot = Robot("built", links=[Link("base"), arm], joints=[joint])
    assert compile_text(write_spec(robot)).result() == robot
