"""Which diagnostics a report shows, with which severity, and the report of several runs."""

import pytest

from linkforge_compile.diagnostics import Code, Severity
from linkforge_compile.diagnostics.reports import Selection, merge_reports
from linkforge_compile.source import SourceFile, Span

ERROR = Code("LF5001", Severity.ERROR, "wrong").at(None)
HEAVY = Code("LF6001", Severity.WARNING, "heavy").at(None)
ODD = Code("LF5606", Severity.WARNING, "odd").at(None)
HINT = Code("LF5702", Severity.NOTE, "hint").at(None)
REPORT = (HEAVY, ERROR, ODD, HINT)


@pytest.mark.parametrize(
    ("selection", "expected"),
    [
        (Selection(), [HEAVY, ERROR, ODD, HINT]),
        (Selection(select=("LF6",)), [HEAVY, ERROR]),
        (Selection(ignore=("LF56", "LF6001")), [ERROR, HINT]),
        (Selection(select=("LF5",), ignore=("LF57",)), [ERROR, ODD]),
        (Selection(ignore=("LF5001",)), [HEAVY, ERROR, ODD, HINT]),
        (Selection(errors_only=True), [ERROR]),
    ],
)
def test_warnings_and_notes_are_selected_and_errors_always_reported(selection: Selection, expected: list[object]):
    assert list(selection.of(REPORT)) == expected


def test_warnings_are_errors_on_request_and_notes_are_not():
    diagnostics = Selection(ignore=("LF6",), errors=("LF",)).of(REPORT)
    assert [(one.code.id, one.severity) for one in diagnostics] == [
        ("LF5001", Severity.ERROR),
        ("LF5606", Severity.ERROR),
        ("LF5702", Severity.NOTE),
    ]
    assert ODD.severity is Severity.WARNING


def test_quiet_keeps_the_warnings_that_are_errors():
    diagnostics = Selection(errors=("LF",), errors_only=True).of(REPORT)
    assert [one.code.id for one in diagnostics] == ["LF6001", "LF5001", "LF5606"]


FAULT = Code("LF0001", Severity.ERROR, "{what} is wrong")


def fault(what: str, line: int):
    """Make a fault of a file that was read for it alone."""
    return FAULT.at(Span(SourceFile("arm.yaml", ""), line, 1, line, 2), what=what)


def test_each_fault_is_reported_once_with_its_place():
    runs = {
        "the defaults": [fault("all", 3)],
        "variant 'a'": [fault("some", 2), fault("all", 3)],
        "variant 'b'": [fault("all", 3), fault("one", 1), fault("some", 2)],
    }
    diagnostics = merge_reports(runs)
    assert [(one.message, [note.message for note in one.notes]) for one in diagnostics] == [
        ("one is wrong", ["with variant 'b' only"]),
        ("some is wrong", ["with variant 'a' and variant 'b'"]),
        ("all is wrong", []),
    ]


def test_the_faults_of_one_run_need_no_note():
    assert merge_reports({"the defaults": [fault("it", 1)]})[0].notes == ()
