"""Rows of the benchmark table, with the medians of two sides, their ratio and its budget."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import geometric_mean, median
from typing import NamedTuple

HEADER = (
    f"{'':<34} {'linkforge':^21} {'the other':^21} {'':<14} {'linkforge / the other':^33}\n"
    f"{'':<34} {'wall':>10} {'processor':>10} {'wall':>10} {'processor':>10} {'which is':<14}"
    f" {'wall':>6} {'(least-most)':>15} {'processor':>10}  budgets"
)


class Side(NamedTuple):
    """The measurements of one side, one a round."""

    values: list[float]
    """Wall time [s], or peak memory [MB]."""
    processor: list[float]
    """User and system time of the process [s]; empty for memory."""


class Budget(NamedTuple):
    """The ratio to reach, and a more ambitious one."""

    target: float
    moonshot: float


class Row(NamedTuple):
    """A line of the table; a budget applies to the ratios of wall and processor time, or of memory."""

    what: str
    other_is: str
    ours: Side
    other: Side
    budget: Budget | None = None
    unit: str = "ms"

    @property
    def ratio(self) -> float:
        return median(self.ours.values) / median(self.other.values)

    @property
    def processor_ratio(self) -> float | None:
        """The ratio of processor time; None for memory."""
        if not self.ours.processor:
            return None
        return median(self.ours.processor) / median(self.other.processor)

    @property
    def spread(self) -> tuple[float, float]:
        """The least and greatest ratio of single rounds, which shows how noisy the machine was."""
        ratios = [ours / other for ours, other in zip(self.ours.values, self.other.values, strict=True)]
        return min(ratios), max(ratios)


def average_rows(rows: Sequence[Row], what: str, budget: Budget) -> Row:
    """Return the geometric mean of rows, round by round."""
    ours, other = (
        Side(
            *(
                [geometric_mean(values) for values in zip(*(side[part] for side in sides), strict=True)]
                for part in range(2)
            )
        )
        for sides in ([row.ours for row in rows], [row.other for row in rows])
    )
    return Row(what, rows[0].other_is, ours, other, budget)


def format_row(row: Row) -> str:
    """Return a row as a line of text."""
    cells = [
        cell for side in (row.ours, row.other) for cell in (format_quantity(side.values, row.unit), format_time(side))
    ]
    sides = " ".join(f"{cell:>10}" for cell in cells)
    spread = "({}-{})".format(*map(format_ratio, row.spread))
    processor = "" if row.processor_ratio is None else format_ratio(row.processor_ratio)
    ratios = f"{format_ratio(row.ratio):>6} {spread:>15} {processor:>10}"
    return f"{row.what:<34} {sides} {row.other_is:<14} {ratios}  {format_verdict(row)}".rstrip()


def format_ratio(ratio: float) -> str:
    return f"{ratio:.2f}" if ratio >= 1 else f"{ratio:.3f}"


def format_quantity(values: Sequence[float], unit: str) -> str:
    """Return the median of times [s], in milliseconds, or of memory [MB]."""
    value = median(values) * (1000 if unit == "ms" else 1)
    return f"{value:.{0 if value >= 100 else 1}f} {unit}"


def format_time(side: Side) -> str:
    return format_quantity(side.processor, "ms") if side.processor else ""


def format_verdict(row: Row) -> str:
    """Return which budgets a row reaches."""
    worst = max(row.ratio, row.processor_ratio or 0)
    return ", ".join(f"{bound:g} {'reached' if worst <= bound else 'missed'}" for bound in row.budget or ())


def make_record(row: Row) -> dict[str, object]:
    """Return a row with its raw figures, for JSON."""
    return {
        "what": row.what,
        "other": row.other_is,
        "unit": "s" if row.unit == "ms" else row.unit,
        "ours": row.ours._asdict(),
        "theirs": row.other._asdict(),
        "ratio": row.ratio,
        "processor_ratio": row.processor_ratio,
        "spread": row.spread,
        "budget": row.budget and row.budget._asdict(),
    }
