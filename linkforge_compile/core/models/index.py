"""A sequence whose items can be asked for by name, and by whatever else they are known for."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from enum import Enum, auto
from itertools import islice
from operator import attrgetter
from typing import TYPE_CHECKING, Any, ClassVar, Final, Generic, NamedTuple, TypeAlias, TypeVar, overload

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode

T = TypeVar("T")

Key: TypeAlias = Callable[[T], Hashable]
"""What an item is known for: its name, or the link that a joint hangs on."""

NAME: Final = attrgetter("name")


def itself(item: object) -> object:
    """Return the item: the key of what has no other."""
    return item


class Repeats(Enum):
    """What becomes of an item whose key is taken."""

    REFUSED = auto()  # DUPLICATE_NAME is raised
    SKIPPED = auto()  # the first one says it already
    KEPT = auto()


class Filing(NamedTuple, Generic[T]):
    """How an index files its items; `kind` names one of them in errors ("link")."""

    kind: str
    key: Callable[[T], Hashable] = NAME
    repeats: Repeats = Repeats.REFUSED

    @property
    def _target(self) -> str:
        return self.kind.replace("_", " ").title().replace(" ", "")

    def keys_of(self, items: Iterable[T]) -> list[Hashable]:
        if self.key is NAME:
            named: Iterable[Any] = items  # Any: whoever files by name has items with one
            return [item.name for item in named]  # a quarter of what a call for each takes
        return list(map(self.key, items))

    def duplicate(self, key: Hashable) -> RobotValidationError:
        shown = "/".join(map(str, key)) if isinstance(key, tuple) else str(key)
        message = f"Duplicate {self.kind} name: '{shown}'"
        return RobotValidationError(ValidationErrorCode.DUPLICATE_NAME, message, self._target, shown, field=("name",))

    def missing(self, name: str) -> RobotValidationError:
        message = f"{self.kind[0].upper()}{self.kind[1:]} '{name}' not found"
        return RobotValidationError(ValidationErrorCode.NOT_FOUND, message, self._target, name)


class Renamable:  # noqa: PLW1641 its `__eq__` is there for mypy alone
    """An object that may be renamed while an index holds it: counts renamings, so that indices look again."""

    __slots__ = ("__weakref__",)
    renamings: ClassVar[int] = 0

    def __setattr__(self, attribute: str, value: object) -> None:
        if attribute == "name" and hasattr(self, "name"):
            Renamable.renamings += 1
        super().__setattr__(attribute, value)

    if TYPE_CHECKING:

        def __eq__(self, other: object) -> bool: ...  # for the same reason as that of Part


class _Shelf(Generic[T]):
    """Items that several indices share, each seeing the first so many; it only grows.

    `first` says where the first item of each name stands, `places` where all stand that a key of `where` gives one
    value, in ascending order. Both are made when they are first asked for.
    """

    __slots__ = ("_first", "_name", "_places", "_renamings", "items")

    def __init__(self, items: Iterable[T], name: Callable[[T], Hashable]) -> None:
        self.items = list(items)
        self._name = name
        self._first: dict[Hashable, int] | None = None
        self._places: dict[Callable[[T], Hashable], dict[Hashable, list[int]]] = {}
        self._renamings = Renamable.renamings

    def first(self) -> dict[Hashable, int]:
        self._forget_old_names()
        if self._first is None:
            names = map(self._name, reversed(self.items))
            self._first = dict(zip(names, range(len(self.items) - 1, -1, -1), strict=True))
        return self._first

    def places(self, key: Callable[[T], Hashable]) -> dict[Hashable, list[int]]:
        self._forget_old_names()
        if key not in self._places:
            self._places[key] = {}
            self._file(key, self.items, 0)
        return self._places[key]

    def extend(self, items: Sequence[T], names: Iterable[Hashable], *, new: bool) -> None:
        """Put items at the end, with their names; `new` says that no other item has one of these."""
        start = len(self.items)
        self.items.extend(items)
        if (first := self._first) is not None:
            for place, name in enumerate(names, start):
                if new or name not in first:
                    first[name] = place
        for key in self._places:
            self._file(key, items, start)

    def _file(self, key: Callable[[T], Hashable], items: Sequence[T], start: int) -> None:
        places = self._places[key]
        for place, item in enumerate(items, start):
            places.setdefault(key(item), []).append(place)

    def _forget_old_names(self) -> None:
        if self._renamings != Renamable.renamings:
            self._first = None
            self._places.clear()
            self._renamings = Renamable.renamings


class Index(Sequence[T]):
    """A sequence that compares, adds, hashes and prints as the tuple of its items, and answers to names as well.

    It never changes; `extended` gives a longer one at the price of what is added, since both share their items.
    Where a name occurs twice, the first one answers.
    """

    __slots__ = ("_filing", "_length", "_shelf")

    def __init__(self, items: Iterable[T] = (), filing: Filing[T] | None = None) -> None:
        filing = filing or Filing("part")
        self._stand(_Shelf(items, filing.key), filing)

    def _stand(self, shelf: _Shelf[T], filing: Filing[T]) -> None:
        self._shelf, self._filing, self._length = shelf, filing, len(shelf.items)

    @property
    def names(self) -> tuple[str, ...]:
        """What the items are filed under, in their order: their names, or what serves as such."""
        return tuple(map(str, map(self._filing.key, self)))

    def get(self, name: Hashable) -> T | None:
        """Return the item of that name, None if there is none."""
        place = self._shelf.first().get(name, self._length)
        return self._shelf.items[place] if place < self._length else None

    def where(self, key: Callable[[T], Hashable], value: Hashable) -> Iterator[T]:
        """Yield, in order, the items for which `key` gives the value; asking again for the same key is quick."""
        for place in self._shelf.places(key).get(value, ()):
            if place >= self._length:
                return
            yield self._shelf.items[place]

    def extended(self, items: Iterable[T]) -> Index[T]:
        """Return this index with more items at its end, each filed as its filing says about repeats.

        Raises:
            RobotValidationError: DUPLICATE_NAME where repeats are refused; nothing is changed by then.

        """
        items = tuple(items)
        if not items:
            return self
        added, names = self._without_repeats(items, self._filing.keys_of(items))
        if not added:
            return self
        # Somebody else may have gone on from here already, or tried to: then the two part company.
        shelf = self._shelf if len(self._shelf.items) == self._length else _Shelf(self, self._filing.key)
        shelf.extend(added, names, new=self._filing.repeats is not Repeats.KEPT)
        longer: Index[T] = Index.__new__(Index)
        longer._stand(shelf, self._filing)
        return longer

    def _without_repeats(self, items: Sequence[T], keys: list[Hashable]) -> tuple[Sequence[T], Iterable[Hashable]]:
        """Return those of the items that are to be added, and the name of each."""
        if self._filing.repeats is Repeats.KEPT:
            return items, keys
        taken = self._shelf.first()
        if taken.keys().isdisjoint(keys) and len(set(keys)) == len(keys):
            return items, keys
        added: dict[Hashable, T] = {}
        for key, item in zip(keys, items, strict=True):
            if key not in added and taken.get(key, self._length) >= self._length:
                added[key] = item
            elif self._filing.repeats is Repeats.REFUSED:
                raise self._filing.duplicate(key)
        return list(added.values()), added

    def listed(self) -> list[T]:
        """Return the items as a list of the caller's: what `list` of this is, in a fifth of the time."""
        return self._shelf.items[: self._length]

    def grown_from(self, other: Index[T]) -> bool:
        """Tell whether this is `other`, possibly with more items, all filed by its rules."""
        return self._shelf is other._shelf and self._length >= other._length

    def replaced(self, item: T) -> Index[T]:
        """Return this index with the item in the place of the one of its name."""
        name = self._filing.key(item)
        return Index((item if self._filing.key(other) == name else other for other in self), self._filing)

    def __len__(self) -> int:
        return self._length

    def __iter__(self) -> Iterator[T]:
        return islice(self._shelf.items, self._length)

    @overload
    def __getitem__(self, place: int | str) -> T: ...
    @overload
    def __getitem__(self, place: slice) -> tuple[T, ...]: ...
    def __getitem__(self, place: int | str | slice) -> T | tuple[T, ...]:
        """Return the item of a name or at a position, or the tuple of a slice.

        Raises:
            RobotValidationError: NOT_FOUND for a name that no item has.
            IndexError: The position is beyond the end.

        """
        if isinstance(place, str):
            item = self.get(place)
            if item is None:
                raise self._filing.missing(place)
            return item
        if isinstance(place, slice):
            return tuple(self)[place]
        return self._shelf.items[range(self._length)[place]]

    def __contains__(self, sought: object) -> bool:
        """Tell whether a name, or an equal item, is here."""
        if isinstance(sought, str):
            return self.get(sought) is not None
        return any(item is sought or item == sought for item in self)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Index):
            other = tuple(other)
        return tuple(self) == other if isinstance(other, tuple) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __add__(self, other: Sequence[T]) -> tuple[T, ...]:
        return (*self, *other) if isinstance(other, tuple | Index) else NotImplemented

    def __radd__(self, other: Sequence[T]) -> tuple[T, ...]:
        return (*other, *self) if isinstance(other, tuple | Index) else NotImplemented

    def __repr__(self) -> str:
        return repr(tuple(self))

    def __reduce__(self) -> tuple[type[Index[T]], tuple[tuple[T, ...], Filing[T]]]:
        return Index, (tuple(self), self._filing)


class IndexField(Generic[T]):
    """A field that gives its items as an Index, and takes any iterable; assigning it rebuilds the index.

    With `distinct`, assigning items of one name raises DUPLICATE_NAME and leaves the field as it was.
    """

    def __init__(self, filing: Filing[T], *, distinct: bool = False) -> None:
        self.filing = filing
        self.distinct = distinct

    def __set_name__(self, owner: type, name: str) -> None:
        self.slot = f"_{name}"

    @overload
    def __get__(self, holder: None, owner: type) -> tuple[()]: ...
    @overload
    def __get__(self, holder: object, owner: type) -> Index[T]: ...
    def __get__(self, holder: object | None, owner: type) -> Index[T] | tuple[()]:
        if holder is None:
            return ()  # what a dataclass takes for the field's default
        index: Index[T] = getattr(holder, self.slot)
        return index

    def __set__(self, holder: object, items: Iterable[T]) -> None:
        current: Index[T] | None = getattr(holder, self.slot, None)
        if not (isinstance(items, Index) and current is not None and items.grown_from(current)):
            items = Index((), self.filing).extended(items) if self.distinct else Index(items, self.filing)
        setattr(holder, self.slot, items)
