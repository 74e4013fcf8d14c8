"""What of a report is told, and how seriously it is taken."""

import pytest

from linkforge_compile.diagnostics import Code, Severity
from linkforge_compile.diagnostics.selection import Selection

ERROR = Code("LF5001", Severity.ERROR, "wrong").at(None)
HEAVY = Code("LF6001", Severity.WARNING, "heavy").at(None)
ODD = Code("LF5606", Severity.WARNING, "odd").at(None)
HINT = Code("LF5702", Severity.NOTE, "hint").at(None)
REPORT = (HEAVY, ERROR, ODD, HINT)


@pytest.mark.parametrize(
    ("selection", "told"),
    [
        (Selection(), [HEAVY, ERROR, ODD, HINT]),
        (Selection(select=("LF6",)), [HEAVY, ERROR]),
        (Selection(ignore=("LF56", "LF6001")), [ERROR, HINT]),
        (Selection(select=("LF5",), ignore=("LF57",)), [ERROR, ODD]),
        (Selection(ignore=("LF5001",)), [HEAVY, ERROR, ODD, HINT]),
        (Selection(errors_only=True), [ERROR]),
    ],
)
def test_warnings_and_notes_are_chosen_and_errors_always_told(selection: Selection, told: list[object]):
    assert list(selection.of(REPORT)) == told


def test_warnings_are_errors_where_that_is_asked_for_and_notes_are_not():
    told = Selection(ignore=("LF6",), warnings_are_errors=True).of(REPORT)
    assert [(one.code.id, one.severity) for one in told] == [
        ("LF5001", Severity.ERROR),
        ("LF5606", Severity.ERROR),
        ("LF5702", Severity.NOTE),
    ]
    assert ODD.severity is Severity.WARNING


def test_quiet_keeps_the_warnings_that_are_errors():
    told = Selection(warnings_are_errors=True, errors_only=True).of(REPORT)
    assert [one.code.id for one in told] == ["LF6001", "LF5001", "LF5606"]
