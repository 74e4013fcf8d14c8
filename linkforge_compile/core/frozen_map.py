"""A mapping that nobody changes, so that the frozen parts which hold one hash and pickle."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TypeAlias, TypeVar

K = TypeVar("K")
V_co = TypeVar("V_co", covariant=True)

FreePart: TypeAlias = "str | Mapping[str, FreePart] | Sequence[FreePart]"
"""What a plugin reads from an element: its text; or its children by tag, where a key `_x` is its attribute `x` and
`_text` its text; or, for a tag that repeats, one of these for each element."""


class FrozenMap(Mapping[K, V_co]):
    """An immutable mapping in insertion order; equal to any mapping of the same items, whatever their order."""

    __slots__ = ("_items",)

    _items: dict[K, V_co]

    def __init__(self, items: Mapping[K, V_co] | Iterable[tuple[K, V_co]] = ()) -> None:
        object.__setattr__(self, "_items", dict(items))

    def __getitem__(self, key: K) -> V_co:
        return self._items[key]

    def __iter__(self) -> Iterator[K]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __hash__(self) -> int:
        return hash(frozenset(self._items.items()))

    def __eq__(self, other: object) -> bool:
        if isinstance(other, FrozenMap):
            return self._items == other._items
        return self._items == dict(other) if isinstance(other, Mapping) else NotImplemented

    def __or__(self, other: Mapping[K, V_co]) -> FrozenMap[K, V_co]:
        return FrozenMap({**self._items, **other})

    def __ror__(self, other: Mapping[K, V_co]) -> FrozenMap[K, V_co]:
        return FrozenMap({**other, **self._items})

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a FrozenMap cannot be changed: {name}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a FrozenMap cannot be changed: {name}")

    def __reduce__(self) -> tuple[type[FrozenMap[K, V_co]], tuple[dict[K, V_co]]]:
        return FrozenMap, (self._items,)

    def __repr__(self) -> str:
        return repr(self._items)

    def copy(self) -> dict[K, V_co]:
        """Return the items as a dict of the caller's own."""
        return dict(self._items)


def frozen(value: object) -> object:
    """Return a value that nobody changes: FrozenMaps for mappings and tuples for lists, all the way down."""
    if isinstance(value, Mapping):
        return FrozenMap({name: frozen(item) for name, item in value.items()})
    return tuple(map(frozen, value)) if isinstance(value, list | tuple) else value
