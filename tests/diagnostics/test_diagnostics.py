"""Diagnostics as values, and as the text that a person reads."""

from difflib import get_close_matches
from textwrap import dedent

import pytest

from linkforge_compile import import_urdf
from linkforge_compile.diagnostics import Code, Diagnostics, Note, Severity, UnresolvedNames, suggest
from linkforge_compile.diagnostics.render_text import render_text, summary
from linkforge_compile.diagnostics.reports import merge_reports
from linkforge_compile.diagnostics.suggest import did_you_mean, nearest
from linkforge_compile.source import SourceFile, SourceRef, Span
from linkforge_compile.syntax.nodes import YamlScalar

UNKNOWN = Code("LF4102", Severity.ERROR, "no link named '{name}'")
HEAVY = Code("LF6001", Severity.WARNING, "{mass} kg is a lot")

MAIN = SourceFile("two.robot.yaml", "modules:\n  left: {use: arm.robot.yaml}\n")
ARM = SourceFile("arm.robot.yaml", "joints:\n\telbow: {child: hnad}\n", order=1)
CHILD = Span(ARM, 2, 17, 2, 21)
USE = Span(MAIN, 2, 15, 2, 29)


def test_the_near_name_is_offered():
    assert UNKNOWN.at(CHILD, name="hnad", near=["hand", "base"]).message == "no link named 'hnad'; did you mean 'hand'?"
    assert UNKNOWN.at(CHILD, name="hnad", near=["torso"]).message == "no link named 'hnad'"


@pytest.mark.parametrize(
    ("name", "candidates", "meant"),
    [
        ("fore_arm", ["forearm", "upper_arm"], "forearm"),
        ("Base_Link", ["base_link", "base"], "base_link"),
        ("wheel", [], None),
        ("", ["base"], None),
        ("x", ["yaw", "pitch"], None),
        ("gpa", ["top", "gap"], "gap"),
        ("rmp", ["rad", "rpm", "m"], "rpm"),
        ("yx", ["xy"], None),
    ],
)
def test_nearest(name: str, candidates: list[str], meant: str | None):
    assert nearest(name, candidates) == meant


@pytest.mark.parametrize("name", ["left_finger_3_lnk", "left_fnger_1", "right_fingers", "finger", "camera", "lefft"])
def test_the_nearest_name_is_that_of_difflib(name: str):
    sides = [f"{side}_finger_{i}_link" for side in ("left", "right") for i in range(20)]
    names = [*sides, *[one.removesuffix("_link") for one in sides], "left", "leaf", "knil_3_regnif_tfel"]
    assert [nearest(name, names)] == (get_close_matches(name, names, n=1, cutoff=0.7) or [None])


