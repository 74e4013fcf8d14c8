"""Every fix of every bad spec: what it corrects is gone, and it brings no error; so with the comments that ignore."""

import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import pytest

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostic, Severity
from linkforge_compile.diagnostics.fix import Edit, Fix, apply_edits
from linkforge_compile.diagnostics.grouping import ungrouped
from linkforge_compile.pipeline import compile_path
from linkforge_compile.roots import identity
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.ignore_comments import ignore_fix

BAD = sorted((Path(__file__).parent / "cases" / "bad").glob("*.yaml"))

UNCOVERED = {
    # the fix is right, and shows an error that was hidden by what it corrects
    **dict.fromkeys(("LF2201_forgotten_expression", "LF5140_shape_order_of_other_shapes"), "the value is wrong, too"),
    **dict.fromkeys(("LF2201_numbers_written_otherwise", "LF2201_one_for_a_list"), "the value is wrong, too"),
    **dict.fromkeys(("LF3053_text_that_is_no_number", "LF3107_forgotten_for"), "the value is wrong, too"),
    **dict.fromkeys(
        ("LF2202_unknown_word", "LF5007_unknown_word", "LF5006_values_of_a_data_file"), "a joint lacks more"
    ),
    **dict.fromkeys(("LF5002_a_faulty_joint_is_judged_whole",), "a joint lacks more"),
    **dict.fromkeys(("LF2101_unknown_key_in_what_an_expression_makes", "LF3010_module_without_a_file"), "of no file"),
    **dict.fromkeys(("LF3001_no_such_file", "LF3005_unknown_package"), "the module lacks a parameter"),
    **dict.fromkeys(("LF2201_module_without_use", "LF3001_include_of_no_file"), "the file has names of its own"),
    **dict.fromkeys(("LF2101_habits_of_xacro", "LF2101_said_at_another_place"), "the module has no such parameter"),
    **dict.fromkeys(
        ("LF2201_translated_srdf", "LF3102_unclosed_expression", "LF3102_unclosed_in_braces"), "the value is wrong, too"
    ),
    **dict.fromkeys(("LF2101_misspelt_default", "LF2201_group_without_its_keys"), "the name in it is unknown"),
    "LF6114_package_of_a_plugin": "the package is unknown",
    "LF2101_entries_outside_their_indentation": "the name of another link is misspelt",
    "LF2101_things_under_other_keys": "the name of a link is misspelt",
    "LF2101_keys_that_belong_together": "a joint lacks more",
    "LF2155_lines_of_sections_lost": "the lines of other sections are lost, too",
    **dict.fromkeys(("LF3225_override_with_nothing", "LF3204_key_that_does_not_tell_apart"), "the entry is used"),
    "LF1007_map_without_braces": "of two fixes, one is right",
    "LF5324_mount_and_joint_of_a_group": "a group names the joint",
    # the fix, which is not safe, is wrong
    **dict.fromkeys(("LF3020_unknown_parameter", "LF4103_state_of_a_module"), "the name is there already"),
    "LF2101_entry_outside_its_section": "of two sections, one is wrong",
    "LF3091_link_outside_free_parts": "a joint is no child of a joint",
    "LF3221_override_of_what_is_not_there": "the link that the override deletes is used",
    "LF1005_space_after_dash_of_a_map": "the next line was aligned without the space",
}
"""The cases of which a fix may show another error, and why."""

HINT = re.compile(
    r"did you mean|; (?:or )?(?:delete|keep|leave|put|remove|set|swap|use|write)\b|\bwrite [`']|leave .* out\b"
    r"|put .* in quotes"
)
"""The words of a message that say what to write, or what to leave out."""

OF_THE_USER = "only the user knows what to write for a name in capitals, or after 'such as'"
THERE_ALREADY = "the key is there already, and would be written twice"

