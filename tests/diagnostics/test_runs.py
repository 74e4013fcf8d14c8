"""One report of several runs: each fault once; what only some of them have says in which."""

from linkforge_compile.diagnostics import Code, Severity
from linkforge_compile.diagnostics.runs import merge_reports
from linkforge_compile.source import SourceFile, Span

FAULT = Code("LF0001", Severity.ERROR, "{what} is wrong")


def fault(what: str, line: int):
    """Make a fault of a file that was read for it alone."""
    return FAULT.at(Span(SourceFile("arm.yaml", ""), line, 1, line, 2), what=what)


def test_each_fault_is_told_once_and_says_where_it_shows():
    runs = {
        "the defaults": [fault("all", 3)],
        "variant 'a'": [fault("some", 2), fault("all", 3)],
        "variant 'b'": [fault("all", 3), fault("one", 1), fault("some", 2)],
    }
    told = merge_reports(runs)
    assert [(one.message, [note.message for note in one.notes]) for one in told] == [
        ("one is wrong", ["with variant 'b' only"]),
        ("some is wrong", ["with variant 'a' and variant 'b'"]),
        ("all is wrong", []),
    ]


def test_the_faults_of_one_run_need_no_note():
    assert merge_reports({"the defaults": [fault("it", 1)]})[0].notes == ()
