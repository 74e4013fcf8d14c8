"""`extra` and `extra_attributes`: kept as they stand, one text or several."""

from tests.lowering.specs import robot_of


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
