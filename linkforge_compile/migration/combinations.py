"""The values of the arguments for which a migration is proved."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, product
from math import prod

from linkforge_compile.migration.symbols import BOOLEAN, UNSET, Symbol

MOST_COMBINATIONS = 32
"""More are not all compared: then the given values, each other value alone, and each two of them together."""

OTHER_WORD = "none_of_these"
"""A word that no condition compares with, for which all are false; a xacro that refuses it knows all its words."""

Arguments = Mapping[str, str]


def domain_of(symbol: Symbol, given: str | None, default: str | None) -> tuple[str, ...]:
    """Return the values of an argument to compare: of a boolean both, else those of conditions, and another one."""
    base = given if given is not None else default
    values: dict[str, None] = {} if base is None else {base: None}
    if symbol.constant is not UNSET:
        return () if given is None else (given,)
    if symbol.kind == BOOLEAN:
        values |= dict.fromkeys(("true", "false")) if base not in ("True", "False") else {"True": None, "False": None}
    elif symbol.choices:
        values |= dict.fromkeys(symbol.choices)
        values |= {} if symbol.is_closed else {OTHER_WORD: None}
    return tuple(values)


def combinations_of(domains: Mapping[str, tuple[str, ...]]) -> Sequence[Arguments]:
    """Return the combinations of values to compare, the given ones first."""
    varied = {name: values for name, values in domains.items() if values}
    if prod(len(values) for values in varied.values()) <= MOST_COMBINATIONS:
        return [dict(zip(varied, values, strict=True)) for values in product(*varied.values())]
    base = {name: values[0] for name, values in varied.items()}
    others = [(name, value) for name, values in varied.items() for value in values[1:]]
    pairs = [pair for pair in combinations(others, 2) if pair[0][0] != pair[1][0]]
    changes: Iterable[tuple[tuple[str, str], ...]] = [(), *((one,) for one in others), *pairs]
    return [{**base, **dict(change)} for change in changes][:MOST_COMBINATIONS]