WITHOUT_FIX = {
    # code, or code and case: why its hint has no fix
    **dict.fromkeys(("LF3010", "LF3021", "LF3030", "LF3092", "LF3093", "LF3110", "LF5005"), OF_THE_USER),
    **dict.fromkeys(
        ("LF1201", "LF1202 LF1275_ignore_written_otherwise", "LF1275 LF1275_ignore_written_otherwise"), OF_THE_USER
    ),
    **dict.fromkeys(("LF2201 LF2201_list_of_things", "LF2201 LF2201_wrong_kind"), OF_THE_USER),
    **dict.fromkeys(("LF2201 LF2201_thing_without_its_name", "LF2201 LF2201_line_with_a_name_missing"), OF_THE_USER),
    **dict.fromkeys(("LF2201 LF4104_states_turned_round", "LF2101 LF2101_entry_outside_its_section"), OF_THE_USER),
    **dict.fromkeys(("LF3107 LF3107_forgotten_for", "LF5101"), OF_THE_USER),
    **dict.fromkeys(("LF2101 LF2201_translated_srdf", "LF2101 LF2201_group_without_its_keys"), THERE_ALREADY),
    **dict.fromkeys(("LF2101 LF2101_unknown_key", "LF2101 LF2101_things_under_other_keys"), THERE_ALREADY),
    "LF1019 LF1019_half_a_character": "the other half is not in the text",
    "LF1111": "what is merged, and in what order, is not in the text",
    "LF1114": "the values of a file of data are those of the robot",
    "LF2101 LF2101_said_at_another_place": "'semantic' takes a map, and 'srdf' names a file",
    "LF2101 LF2101_habits_of_xacro": "a macro needs a file of its own",
    "LF2155 LF2155_lines_of_sections_lost": "the lines of all sections are lost, and nobody knows which comes first",
    "LF2201 LF2201_faulty_parameters_and_repetition": "an entry of the list is no parameter",
    "LF3003": "the robot of an SRDF is in another file",
    "LF3040": "any other name will do, and all that refer to it have it",
    "LF3061": "one of two different entries is right",
    "LF3062": "the other file may have it already",
    **dict.fromkeys(("LF3208", "LF3211"), "what repeats an entry may not be about all of a value"),
    "LF4003": "all that refer to the link have its name",
    "LF4111": "one of two values is right",
    "LF5323": "a joint cannot be left out without its links",
    **dict.fromkeys(("LF7001", "LF7145", "LF7160"), "raw XML is the user's own"),
}
"""The hints without a fix, and why. A new hint gets a fix, or a line here."""


def compiled(path: Path, buffers: dict[str, str] | None = None) -> list[Diagnostic]:
    return [*ungrouped(compile_path(path, Settings(parameters=[], buffers=buffers or {})).diagnostics)]


def applied(fix: Fix) -> dict[str, str]:
    """Return the texts after a fix by real path."""
    edits: dict[SourceFile, list[Edit]] = {}
    for edit in fix.edits:
        edits.setdefault(edit.span.file, []).append(edit)
    return {identity(file.path): apply_edits(file, some) for file, some in edits.items() if file.path}


def tally(diagnostics: Iterable[Diagnostic]) -> Counter[tuple[str, str]]:
    return Counter((one.code.id, one.message) for one in diagnostics)


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.name)
def test_a_fix_corrects_its_diagnostic_and_brings_no_error(path: Path):
    before = compiled(path)
    was = tally(before)
    for one in before:
        for fix in one.fixes:
            after = compiled(path, applied(fix))
            # The next line of the same list may be outdented as well.
            assert tally(after)[one.code.id, one.message] < was[one.code.id, one.message] or one.code.id == "LF1077", (
                fix
            )
            errors = [
                str(new) for new in after if new.severity is Severity.ERROR and was[new.code.id, new.message] == 0
            ]
            is_syntax = one.code.id.startswith("LF10")  # what cannot be read is not checked
            assert not errors or is_syntax or path.stem in UNCOVERED, f"{one}: {fix.title}: {errors}"


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.name)
def test_a_hint_has_a_fix(path: Path):
    """What the message says to write is an action of the editor."""
    left = [one for one in compiled(path) if HINT.search(one.message) and not one.fixes]
    assert [str(one) for one in left if {one.code.id, f"{one.code.id} {path.stem}"}.isdisjoint(WITHOUT_FIX)] == []


def test_a_hint_without_a_fix_is_one():
    """A line that is not needed any more goes."""
    found: dict[str, set[bool]] = {}
    for path in BAD:
        for one in compiled(path):
            if HINT.search(one.message):
                found.setdefault(f"{one.code.id} {path.stem}", set()).add(not one.fixes)
                found.setdefault(one.code.id, set()).add(not one.fixes)
    assert {name for name in WITHOUT_FIX if True not in found.get(name, ())} == set()
    assert {name for name in WITHOUT_FIX if " " not in name and found.get(name) != {True}} == set()


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.name)
def test_a_comment_that_ignores_a_diagnostic_removes_it_and_nothing_else(path: Path):
    before = compiled(path)
    was = tally(before)
    for one in before:
        if fix := ignore_fix(one):
            now = tally(compiled(path, applied(fix)))
            assert now[one.code.id, one.message] < was[one.code.id, one.message], fix
            assert {code for code, _ in now} <= {code for code, _ in was}, fix


def test_a_case_that_is_excepted_needs_to_be():
    for name in UNCOVERED:
        path = BAD[0].parent / f"{name}.yaml"
        before = compiled(path)
        was = tally(before)
        fixed = [compiled(path, applied(fix)) for one in before for fix in one.fixes]
        errors = [new for after in fixed for new in after if new.severity is Severity.ERROR]
        assert any(was[new.code.id, new.message] == 0 for new in errors), name
