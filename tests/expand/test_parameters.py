"""Test the types of parameters, values from text and Python, and the places of faults."""

from fractions import Fraction

import pytest

from linkforge_compile import compile_text
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand import arguments_from_text, arguments_from_values, expand
from linkforge_compile.load import Loader
from linkforge_compile.units import Dimension, Quantity
from tests.expand.assembling import assemble, metadata_of, write

LENGTH = Dimension.LENGTH


@pytest.mark.parametrize(
    ("declared", "text", "value"),
    [
        ("{type: number}", "1e-3", 0.001),
        ("{type: integer}", "3.0", 3),
        ("{type: boolean}", "true", True),
        ("{type: string}", "1.10", "1.10"),
        ("{type: string}", "3 kg", "3 kg"),
        ("{type: string}", "$(1)", "$(1)"),
        ("{type: string}", "", ""),
        ("{type: string}", "null", "null"),
        ("{type: length}", "70 cm", Quantity(0.7, LENGTH)),
        ("{type: length}", "2", Quantity(2.0, LENGTH)),
        ("{type: vector}", "[0, 0, 10 mm]", [0, 0, Quantity(0.01, LENGTH)]),
        ("{type: vector}", "0.1\n0.2\n0.3", [0.1, 0.2, 0.3]),
        ("{type: list}", "[a, 1]", ["a", 1]),
        ("{type: map}", "{a: {b: 1}}", {"a": {"b": 1}}),
        ("2.5", "3", 3),
        ("0.8 m", "70 cm", Quantity(0.7, LENGTH)),
        ("[0, 0, 1]", "[1, 2, 3]", [1, 2, 3]),
        ("[0, 0]", "[1]", [1]),
        ("true", "false", False),
        ("left", "7", "7"),
    ],
)
def test_text_is_read_by_the_declared_type(declared: str, text: str, value: object):
    for pair in (f"p={text}", f"p:={text}"):
        assembled = assemble(f"parameters: {{p: {declared}}}\nmetadata: {{p: $(p)}}", pair)
        assert not assembled.messages
        assert assembled.metadata == {"p": value}


@pytest.mark.parametrize(
    ("declared", "given", "value"),
    [
        ("{type: length}", 0.7, Quantity(0.7, LENGTH)),
        ("{type: length}", "70 cm", Quantity(0.7, LENGTH)),
        ("{type: length}", Quantity(0.7, LENGTH), Quantity(0.7, LENGTH)),
        ("{type: vector}", (1, 2.0, 3), [1, 2.0, 3]),
        ("{type: map}", {"a": [1, None]}, {"a": [1, None]}),
        ("{type: boolean}", False, False),
        ("0.8 m", None, Quantity(0.8, LENGTH)),
    ],
)
def test_python_values_set_parameters(declared: str, given: object, value: object):
    assembled = assemble(f"parameters: {{p: {declared}}}\nmetadata: {{p: $(p)}}", p=given)
    assert not assembled.messages
    assert assembled.metadata == {"p": value}


def test_a_python_value_that_no_spec_can_say_is_a_type_error():
    with pytest.raises(TypeError, match="'p' cannot be object"):
        arguments_from_values({"p": object()})
    with pytest.raises(TypeError, match="'p' cannot be bytes"):
        arguments_from_values({"p": b"x"})


@pytest.mark.parametrize(
    ("declared", "given", "found"),
    [
        ("number", 10**400, "a bare number, found 'inf'"),
        ("number", Fraction(-(10**400)), "a bare number, found '-inf'"),
        pytest.param("number", -(10**5000), "a bare number, found '-inf'", id="too long for str()"),
        ("vector", [0, 0, 10**400], "three numbers, found 'inf' for z"),
        ("vector", ".nan 0 0", "three numbers, found 'nan' for x"),
        ("vector", "[0, true, 0]", "three numbers, found 'true' for y"),
        ("vector", "[0, 1]", "three numbers, found a list of 2"),
    ],
)
def test_what_is_no_finite_number_is_reported(declared: str, given: object, found: str):
    spec = f"linkforge: 1\nname: a\nparameters: {{p: {{type: {declared}}}}}\nlinks: {{a: }}\n"
    (reported,) = compile_text(spec, parameters={"p": given}).diagnostics
    assert (reported.code.id, reported.message) == ("LF3023", f"parameter 'p' takes {found}")


def test_text_that_cannot_be_encoded_is_reported_where_a_plugin_reads_it():
    spec = (
        "linkforge: 1\nname: a\nparameters: {p: {type: string}}\nlinks: {a: }\n"
        "gazebo: {plugins: {p: {filename: p.so, parameters: {x: $(p)}}}}\n"
    )
    (reported,) = compile_text(spec, parameters={"p": "\ud800"}).diagnostics
    assert reported.code.id == "LF7001"
    assert "U+D800" in reported.message


@pytest.mark.parametrize(
    ("given", "remedy"),
    [
        (None, "parameters={'reach': …} or variant='long'"),
        ({"size": 2}, "parameters={'reach': …} or variant='long'"),
        ([], "'-p reach=LENGTH' or '--variant long'"),
        (["size=2"], "'-p reach=LENGTH' or '--variant long'"),
    ],
)
def test_a_missing_parameter_is_reported_with_how_to_set_it(given: object, remedy: str):
    spec = "linkforge: 1\nname: a\nparameters: {reach: {type: length}, size: 1}\nvariants: {long: {reach: 2 m}}\n"
    messages = [one.message for one in compile_text(f"{spec}links: {{a: }}\n", parameters=given).diagnostics]
    assert messages == [f"parameter 'reach' has no default and must be set; write {remedy}"]


