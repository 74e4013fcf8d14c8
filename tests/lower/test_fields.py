from enum import StrEnum
from textwrap import dedent

import pytest

from linkforge_compile.core import Box, Transform, Vector3
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.lower.elements import lower_pose
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import EXTENT, NumberType
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlMap, YamlScalar, read
from linkforge_compile.units import Dimension


class Colour(StrEnum):
    RED = "red"
    BLUE = "blue"


def fields_of(text: str) -> Fields:
    sink = Diagnostics()
    tree = read(SourceFile("spec.yaml", dedent(text)), sink)
    assert tree is not None
    return Fields(tree, "joint 'elbow'", sink)


def reports_of(fields: Fields) -> list[str]:
    return [str(diagnostic) for diagnostic in fields.sink.sorted()]


def test_what_is_absent_or_null_is_read_as_none_in_silence():
    fields = fields_of("mass: \norigin: null\n")
    assert fields.number("mass") is None
    assert fields.text("name") is None
    assert fields.vector3("axis") is None
    assert lower_pose(fields) == Transform.identity()
    assert reports_of(fields) == []


def test_a_missing_required_field_is_reported_at_the_object_with_a_remedy():
    fields = fields_of("limits: {lower: 0}")
    assert fields.text("parent", required="base") is None
    limits = fields.map("limits")
    assert limits is not None
    assert limits.number("effort", NumberType((Dimension.TORQUE,)), required="50 N*m") is None
    assert reports_of(fields) == [
        "spec.yaml:1:1: error: joint 'elbow' has no 'parent'; write one, such as 'parent: base' [LF5005]",
        "spec.yaml:1:9: error: joint 'elbow' has no 'limits.effort'; write one, such as 'effort: 50 N*m' [LF5005]",
    ]


def test_a_reported_fault_has_no_value_and_is_not_reported_again():
    span = SourceFile("spec.yaml", "a: b").whole
    entry = YamlEntry(YamlScalar("x", "x", span), YamlFault(span))
    fields = Fields(YamlMap({"x": entry}, span), "link 'a'", Diagnostics())
    readers = (fields.number, fields.integer, fields.text, fields.vector3, fields.map)
    assert [read_it("x", required="1") for read_it in readers] == [None] * len(readers)
    assert fields.flag("x") is None
    assert fields.name("x", "link") is None
    assert fields.choice("x", Colour) is None
    assert fields.names("x") == ()
    assert list(fields.each("x", "link", lambda _, name: name)) == []
    assert reports_of(fields) == []


@pytest.mark.parametrize(("text", "number"), [("3", 3), ("3.0", 3), ("-2", -2)])
def test_a_whole_number_is_an_integer(text, number):
    assert fields_of(f"samples: {text}").integer("samples") == number


def test_half_a_sample_is_reported():
    fields = fields_of("samples: 2.5")
    assert fields.integer("samples") is None
    assert reports_of(fields) == ["spec.yaml:1:10: error: samples takes a whole number, found 2.5 [LF5001]"]


def test_only_true_and_false_are_flags():
    assert fields_of("static: false").flag("static") is False
    fields = fields_of("static: 1\ngravity: yes")
    assert fields.flag("static") is None
    assert fields.flag("gravity") is None
    assert reports_of(fields) == [
        "spec.yaml:1:9: error: static takes true or false, found 1 [LF5001]",
        "spec.yaml:2:10: error: 'yes' is text in YAML 1.2, not true or false; write true [LF3143]",
    ]


def test_text_is_taken_as_it_was_written():
    fields = fields_of("version: 1.10\nchild: 1\nflag: true")
    assert [fields.text(key) for key in ("version", "child", "flag")] == ["1.10", "1", "true"]


def test_a_word_is_one_of_its_enumeration():
    assert fields_of("color: blue").choice("color", Colour) is Colour.BLUE
    fields = fields_of("color: blu")
    assert fields.choice("color", Colour) is None
    assert reports_of(fields) == [
        "spec.yaml:1:8: error: color is one of red, blue, found 'blu'; did you mean 'blue'? [LF5007]"
    ]


def test_a_name_with_a_space_is_reported_at_the_name():
    fields = fields_of("joint: left mount")
    assert fields.name("joint", "joint") is None
    assert reports_of(fields) == [
        "spec.yaml:1:8: error: 'left mount' is not a valid name for a joint: it may not contain ' ' [LF4001]"
    ]


def test_an_origin_is_three_lengths_or_a_map_of_xyz_and_rpy():
    zero = Vector3(0, 0, 0)
    assert lower_pose(fields_of("origin: [1, 20 mm, 0]")) == Transform(Vector3(1, 0.02, 0))
    turned = lower_pose(fields_of("origin: {rpy: [0, 0, 1 rev]}"))
    assert (turned.xyz, turned.rpy.z) == (zero, pytest.approx(6.283185307))


def test_each_number_of_a_vector_is_reported_at_its_place():
    fields = fields_of("box: [1, 2 kg, 0]")
    assert fields.vector3("box", EXTENT) is None
    assert reports_of(fields) == [
        "spec.yaml:1:10: error: box takes a length such as '25 mm', found '2 kg', which is a mass [LF5002]",
        "spec.yaml:1:16: error: box must be above 0 m, found 0 [LF5006]",
    ]


def test_the_field_with_the_value_of_an_alias_is_shown():
    fields = fields_of("x-size: &size [1, 2 kg, 3]\nbox: *size\norigin: [1, 2 kg, 3]\n")
    assert fields.vector3("box", EXTENT) is None
    assert fields.vector3("origin", EXTENT) is None
    assert [[str(note.span) for note in one.notes] for one in fields.sink] == [["spec.yaml:2:1"], []]


def test_an_entry_without_a_value_is_an_empty_object_at_its_name():
    fields = fields_of("links: {base: , arm: 3}")
    entries = dict(fields.each("links", "link", lambda link, name: (name, link.key)))
    assert entries["arm"] is None
    name, key = entries["base"]
    assert (name, str(key.span)) == ("base", "spec.yaml:1:9")
    assert reports_of(fields) == ["spec.yaml:1:22: error: link 'arm' takes a map, found 3 [LF5001]"]


def test_what_a_constructor_refuses_is_reported_at_its_field():
    fields = fields_of("size: [1, 0, 1]")
    size = fields.map_at(fields.node, "box")
    assert size is not None
    assert size.build(lambda: Box(Vector3(1.0, -1.0, 1.0))) is None
    assert reports_of(fields) == [
        "spec.yaml:1:1: error: box of joint 'elbow': box dimensions must be positive [m], found 1.0 -1.0 1.0 [LF5011]"
    ]
