"""Fixes of diagnostics: what is replaced, and where nothing is."""

import pytest

from linkforge_compile import compile_text
from linkforge_compile.diagnostics import Code, Severity
from linkforge_compile.diagnostics.fix import Edit, Fix, Replacement, apply_edits, without_overlaps
from linkforge_compile.source import SourceFile, Span

UNKNOWN = Code("LF4102", Severity.ERROR, "no link named '{name}'")


def fixed(text: str, name: str, near: str) -> str | None:
    """Return a text in which a name, the whole text, is replaced as suggested; None without a fix."""
    file = SourceFile("test.robot.yaml", text)
    fixes = UNKNOWN.at(file.between(0, len(text)), name=name, near=[near]).fixes
    return apply_edits(file, fixes[0].edits) if fixes else None


@pytest.mark.parametrize(
    ("text", "name", "near", "expected"),
    [
        ("rood", "rood", "rod", "rod"),
        ('"rood"', "rood", "rod", '"rod"'),
        ("'two words'", "two words", "two word", "'two word'"),
        ("parts/rood.yaml", "rood.yaml", "rod.yaml", "parts/rod.yaml"),
        ("5 kgg", "kgg", "kg", "5 kg"),
        (">\n  a rood\n", "rood", "rod", ">\n  a rod\n"),
        ("$(prefix)rood", "left_rood", "left_rod", "$(prefix)rod"),
        ('"$(prefix)rood"', "left_rood", "left_rod", '"$(prefix)rod"'),
    ],
)
def test_a_name_is_replaced_where_it_is_written(text: str, name: str, near: str, expected: str):
    assert fixed(text, name, near) == expected


@pytest.mark.parametrize(
    ("text", "name", "near"),
    [
        ("$(rood)", "rood", "rod"),  # the value of another name
        ("$(side)_hnad", "left_hnad", "left_hand"),
        ("$(prefix)rood", "left_rood", "right_rod"),
        ("rood/rood", "rood", "rod"),
        ("rood", "rood", "roo: d"),  # it would be a map
        ("'rood'", "rood", "ro'd"),
        ("<link name='rood'/>", "rood", "rod"),  # a URDF is not corrected
        ("rood", "rood", "arm"),  # nothing is suggested
    ],
)
def test_nothing_is_replaced_where_it_is_not_certain_what(text: str, name: str, near: str):
    assert fixed(text, name, near) is None


def test_only_another_case_of_letters_is_safe():
    file = SourceFile("test.robot.yaml", "Base")
    is_safe = [
        [fix.is_safe for fix in UNKNOWN.at(file.whole._replace(end_column=5), name="Base", near=near).fixes]
        for near in (["base"], ["Bases"], ["base", "BASE"])
    ]
    assert is_safe == [[True], [False], [False]]


def test_edits_keep_the_byte_order_mark_and_line_ends():
    file = SourceFile("test.robot.yaml", "\ufeffa: 1\r\nb: 2\r\n")
    edits = [Edit(Span(file, 2, 4, 2, 5), "3"), Edit(Span(file, 1, 1, 1, 2), "x")]
    assert apply_edits(file, edits) == "\ufeffx: 1\r\nb: 3\r\n"


def test_of_two_fixes_of_one_text_the_first_is_applied():
    file = SourceFile("test.robot.yaml", "abc def")
    fixes = [Fix("", (Edit(file.between(*place), "x"),)) for place in ((0, 3), (2, 5), (4, 7))]
    assert without_overlaps(fixes) == [fixes[0], fixes[2]]


def test_a_whole_value_of_several_lines_is_replaced():
    file = SourceFile("test.robot.yaml", "a:\n  x: 1\n  y: 2\n")
    fix = Replacement("", "[1, 2]").within(Span(file, 2, 3, 3, 7))
    assert fix is not None
    assert apply_edits(file, fix.edits) == "a:\n  [1, 2]\n"


def test_a_suggestion_in_a_spec_has_its_fix():
    spec = (
        "linkforge: 1\nname: a\nlinks: {base: {}, rod: {}}\njoints: {j: {type: fixed, parent: base, child: 'rood'}}\n"
    )
    (fault,) = (one for one in compile_text(spec).diagnostics if one.code.id == "LF4102")
    (fix,) = fault.fixes
    assert (fix.title, fix.is_safe) == ("write 'rod'", False)
    assert apply_edits(fault.span.file, fix.edits) == spec.replace("rood", "rod")
