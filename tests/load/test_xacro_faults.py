"""Test that faults of a xacro are reported where they are written, in the terms of its author."""

from pathlib import Path

import pytest

from linkforge_compile import import_urdf

pytest.importorskip("xacro")

HEAD = '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/>'
MACRO = '<xacro:macro name="rod" params="length *origin"><link name="${length}"/></xacro:macro>'


def fault_in(folder: Path, *lines: str) -> tuple[str, str, list[tuple[str, int]]]:
    """Return the code and message of the one diagnostic, and its places, each the text from there and the line."""
    file = folder / "a.urdf.xacro"
    file.write_text("\n".join((HEAD, *lines, "</robot>")), "utf-8")
    [diagnostic] = import_urdf(file).diagnostics
    text = file.read_text("utf-8").splitlines()
    spans = (diagnostic.span, *(note.span for note in diagnostic.notes))
    places = [(text[span.line - 1][span.column - 1 : span.end_column - 1], span.line) for span in spans]
    return diagnostic.code.id, diagnostic.message, places


GIVES_UP = "xacro fails here: "


@pytest.mark.parametrize(
    ("line", "message", "place"),
    [
        (
            '<link name="${lenght}"/>',
            "xacro has no property or parameter named 'lenght' here; did you mean 'length'?",
            "${lenght}",
        ),
        (
            '<xacro:rood length="1"/>',
            "xacro has no macro named 'rood' here; did you mean 'rod'?",
            "<xacro:rood",
        ),
        (
            '<xacro:rod length="1"/>',
            f"{GIVES_UP}the macro takes a block more, an element inside of the call",
            "<xacro:rod",
        ),
        ('<xacro:rod size="1"/>', f"{GIVES_UP}the macro takes no 'size'", "<xacro:rod"),
        ('<xacro:if value="maybe"/>', f"{GIVES_UP}the condition is true or false, found 'maybe'", "<xacro:if"),
        (
            """<link name="${dict(a=1)['b']}"/>""",
            f"{GIVES_UP}there is no key 'b', in '${{dict(a=1)['b']}}'",
            "${dict(a=1)['b']}",
        ),
        (
            """<link name="${'long' / 2}"/>""",
            f"{GIVES_UP}'/' takes numbers, found a text, in '${{'long' / 2}}'",
            "${'long' / 2}",
        ),
        (
            """<link name="${'long' * 0.5}"/>""",
            f"{GIVES_UP}'*' takes numbers, found a text, in '${{'long' * 0.5}}'",
            "${'long' * 0.5}",
        ),
        ('<link name="$(env NONE_SUCH)"/>', f"{GIVES_UP}the environment variable NONE_SUCH is not set", "<link"),
    ],
)
def test_a_fault_is_reported_at_the_expression_or_call(line: str, message: str, place: str, tmp_path: Path):
    _, words, places = fault_in(tmp_path, MACRO, line)
    assert (words, places) == (message, [(place, 3)])


def test_a_faulty_property_is_reported_there_and_where_it_is_needed(tmp_path: Path):
    property_ = '<xacro:property name="table" value="${1 / 0}"/>'
    code, message, places = fault_in(tmp_path, property_, '<link name="${table}"/>')
    assert (code, message) == ("LF8032", "xacro fails here: division by zero, in '${1 / 0}'")
    assert [line for _, line in places] == [2, 3]


def test_a_missing_file_is_reported_with_a_similar_one(tmp_path: Path):
    (tmp_path / "limits.yaml").write_text("a: 1\n", "utf-8")
    code, message, [(_, line)] = fault_in(tmp_path, "<link name=\"${xacro.load_yaml('limit.yaml')}\"/>")
    assert (code, line) == ("LF8064", 2)
    assert message.startswith("xacro needs the file '")
    assert message.endswith("limit.yaml', which does not exist; did you mean 'limits.yaml'?")


def test_a_fault_in_a_nested_macro_is_reported_in_that_macro(tmp_path: Path):
    lines = (
        '<xacro:macro name="inner" params="a">',
        '<link name="${b}"/></xacro:macro>',
        '<xacro:macro name="outer" params="a"><link name="c"/>',
        '<xacro:inner a="${none}"/>',
        '</xacro:macro><xacro:outer a="1"/>',
    )
    assert fault_in(tmp_path, *lines)[2][0][1] == 5
    assert fault_in(tmp_path, *(line.replace("none", "a") for line in lines))[2][0][1] == 3


@pytest.mark.parametrize("name", ["", 'name="a"'])
def test_a_xacro_that_only_declares_macros_is_no_robot(name: str, tmp_path: Path):
    file = tmp_path / "macros.xacro"
    file.write_text(f'<robot {name} xmlns:xacro="http://www.ros.org/wiki/xacro">{MACRO}</robot>', "utf-8")
    [diagnostic] = import_urdf(file).diagnostics
    assert (diagnostic.code.id, diagnostic.span and diagnostic.span.line) == ("LF8039", 1)


def test_a_xacro_that_makes_nothing_is_no_robot(tmp_path: Path):
    file = tmp_path / "nothing.xacro"
    empty = '<xacro:if value="false"><link name="a"/></xacro:if>'
    file.write_text(f'<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">{empty}</robot>', "utf-8")
    [diagnostic] = import_urdf(file).diagnostics
    assert (diagnostic.code.id, diagnostic.span and diagnostic.span.line) == ("LF8066", 1)


@pytest.mark.parametrize(("given", "size"), [("reach=70cm", "0.35"), ("reach:=0.70", "0.35"), ("reach=2", "1.0")])
def test_a_quantity_on_the_command_line_is_a_number_to_xacro(given: str, size: str, tmp_path: Path):
    file = tmp_path / "a.urdf.xacro"
    box = '<visual><geometry><sphere radius="${$(arg reach) / 2}"/></geometry></visual>'
    file.write_text(f'{HEAD}<xacro:arg name="reach" default="1"/><link name="l">{box}</link></robot>', "utf-8")
    assert f"sphere: {size}}}" in (import_urdf(file, arguments=[given]).text or "")
