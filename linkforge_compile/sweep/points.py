"""The points of a sweep, each made from its index alone, so that any range of them can be made again."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Protocol

from linkforge_compile.sweep.axes import VARIANT, Axis, Interval
from linkforge_compile.units import number_text


@dataclass(frozen=True)
class Point:
    """The values of one robot as texts by parameter, and its variant, None for none."""

    index: int
    values: Mapping[str, str]
    variant: str | None = None

    @property
    def words(self) -> list[str]:
        """The options of `linkforge compile` that make this robot."""
        words = [f"-p {name}={_quoted(text)}" for name, text in self.values.items()]
        return [*words, *([f"--variant {self.variant}"] if self.variant else [])]


class Points(Protocol):
    """A sequence of points."""

    def __len__(self) -> int: ...

    def __getitem__(self, index: int) -> Point: ...


class Grid:
    """Every combination of the rows of some axes; the last axis varies fastest."""

    def __init__(self, axes: Sequence[Axis]) -> None:
        self._axes = tuple(axes)

    def __len__(self) -> int:
        return math.prod(len(axis.rows) for axis in self._axes)

    def __getitem__(self, index: int) -> Point:
        values: dict[str, str] = {}
        rest = index
        for axis in reversed(self._axes):
            rest, at = divmod(rest, len(axis.rows))
            values.update(zip(axis.names, axis.rows[at], strict=True))
        if rest:
            raise IndexError(index)
        return _point(index, {name: values[name] for axis in self._axes for name in axis.names})


class Samples:
    """Random points: a row of each axis, and a number of each interval.

    The number of a parameter depends on the seed, its name and the index, so that another parameter, or more samples,
    change none of those drawn before.
    """

    def __init__(self, axes: Sequence[Axis], intervals: Sequence[Interval], count: int, seed: int) -> None:
        self._axes, self._intervals = tuple(axes), tuple(intervals)
        self._count, self._seed = count, seed

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, index: int) -> Point:
        if not 0 <= index < self._count:
            raise IndexError(index)
        values: dict[str, str] = {}
        for axis in self._axes:
            row = self._random(axis.names[0], index).choice(axis.rows)
            values.update(zip(axis.names, row, strict=True))
        for one in self._intervals:
            values[one.name] = _draw(one, self._random(one.name, index))
        return _point(index, values)

    def _random(self, name: str, index: int) -> Random:
        return Random(f"{self._seed} {index} {name}")


def _draw(interval: Interval, random: Random) -> str:
    if interval.is_whole:
        return str(random.randint(math.ceil(interval.low), math.floor(interval.high)))
    return f"{number_text(random.uniform(interval.low, interval.high))} {interval.unit}".strip()


def _point(index: int, values: Mapping[str, str]) -> Point:
    """Return a point; an empty text is an empty cell of a table, which leaves the default."""
    filled = {name: text for name, text in values.items() if text}
    return Point(index, filled, filled.pop(VARIANT, None))


def _quoted(text: str) -> str:
    import shlex

    return shlex.quote(text)