def test_nothing_is_suggested_when_a_compile_has_looked_for_long(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(suggest, "_STEPS_OF_A_COMPILE", 100)
    with suggest.suggestion_budget():
        suggestions = [nearest("hnad", ["hand", "base"]) for _ in range(20)]
    assert suggestions[0] == "hand"
    assert suggestions[-1] is None
    assert nearest("hnad", ["hand", "base"]) == "hand"


def test_an_import_looks_no_longer_than_a_compile(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(suggest, "_STEPS_OF_A_COMPILE", 100)
    joints = "".join(
        f"<joint name='j{i}' type='fixed'><parent link='hnad'/><child link='l{i}'/></joint><link name='l{i}'/>"
        for i in range(20)
    )
    diagnostics = import_urdf("r.urdf", text=f"<robot name='r'><link name='hand'/>{joints}</robot>").diagnostics
    wrong = [one.message for one in diagnostics if one.message.startswith("no link named 'hnad'")]
    assert "; did you mean 'hand'?" in wrong[0]
    assert "; did you mean 'hand'?" not in wrong[-1]


def test_a_name_too_long_to_compare_by_eye_is_not_suggested():
    assert nearest("ab" * 5_000, ["ab" * 5_000 + "c", "ab"]) is None
    assert nearest("hnad", ["ab" * 5_000, "hand"]) == "hand"


def test_a_name_is_not_offered_for_itself():
    assert did_you_mean("base", ["base"]) == ""


def test_a_message_does_not_quote_megabytes():
    message = UNKNOWN.at(None, name="a" * 1_000_000).message
    assert len(message) == 2_001
    assert (message[:16], message[-3:]) == ("no link named 'a", "aa'")


def test_a_note_quotes_no_megabytes_nor_control_characters():
    message = Note(f"nor '\x1b{'a' * 1_000_000}'").message
    assert len(message) == 2_004
    assert (message[:10], message[-3:]) == ("nor '\\x1ba", "aa'")


def test_two_faults_that_differ_where_their_messages_leave_words_out_are_two():
    long = "a" * 5_000
    diagnostics = [UNKNOWN.at(CHILD, name=f"{long}{letter}{long}") for letter in "bcb"]
    assert len({one.message for one in diagnostics}) == 1
    sink = Diagnostics()
    sink.report_all(diagnostics)
    assert len(sink.sorted()) == 2
    assert len(merge_reports({"the defaults": diagnostics[:1], "variant 'sim'": diagnostics[1:]})) == 2


def test_a_fault_in_a_module_tells_where_the_module_is_used():
    diagnostic = UNKNOWN.at(SourceRef(YamlScalar("hnad", "hnad", CHILD), trail=(USE,)), name="hnad")
    assert diagnostic.span == CHILD
    assert diagnostic.notes == (Note("used here", USE),)


def test_the_same_fault_is_kept_once():
    sink = Diagnostics()
    sink.report(UNKNOWN.at(CHILD, name="hnad"))
    sink.report(UNKNOWN.at(CHILD, name="hnad", notes=[Note("used here", USE)]))
    sink.report(UNKNOWN.at(CHILD, name="other"))
    assert len(sink) == 2


def test_warnings_are_no_errors():
    sink = Diagnostics()
    sink.report(HEAVY.at(CHILD, mass=1e6))
    assert not sink.has_errors
    sink.report(UNKNOWN.at(None, name="x"))
    assert sink.has_errors


def test_diagnostics_sort_by_file_and_place():
    sink = Diagnostics()
    for place in (CHILD, USE, None):
        sink.report(UNKNOWN.at(place, name="x"))
    assert [diagnostic.span for diagnostic in sink.sorted()] == [None, USE, CHILD]


def test_the_text_shows_the_line_and_a_caret_under_the_words():
    diagnostic = UNKNOWN.at(CHILD, name="hnad", notes=[Note("used here", USE)])
    assert render_text([diagnostic]) == dedent("""\
        arm.robot.yaml:2:17: error: no link named 'hnad' [LF4102]
             2 | \telbow: {child: hnad}
               | \t               ^^^^
        two.robot.yaml:2:15: note: used here
             2 |   left: {use: arm.robot.yaml}
               |               ^^^^^^^^^^^^^^
        """)


def test_colors_are_only_written_on_request():
    diagnostic = UNKNOWN.at(CHILD, name="hnad")
    assert "\033[1;31merror:" in render_text([diagnostic], colour=True)
    assert "\033" not in render_text([diagnostic])


def test_wide_characters_take_two_columns_and_control_characters_never_reach_the_terminal():
    file = SourceFile("a.yaml", "名前: \x1b[31mrot")
    lines = render_text([UNKNOWN.at(Span(file, 1, 5, 1, 13), name="x")]).splitlines()
    assert lines[1] == "     1 | 名前: \N{REPLACEMENT CHARACTER}[31mrot"
    assert lines[2] == "       |       ^^^^^^^^"


@pytest.mark.parametrize(("line", "shown"), [("\t\t", ["     1 | →→", "       | ^"]), ("  ", [])])
def test_tabs_that_stand_alone_on_a_line_can_be_seen(line: str, shown: list[str]):
    assert render_text([UNKNOWN.at(SourceFile("a.yaml", line).whole, name="x")]).splitlines()[1:] == shown


def test_a_very_long_line_is_shown_around_the_fault():
    file = SourceFile("a.yaml", "x" * 5000 + "FAULT" + "y" * 5000)
    _, line, caret = render_text([UNKNOWN.at(Span(file, 1, 5001, 1, 5006), name="x")]).splitlines()
    assert len(line) < 200
    assert line[caret.index("^") : caret.rindex("^") + 1] == "FAULT"


def test_a_span_over_lines_is_marked_to_the_end_of_its_first():
    file = SourceFile("a.yaml", "mesh: {file: a,\n  scale: 2}")
    _, _, caret = render_text([UNKNOWN.at(Span(file, 1, 7, 2, 12), name="x")]).splitlines()
    assert caret.count("^") == len("{file: a,")


def test_a_fault_without_a_place_is_one_line():
    assert render_text([UNKNOWN.at(None, name="x")]) == "error: no link named 'x' [LF4102]\n"


@pytest.mark.parametrize(
    ("codes", "text"), [((), "no errors"), ((UNKNOWN,), "1 error"), ((UNKNOWN, HEAVY, HEAVY), "1 error, 2 warnings")]
)
def test_the_summary_counts(codes: tuple[Code, ...], text: str):
    assert summary([code.at(None, name="x", mass=3) for code in codes]) == text


def test_unresolved_names_cover_names_and_whole_modules():
    unresolved = UnresolvedNames(frozenset({"elbow"}), ("hand_",)).with_prefix("left_") | UnresolvedNames(
        frozenset({"cap"})
    )
    assert "left_elbow" in unresolved
    assert "left_hand_finger" in unresolved
    assert "cap" in unresolved
    assert "elbow" not in unresolved
    assert not UnresolvedNames()
    assert "anything" in UnresolvedNames(prefixes=("",))
