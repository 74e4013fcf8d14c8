"""What two values have in common that say the same: a key, so that many are sorted out without comparing each pair."""

from __future__ import annotations

from collections.abc import Collection, Hashable, Mapping, Sequence

from linkforge_compile.compare.said import is_part, said_fields, said_value
from linkforge_compile.core.models.interface import Interface

NO_FIELDS: Mapping[type, Collection[str]] = {}


def likeness(value: object, without: Mapping[type, Collection[str]] = NO_FIELDS) -> Hashable:
    """Return a key that is the same for values that say the same, the fields `without` left aside, by their class."""
    if isinstance(value, Mapping):
        return frozenset((name, likeness(held, without)) for name, held in value.items())
    if is_part(value):
        aside = without.get(type(value), ())
        said = (likeness(said_value(value, name), without) for name in said_fields(value) if name not in aside)
        return type(value).__name__, str(value) if isinstance(value, Interface) else "", *said
    if isinstance(value, Sequence) and not isinstance(value, str):
        return tuple(likeness(item, without) for item in value)
    if isinstance(value, bool):
        return "bool", value  # for True is 1 to Python
    return value if isinstance(value, str | int | float | None) else repr(value)
