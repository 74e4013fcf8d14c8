"""Names in scope: computed on demand, in any order, and never in a cycle."""

from collections.abc import Callable

import pytest

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import FAULT, Fault, Lazy, Scope, Value, evaluate, parse_template
from linkforge_compile.source import SourceFile, Span


class Variables:
    """A scope of variables written as `name: text`, as a spec's `variables` are."""

    def __init__(self, texts: dict[str, str]) -> None:
        self.sink = Diagnostics()
        self.computed: list[str] = []
        lines = [f"{name}: {text}" for name, text in texts.items()]
        self._file = SourceFile("v", "\n".join(lines))
        self.scope = Scope({name: self._lazy(name, line) for line, name in enumerate(texts, start=1)})

    def __getitem__(self, name: str) -> Value | Fault:
        return self.scope.lookup(name, self.sink)

    @property
    def reported(self) -> list[str]:
        return [f"{one.span}: {one.message}" for one in self.sink]

    def _lazy(self, name: str, line: int) -> Lazy:
        return Lazy(self._computation(name, line), Span(self._file, line, 1, line, len(name) + 1))

    def _computation(self, name: str, line: int) -> Callable[[], Value | Fault]:
        written = self._file.line(line)
        text = written[len(name) + 2 :]
        span = Span(self._file, line, len(name) + 3, line, len(written) + 1)

        def compute() -> Value | Fault:
            self.computed.append(name)
            template = parse_template(text, span, self.sink)
            return evaluate(template, self.scope, self.sink) if template else FAULT

        return compute


def test_variables_may_use_one_another_in_any_order_and_are_computed_once():
    variables = Variables({"area": "$(side * side)", "side": "$(half + half)", "half": "$(1.5)"})
    assert variables["area"] == 9.0
    assert variables["side"] == 3.0
    assert variables.computed == ["area", "side", "half"]


def test_unused_values_are_not_computed():
    variables = Variables({"a": "$(1)", "b": "$(nope)"})
    assert variables["a"] == 1
    assert variables.reported == []


def test_a_circle_is_reported_once_as_the_path_round_it():
    variables = Variables({"a": "$(b)", "b": "$(c + 1)", "c": "$(a)", "d": "$(b)"})
    assert [variables[name] for name in "abcd"] == [FAULT] * 4
    assert variables.reported == ["v:1:1: 'a' is computed from itself: a → b → c → a"]
    (circle,) = variables.sink
    assert [str(note.span) for note in circle.notes] == ["v:2:1", "v:3:1"]


def test_a_circle_is_reported_at_its_own_first_name_not_at_who_led_into_it():
    variables = Variables({"start": "$(a)", "a": "$(a)"})
    assert variables["start"] is FAULT
    assert variables.reported == ["v:2:1: 'a' is computed from itself: a → a"]


def test_a_fault_is_reported_where_it_is_and_not_by_those_who_use_it():
    variables = Variables({"a": "$(b + 1)", "b": "$(1 / 0)"})
    assert variables["a"] is FAULT
    assert variables.reported == ["v:2:10: '/' divides by zero"]


def test_a_chain_without_end_is_reported_once():
    texts = {f"v{number}": f"$(v{number + 1})" for number in range(2_000)}
    variables = Variables({**texts, "v2000": "$(1)"})
    assert variables["v0"] is FAULT
    assert variables["v1"] is FAULT
    assert variables.reported == ["v:1:1: 'v0' is computed through more than 64 other names"]
    assert variables["v1990"] == 1


def test_names_of_an_entry_lie_before_those_of_its_file():
    file = Scope({"side": "both", "reach": 1})
    entry = file.inside({"side": "left"})
    sink = Diagnostics()
    assert (entry.lookup("side", sink), entry.lookup("reach", sink)) == ("left", 1)
    assert list(entry) == ["side", "side", "reach"]
    assert "reach" in entry
    assert "end" not in entry


def test_a_name_that_is_not_there_is_the_caller_s_mistake():
    with pytest.raises(KeyError):
        Scope({}).lookup("nope", Diagnostics())


def test_a_template_lists_the_names_it_uses():
    sink = Diagnostics()
    text = "$(sin(a) if b.c else pi)_$(d[e])_$$(f)"
    template = parse_template(text, Span(SourceFile("x", text), 1, 1, 1, len(text) + 1), sink)
    assert template is not None
    assert template.names == {"a", "b", "d", "e"}
