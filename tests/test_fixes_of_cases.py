"""Every fix of every bad spec: what it corrects is gone, and it brings no error; so with the comments that ignore."""

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
