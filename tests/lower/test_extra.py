"""`extra`, `extra_attributes` and `extra_inside`: kept unchanged, one text or several."""

from linkforge_compile.core.models.srdf import PlanningGroup
from linkforge_compile.core.part import Inside
from tests.lower.specs import robot_of


def test_raw_xml_is_one_text_or_a_list_of_them():
    robot = robot_of("""
        name: cart
        extra: [<a/>, <b/>]
        links: {base: {extra: "<c>1</c><d/>"}, arm: {extra: " "}}
    """)
    assert robot.extra_elements == ("<a/>", "<b/>")
    assert robot.link("base").extra_elements == ("<c>1</c><d/>",)
    assert robot.link("arm").extra_elements == ()


def test_raw_attributes_are_text_as_written_in_their_order():
    robot = robot_of("""
        name: cart
        links: {base: {extra_attributes: {b: 1.0, a: yes, c: null, d: , e: ""}}}
    """)
    assert robot.link("base").extra_attributes == (("b", "1.0"), ("a", "yes"), ("c", "null"), ("e", ""))


def test_a_copied_shape_keeps_its_own_and_leaves_those_of_the_visual():
    base = robot_of("""
        name: cart
        links: {base: {visual: {sphere: {radius: 1, extra_attributes: {a: 1}}, extra: <v/>}, collision: visual}}
    """).link("base")
    [collision] = base.collisions
    assert collision.geometry.extra_attributes == (("a", "1"),)
    assert collision.extra_elements == ()


def test_raw_xml_is_text():
    robot_of("""
        name: cart
        links: {base: {extra: {a: 1}}}   # E[LF5001]:23 extra takes text, found a map
    """)


def test_an_inner_element_is_named_by_its_tag_and_name():
    robot = robot_of("""
        name: cart
        links:
          base: {collision: {box: {size: [1, 2, 3], extra: <b/>}, extra_inside: {geometry: {extra_attributes: {a: 1}}}}}
          arm:
        joints: {lid: {type: fixed, parent: base, child: arm}}
        ros2_control:
          bus:
            hardware_plugin: p/P
            joints: {lid: {state_interfaces: [position]}}
            parameters: {port: 1, rate: 2}
            extra_inside: {hardware: {extra: <group>a</group>, extra_inside: {param rate: {extra_attributes: {u: Hz}}}}}
    """)
    [collision] = robot.link("base").collisions
    assert collision.geometry.extra_elements == ("<b/>",)
    assert collision.extra_inside == (Inside("geometry", extra_attributes=(("a", "1"),)),)
    rate = Inside("param", "rate", extra_attributes=(("u", "Hz"),))
    assert robot.ros2_control("bus").extra_inside == (
        Inside("hardware", extra_elements=("<group>a</group>",), extra_inside=(rate,)),
    )


def test_short_forms_of_the_semantic_part_have_long_ones():
    semantic = robot_of("""
        name: cart
        links: {base: , arm: }
        joints: {lid: {type: continuous, parent: base, child: arm, axis: x}}
        semantic:
          groups: {all: {joints: [lid], extra_inside: {joint lid: {extra_attributes: {a: 1}}}}}
          group_states: {all: {home: {lid: 0, extra: <s/>}}}
          passive_joints: {lid: {extra: <p/>}}
          disabled_collisions: {base: {arm: {reason: Never, extra: <d/>}}}
          joint_properties: {lid: {wraps: {value: yes, extra: <j/>}}}
          link_sphere_approximations: {base: {spheres: [], extra: <l/>}}
    """).semantic
    parts = ("group_states", "passive_joints", "disabled_collisions", "joint_properties", "link_sphere_approximations")
    found = [part for name in parts for part in getattr(semantic, name)]
    assert [part.extra_elements for part in found] == [("<s/>",), ("<p/>",), ("<d/>",), ("<j/>",), ("<l/>",)]
    assert semantic.groups[0].extra_inside == (Inside("joint", "lid", extra_attributes=(("a", "1"),)),)
    assert semantic.disabled_collisions[0].reason == "Never"
    assert semantic.joint_properties[0].value == "yes"
    assert semantic.group_states[0].joint_values == {"lid": (0.0,)}


def test_names_inside_of_a_group_take_the_prefix():
    group = PlanningGroup("all", joints=["lid"], extra_inside=[Inside("joint", "lid"), Inside("note")])
    assert [one.name for one in group.with_prefix("left_").extra_inside] == ["left_lid", None]