def test_a_default_may_name_other_parameters_in_any_order():
    text = """
        parameters: {half: $(reach / 2), reach: {type: length, default: 1 m, maximum: $(longest)}, longest: 2 m}
        metadata: {half: $(half)}
    """
    assert assemble(text, "reach=1.5 m").metadata == {"half": Quantity(0.75, LENGTH)}
    assert assemble(text, "half=3 kg").messages == [
        "parameter 'half' takes a length in m, cm or mm, found '3 kg', which is a mass"
    ]


def test_an_argument_of_null_leaves_the_default(tmp_path):
    write(
        tmp_path,
        {
            "robot.robot.yaml": "modules: {a: {use: arm.robot.yaml, with: {reach: null, side: $(null)}}}",
            "arm.robot.yaml": "parameters: {reach: 1, side: left}\nmetadata: {a: $(reach), b: $(side)}",
        },
    )
    sink, loader = Diagnostics(), Loader()
    spec = loader.open(tmp_path / "robot.robot.yaml", sink)
    (arm,) = expand(spec, arguments_from_text((), sink), loader, sink).modules
    assert metadata_of(arm) == {"a": 1, "b": "left"}


def test_a_default_that_is_computed_is_so_only_where_it_is_used():
    text = "parameters: {teeth: 0, ratio: {type: number, default: $(1 / teeth)}}"
    assert assemble(text).messages == ["'/' divides by zero"]
    assert not assemble(text, "ratio=2").messages


def test_an_invalid_value_is_reported_on_the_command_line_with_the_declaration():
    sink, loader = Diagnostics(), Loader()
    spec = loader.parse("linkforge: 1\nname: a\nparameters:\n  reach: {type: length}\n", "a.yaml", None, sink)
    expand(spec, arguments_from_text(["reach:=3 kg"], sink), loader, sink)
    (diagnostic,) = sink
    assert str(diagnostic.span) == "<command line>:1:8"
    assert diagnostic.span.text == "3 kg"
    assert [(note.message, str(note.span)) for note in diagnostic.notes] == [
        ("the parameter is declared here", "a.yaml:4:3")
    ]


def test_an_unknown_parameter_offers_a_near_one():
    assert assemble("parameters: {reach: 1 m}", "raech=2").messages == [
        "no parameter named 'raech'; did you mean 'reach'?"
    ]


def test_malformed_and_duplicate_assignments_are_reported():
    sink = Diagnostics()
    arguments = arguments_from_text(["reach", "=1", "a=1", "a:=2", "url=x:=y"], sink)
    assert [diagnostic.message for diagnostic in sink] == [
        "a parameter is set by NAME=VALUE, found 'reach'",
        "a parameter is set by NAME=VALUE, found '=1'",
        "parameter 'a' is set twice",
    ]
    assert {name: entry.value.text for name, entry in arguments.entries.items()} == {"a": "1", "url": "x:=y"}


def test_an_invalid_list_on_the_command_line_is_reported():
    assert assemble("parameters: {p: [0, 0]}", "p=[1, 2").messages == ["expected ',' or ']' before this"]


def test_an_invalid_default_is_reported_even_if_unused():
    messages = assemble("parameters: {reach: {type: length, default: 3 kg}}", "reach=1").messages
    assert messages == ["parameter 'reach' takes a length in m, cm or mm, found '3 kg', which is a mass"]


def test_a_bare_angle_beyond_a_whole_turn_is_doubted():
    text = "parameters: {tilt: {type: angle, default: 0}}"
    assert "write '90 deg' if you mean degrees" in assemble(text, "tilt=90").messages[0]
    assert not assemble(text, "tilt=720 deg").messages


def test_a_file_is_relative_to_the_file_that_writes_it_and_comes_out_relative_to_the_compiled_one(tmp_path):
    write(
        tmp_path,
        {
            "robot.robot.yaml": """
                modules:
                  a: {use: arms/arm.robot.yaml, with: {shell: meshes/a.stl}}
                  b: {use: arms/arm.robot.yaml}
                  c: {use: arms/arm.robot.yaml, with: {shell: package://p/a.stl}}
                  d: {use: package://arms/arm.robot.yaml, with: {shell: meshes/a.stl}}
                packages: {arms: arms}
            """,
            "arms/arm.robot.yaml": """
                parameters: {shell: {type: file, default: own.stl}}
                metadata: {shell: $(shell)}
            """,
        },
    )
    sink, loader = Diagnostics(), Loader()
    spec = loader.open(tmp_path / "robot.robot.yaml", sink)
    instance = expand(spec, arguments_from_text((), sink), loader, sink)
    assert [metadata_of(module) for module in instance.modules] == [
        {"shell": "meshes/a.stl"},
        {"shell": "arms/own.stl"},
        {"shell": "package://p/a.stl"},
        {"shell": (tmp_path / "meshes/a.stl").as_posix()},
    ]


def test_a_parameter_is_set_by_its_name():
    with pytest.raises(TypeError, match="a parameter is set by its name, which is text, found 1"):
        arguments_from_values({1: 2})
