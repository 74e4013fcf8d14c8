"""Read what a sweep varies: `NAME=START:STOP:COUNT`, `NAME=2,3,5`, and `NAME=LO:HI` of random samples."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple, Protocol

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import SET_TWICE, UNKNOWN_PARAMETER
from linkforge_compile.expand.parameters import PARAMETER_TYPES, Parameter, number_of
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.sweep.cells import Cell, cells_of, value_text
from linkforge_compile.sweep.declared import Declared, untyped, value_of
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.sweep.wording import Wording
from linkforge_compile.units import Dimension, number_text, parse_quantity

VARIANT = "--variant"
"""The name of the axis of variants, which no parameter can have."""

_END = re.compile(r"\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(.*?)\s*")


class Rows(Protocol):
    """A sequence of rows of texts."""

    def __len__(self) -> int: ...

    def __getitem__(self, at: int, /) -> tuple[str, ...]: ...


class Axis(NamedTuple):
    """Values that vary together: a row of texts, one for each of the names."""

    names: tuple[str, ...]
    rows: Rows


@dataclass(frozen=True)
class Steps:
    """Rows of one number each, at equal distances with both ends included; each is made when it is used."""

    first: Fraction
    last: Fraction
    count: int
    unit: str = ""
    is_whole: bool = False

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, at: int) -> tuple[str]:
        # Of exact fractions, so that 0.1:0.5:5 has 0.3 in it and not the sum of rounded steps.
        number = self.first + (self.last - self.first) * Fraction(at, self.count - 1)
        return (str(int(number)) if self.is_whole else f"{number_text(float(number))} {self.unit}".strip(),)


class Interval(NamedTuple):
    """What a sample draws from uniformly, both ends included, in SI units; whole numbers only for an integer."""

    name: str
    low: float
    high: float
    unit: str = ""
    is_whole: bool = False


class Varied(NamedTuple):
    """What the options vary: axes and intervals in their order, and each parameter with the type of its column."""

    axes: tuple[Axis, ...]
    intervals: tuple[Interval, ...]
    parameters: Mapping[str, Parameter]


class _End(NamedTuple):
    number: Fraction
    unit: str


class AxisReader:
    """Reads the options of one sweep; faults with a place go to `sink`, others raise SweepError."""

    def __init__(
        self, declared: Declared, sink: Diagnostics, words: Wording, *, samples: bool, max_points: int
    ) -> None:
        self._declared, self._sink, self._words = declared, sink, words
        self._samples, self._max_points = samples, max_points
        self._spans: dict[str, Span] = {}
        self.axes: list[Axis] = []
        self.intervals: list[Interval] = []
        self.parameters: dict[str, Parameter] = {}

    def read(self, text: str) -> None:
        """Read one `--set`."""
        name, equals, values = text.partition("=")
        source, before = self._words.source("set")
        file, at = SourceFile(source, f"{before}{text}"), len(before) + 1
        key = Span(file, 1, at, 1, at + len(name))
        where = Span(file, 1, at + len(name) + 1, 1, at + len(text))
        name = name.strip()
        if not name or (not equals and not self._samples) or (equals and not values.strip()):
            raise SweepError(f"{self._words.forms}; found '{text}'")
        parameter = self._declare(name, key)
        if parameter is None and name not in self._declared.parameters:
            return
        if not equals:
            self.intervals.append(self._own_interval(name, parameter))
            return
        if _is_range(values, parameter):
            self._read_range(name, parameter, values, where)
        else:
            self._add_values(name, parameter, self._cells(name, parameter, values, where), where)

    def _cells(self, name: str, parameter: Parameter | None, values: str, where: Span) -> list[Cell]:
        """Return a list of values: by the rules of CSV, so that a value in quotes may have commas."""
        if parameter and parameter.type.is_structured and values.lstrip().startswith(("[", "{")):
            raise SweepError(
                f"'{name}' is a {parameter.type.name}; write each in double quotes, as in "
                + ('"[…]","[…]", or a list of lists' if self._words.is_python else f'--set \'{name}="[…]","[…]"\'')
            )
        try:
            row = next(csv.reader([values], skipinitialspace=True, strict=True))
        except csv.Error as error:
            raise SweepError(f"the values of '{name}' cannot be read: {error}") from error
        return cells_of(row, values, where.file, 1, where.column)

    def _declare(self, name: str, key: Span) -> Parameter | None:
        """Return the declaration of a parameter; None for an untyped one, and after a reported error."""
        if name not in self._declared.parameters:
            self._sink.report(UNKNOWN_PARAMETER.at(key, name=name, near=self._declared.parameters, notes=()))
            return None
        if name in self._spans:
            self._sink.report(SET_TWICE.at(key, name=name, notes=[Note("set here first", self._spans[name])]))
        self._spans[name] = key
        return self._declared.parameters[name]

    def _add_values(self, name: str, parameter: Parameter | None, cells: list[Cell], where: Span) -> None:
        words = [cell.text for cell in cells]
        if "" in words:
            raise SweepError(f"'{name}' has an empty value among '{','.join(words)}'")
        parameter = parameter or untyped(name, words, where)
        for cell in cells:
            value_of(cell.text, cell.span, parameter, self._sink)
        self.parameters[name] = parameter
        self.axes.append(Axis((name,), [(word,) for word in words]))

    def _read_range(self, name: str, parameter: Parameter | None, text: str, where: Span) -> None:
        start, stop, *more = text.split(":")
        if len(more) > 1 or (not more and not self._samples):
            way = (
                ""
                if more
                else f"; add a COUNT, or {self._words.option('sample', 'N')} for random values between the two"
            )
            raise SweepError(f"a range is START:STOP:COUNT, found '{name}={text}'{way}")
        parameter = parameter or self._type_of_range(name, start)
        self.parameters[name] = parameter
        ends = [self._end(name, parameter, end, where) for end in (start, stop)]
        low, high = (end for end in ends if end) if None not in ends else (None, None)
        if low is None or high is None:
            return
        if more:
            self._add_linear(name, parameter, (low, high), more[0], where)
            return
        least, most = (_si(end, parameter) for end in (low, high))
        if least > most:
            raise SweepError(f"the range '{name}={text}' has its ends exchanged; write {stop}:{start}")
        self.intervals.append(_interval(parameter, float(least), float(most)))

    def _type_of_range(self, name: str, start: str) -> Parameter:
        quantity = parse_quantity(start)
        return Parameter(name, PARAMETER_TYPES[quantity.dimension if quantity else "number"])

    def _end(self, name: str, parameter: Parameter, text: str, where: Span) -> _End | None:
        """Return an end of a range, checked against the parameter; None after a reported error."""
        match = _END.fullmatch(text)
        if match is None or parameter.type.name == "boolean":
            raise SweepError(f"an end of a range of '{name}' is {parameter.type.words}, found '{text.strip()}'")
        at = where.column + (where.file.text[where.column - 1 :].find(text))
        if value_of(text.strip(), Span(where.file, 1, at, 1, at + len(text)), parameter, self._sink) is None:
            return None
        return _End(Fraction(repr(float(match[1]))), match[2])

    def _add_linear(
        self, name: str, parameter: Parameter, ends: tuple[_End, _End], count_text: str, where: Span
    ) -> None:
        count = int(count_text) if count_text.strip().isdecimal() and len(count_text) < 20 else 0
        if count < 2:
            raise SweepError(f"the COUNT of '{name}' is a whole number from 2, found '{count_text}'")
        if count > self._max_points:
            raise SweepError(too_many(count, self._max_points, self._words))
        (first, unit), (last, other) = ends
        if unit != other:  # of two units, or of a unit and none: in SI units
            first, last = (_si(end, parameter) for end in ends)
            unit = _unit_of(parameter)
        step = (last - first) / (count - 1)
        is_whole = parameter.type.name == "integer"
        if is_whole and step.denominator != 1:
            raise SweepError(
                f"'{name}' takes whole numbers, and this range gives {float(first + step):g}; choose a COUNT whose "
                f"steps are whole, such as {first}:{last}:{abs(int(last - first)) + 1}"
            )
        self.axes.append(Axis((name,), Steps(first, last, count, unit, is_whole)))

    def _own_interval(self, name: str, parameter: Parameter | None) -> Interval:
        """Return what to draw a parameter from by its own limits; SweepError with the way out if it has none."""
        if parameter and parameter.minimum is not None and parameter.maximum is not None:
            self.parameters[name] = parameter
            return _interval(parameter, number_of(parameter.minimum), number_of(parameter.maximum))
        way = self._words.varied(name, "LO:HI")
        raise SweepError(f"'{name}' has no minimum and maximum to sample between; write {way}")

    def add_own_limits(self, fixed: frozenset[str]) -> None:
        """Sample what is bounded, an enum or a boolean, and neither fixed nor varied by an option."""
        for name, parameter in self._declared.parameters.items():
            if parameter is None or name in self._spans or name in fixed:
                continue
            if parameter.choices is not None:
                words = [value_text(choice) for choice in parameter.choices]
            elif parameter.type.name == "boolean":
                words = ["false", "true"]
            elif parameter.minimum is not None and parameter.maximum is not None:
                self.intervals.append(self._own_interval(name, parameter))
                continue
            else:
                continue
            self.parameters[name] = parameter
            self.axes.append(Axis((name,), [(word,) for word in words]))


def too_many(count: int, most: int, words: Wording) -> str:
    way = words.option("max-points", count)
    return f"this sweep has {count:,} points, more than {most:,}; vary less, or allow it with {way}"


def _is_range(values: str, parameter: Parameter | None) -> bool:
    """Whether values are START:STOP:COUNT: a value of an argument of a xacro may be `package://…`."""
    if parameter is None:
        return ":" in values and _END.fullmatch(values.partition(":")[0]) is not None
    return ":" in values and not (parameter.type.is_text or parameter.type.is_structured)


def _si(end: _End, parameter: Parameter) -> Fraction:
    quantity = parse_quantity(f"{float(end.number)!r} {end.unit}") if end.unit else None
    return Fraction(number_text(quantity.value)) if quantity else end.number


def _unit_of(parameter: Parameter) -> str:
    """Return the SI unit of a parameter, "" for one without a dimension."""
    return Dimension(parameter.type.name).si_unit if parameter.type.name in list(Dimension) else ""


def _interval(parameter: Parameter, low: float, high: float) -> Interval:
    is_whole = parameter.type.name == "integer"
    if low > high or (is_whole and math.ceil(low) > math.floor(high)):
        raise SweepError(f"'{parameter.name}' has no {parameter.type.name} to draw between {low:g} and {high:g}")
    return Interval(parameter.name, low, high, _unit_of(parameter), is_whole)
