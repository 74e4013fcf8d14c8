"""A mapping that cannot be changed, so that the frozen parts which hold one can be hashed and pickled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NoReturn, TypeAlias, TypeVar

K = TypeVar("K")
V = TypeVar("V")

FreePart: TypeAlias = "str | Mapping[str, FreePart] | Sequence[FreePart]"
"""What a plugin reads from an element: its text; or its children by tag, where a key `_x` is its attribute `x` and
`_text` its text; or, for a tag that repeats, one of these for each element."""


class FrozenMap(dict[K, V]):
    """A dict that cannot be changed, in insertion order; equal to any mapping of the same items."""

    __slots__ = ()

    def __hash__(self) -> int:  # type: ignore[override]  # dict sets it to None
        return hash(frozenset(self.items()))

    def __or__(self, other: Mapping[K, V]) -> FrozenMap[K, V]:  # type: ignore[override]  # dict accepts only dicts
        return FrozenMap({**self, **other})

    def __ror__(self, other: Mapping[K, V]) -> FrozenMap[K, V]:  # type: ignore[override]  # as above
        return FrozenMap({**other, **self})

    def __reduce__(self) -> tuple[type[FrozenMap[K, V]], tuple[dict[K, V]]]:
        return FrozenMap, (dict(self),)

    def _refuse(self, *given: object, **named: object) -> NoReturn:
        raise TypeError("a FrozenMap cannot be changed")

    if not TYPE_CHECKING:  # mypy refuses a dict without these
        __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse


def frozen(value: object) -> object:
    """Return a value that cannot be changed: FrozenMaps for mappings and tuples for lists, all the way down."""
    if isinstance(value, Mapping):
        return FrozenMap({name: frozen(item) for name, item in value.items()})
    return tuple(map(frozen, value)) if isinstance(value, list | tuple) else value
