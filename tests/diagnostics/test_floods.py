"""Many faults: which are reported, which are counted, and where the compile ends."""

import pytest

from linkforge_compile.diagnostics import BeyondLimitError, Code, Diagnostics, Severity
from linkforge_compile.diagnostics import sink as flood
from linkforge_compile.diagnostics.codes.modules import MORE_WARNINGS, TOO_MANY_ERRORS
from linkforge_compile.diagnostics.codes.names import UNKNOWN_LINK
from linkforge_compile.diagnostics.render_text import MOST_SHOWN, render_first, summary
from linkforge_compile.diagnostics.sink import MAX_KEPT
from linkforge_compile.source import SourceFile, Span

ERROR = Code("LF1000", Severity.ERROR, "no {name}")
WARNING = Code("LF1000", Severity.WARNING, "hardly {name}")
FILE = SourceFile("a.yaml", "some text")


def at(line: int) -> Span:
    return Span(FILE, line, 1, line, 2)


def test_one_place_is_reported_three_times_and_the_rest_counted():
    sink = Diagnostics()
    for _ in range(2):
        sink.report_all(ERROR.at(at(1), name=number) for number in range(1000))
    sink.report(ERROR.at(at(2), name="other"))
    diagnostics = sink.sorted()
    assert [one.message for one in diagnostics] == ["no 0", "no 1", "no 2", "no other"]
    assert [note.message for one in diagnostics for note in one.notes] == ["and 997 more like this at the same place"]
    assert summary(diagnostics) == "1,001 errors"


def test_text_tells_three_times_of_a_name_that_a_file_has_nowhere_and_counts_the_rest():
    sink, other = Diagnostics(), SourceFile("b.yaml", "some text")
    sink.report_all(UNKNOWN_LINK.at(at(line), name="arm") for line in range(9, 0, -1))
    sink.report_all(UNKNOWN_LINK.at(at(line), name="leg") for line in range(1, 4))
    sink.report(UNKNOWN_LINK.at(Span(other, 1, 1, 1, 2), name="arm"))
    sink.report_all(ERROR.at(at(line), name="x") for line in range(1, 6))
    diagnostics = sink.sorted()
    # What a program reads has each of them.
    assert (len(diagnostics), summary(diagnostics)) == (18, "18 errors")
    lines = [line for line in render_first(diagnostics).splitlines() if "arm" in line or "more" in line]
    assert lines == [
        "a.yaml:1:1: error: no link named 'arm' [LF4102]",
        "a.yaml:2:1: error: no link named 'arm' [LF4102]",
        "a.yaml:3:1: error: no link named 'arm' [LF4102]",
        "a.yaml:4:1: note: and 6 more like this, the next one here",
        "b.yaml:1:1: error: no link named 'arm' [LF4102]",
    ]


def test_the_compile_ends_after_a_thousand_errors():
    sink = Diagnostics()
    sink.report_all(ERROR.at(at(line), name="x") for line in range(MAX_KEPT))
    with pytest.raises(BeyondLimitError) as beyond:
        sink.report(ERROR.at(at(MAX_KEPT), name="x"))
    sink.abort(beyond.value)
    assert (len(sink), sink.sorted()[-1].code) == (MAX_KEPT + 1, TOO_MANY_ERRORS)


@pytest.mark.parametrize("words", ["same", "{}"])
def test_after_very_many_errors_of_one_place_new_ones_are_reported_until_the_compile_ends(
    words: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(flood, "MAX_REPORTED", 50)
    sink = Diagnostics()
    sink.report_all(WARNING.at(at(3), name=number) for number in range(60))
    sink.report_all(ERROR.at(at(2), name=words.format(number)) for number in range(50))
    sink.report(ERROR.at(at(4), name="other"))
    with pytest.raises(BeyondLimitError) as beyond:
        sink.report(ERROR.at(at(2), name=words.format(1)))
    sink.abort(beyond.value)
    errors = [one for one in sink.sorted() if one.severity is Severity.ERROR]
    assert errors[-2].message == "no other"
    assert errors[-1] == sink.sorted()[-1]
    assert (errors[-1].code, errors[-1].span) == (TOO_MANY_ERRORS, at(2))


def test_the_compile_ends_after_very_many_unreported_warnings(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(flood, "MAX_COUNTED", 50)
    sink = Diagnostics()
    sink.report_all(WARNING.at(at(line), name="x") for line in range(MAX_KEPT + 50))
    sink.report(ERROR.at(at(2), name="x"))
    with pytest.raises(BeyondLimitError, match="too many warnings and notes") as beyond:
        sink.report(WARNING.at(at(9999), name="x"))
    sink.abort(beyond.value)
    assert [one.code for one in sink.sorted()[-2:]] == [MORE_WARNINGS, TOO_MANY_ERRORS]


@pytest.mark.parametrize("words", ["same", "{}"])
def test_very_many_warnings_of_one_place_end_nothing(words: str, monkeypatch: pytest.MonkeyPatch):
    """As the rounds of a `for` give them."""
    monkeypatch.setattr(flood, "MAX_COUNTED", 50)
    sink = Diagnostics()
    sink.report_all(WARNING.at(at(1), name=words.format(number)) for number in range(MAX_KEPT + 60))
    assert len(sink.sorted()) == (1 if words == "same" else 3)


def test_warnings_beyond_a_thousand_are_counted_and_end_nothing():
    sink = Diagnostics()
    sink.report_all(WARNING.at(at(line), name="x") for line in range(MAX_KEPT + 5))
    sink.report(ERROR.at(at(9999), name="y"))
    diagnostics = sink.sorted()
    assert (diagnostics[-1].code, diagnostics[-1].message) == (MORE_WARNINGS, "5 more warnings and notes are not shown")
    assert diagnostics[-2].message == "no y"


def test_the_command_shows_the_first_errors_before_any_warning():
    diagnostics = [
        WARNING.at(at(1), name="w"),
        *(ERROR.at(at(line), name="x") for line in range(2, 2 + MOST_SHOWN + 9)),
    ]
    text = render_first(diagnostics)
    assert (text.count("error:"), text.count("warning:")) == (MOST_SHOWN, 0)
    assert text.endswith("… and 9 errors, 1 warning more\n")
    assert "more" not in render_first(diagnostics[:MOST_SHOWN])
