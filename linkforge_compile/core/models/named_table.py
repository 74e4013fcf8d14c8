"""Collections of parts of one kind: tuples that find a part by its name, and how parts are added to them."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from enum import Enum, auto
from operator import attrgetter
from typing import Any, Final, Generic, NamedTuple, SupportsIndex, TypeVar, overload

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.link import Link

T = TypeVar("T")

NAME: Final = attrgetter("name")


def itself(item: object) -> object:
    """Return the item: the key of an item that has no other."""
    return item


class OnDuplicate(Enum):
    """What happens to an item whose key another item has."""

    REFUSE = auto()  # DUPLICATE_NAME is raised
    SKIP = auto()
    KEEP = auto()


class KeySpec(NamedTuple):
    """The key of items of a kind; `kind` names one of them in messages ("link")."""

    kind: str
    key: Callable[[Any], Any] = NAME  # Any: each kind has items of its own class, and a name or names as keys
    on_duplicate: OnDuplicate = OnDuplicate.REFUSE

    @property
    def _target(self) -> str:
        return self.kind.replace("_", " ").title().replace(" ", "")

    def duplicate_error(self, key: Hashable) -> RobotValidationError:
        """Return the error for an item whose key another item has."""
        shown = "/".join(map(str, key)) if isinstance(key, tuple) else str(key)
        message = f"Duplicate {self.kind} name: '{shown}'"
        return RobotValidationError(ValidationErrorCode.DUPLICATE_NAME, message, self._target, shown, field=("name",))

    def missing_error(self, name: str) -> RobotValidationError:
        """Return the error for a name that no item has."""
        message = f"{self.kind[0].upper()}{self.kind[1:]} '{name}' not found"
        return RobotValidationError(ValidationErrorCode.NOT_FOUND, message, self._target, name)


class _Positions:
    """Where the first item of each key is, among the items of the longest of the tables that share this."""

    def __init__(self, spec: KeySpec, items: Sequence[object]) -> None:
        self.renamings = Link.renamings
        self.count = len(items)
        self.first: dict[Hashable, int] = {}
        for position, item in enumerate(items):
            self.first.setdefault(spec.key(item), position)


class NamedTable(tuple[T, ...]):
    """A tuple of parts of one kind that answers to names as well.

    Where a name occurs twice, the first part of that name is found. A link that is renamed in place is found by its
    new name.
    """

    _spec: KeySpec
    _positions: _Positions | None

    def __new__(cls, spec: KeySpec, parts: Iterable[T] = ()) -> NamedTable[T]:
        table = super().__new__(cls, parts)
        table._spec = spec
        table._positions = None
        return table

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the parts in their order, or what serves as such."""
        return tuple(map(str, map(self._spec.key, self)))

    def _index(self) -> _Positions:
        if self._positions is None or self._positions.renamings != Link.renamings:
            self._positions = _Positions(self._spec, self)
        return self._positions

    def get(self, name: Hashable) -> T | None:
        """Return the part of that name, None if there is none."""
        position = self._index().first.get(name, len(self))
        return super().__getitem__(position) if position < len(self) else None

    def require(self, name: str) -> T:
        """Return the part of that name; raise NOT_FOUND if there is none."""
        part = self.get(name)
        if part is None:
            raise self._spec.missing_error(name)
        return part

    @overload
    def __getitem__(self, place: SupportsIndex | str) -> T: ...
    @overload
    def __getitem__(self, place: slice) -> tuple[T, ...]: ...
    def __getitem__(self, place: SupportsIndex | str | slice) -> T | tuple[T, ...]:
        """Return the part of a name or at a position, or the tuple of a slice.

        Raises:
            RobotValidationError: NOT_FOUND for a name that no part has.

        """
        return self.require(place) if isinstance(place, str) else super().__getitem__(place)

    def __contains__(self, sought: object) -> bool:
        """Tell whether a name, or an equal part, is here."""
        return self.get(sought) is not None if isinstance(sought, str) else super().__contains__(sought)

    def select_new(self, parts: Iterable[T]) -> Sequence[T]:
        """Return those of the parts that are to be added.

        Raises:
            RobotValidationError: DUPLICATE_NAME for a name that is taken, where the spec refuses that.

        """
        if self._spec.on_duplicate is OnDuplicate.KEEP:
            return tuple(parts)
        new: dict[Hashable, T] = {}
        for part in parts:
            key = self._spec.key(part)
            if key not in new and self.get(key) is None:
                new[key] = part
            elif self._spec.on_duplicate is OnDuplicate.REFUSE:
                raise self._spec.duplicate_error(key)
        return tuple(new.values())

    def extended(self, parts: Iterable[T]) -> NamedTable[T]:
        """Return a table of these parts and then the others, without those that the spec skips.

        The positions of the parts are shared with the new table, so that adding one by one computes each key once.

        Raises:
            RobotValidationError: DUPLICATE_NAME for a name that is taken, where the spec refuses that.

        """
        added = self.select_new(parts)
        if not added:
            return self
        table = NamedTable(self._spec, self + tuple(added))
        positions = self._positions
        if positions and positions.count == len(self) and positions.renamings == Link.renamings:
            for position, part in enumerate(added, len(self)):
                positions.first.setdefault(self._spec.key(part), position)
            positions.count = len(table)
            table._positions = positions
        return table

    def __reduce__(self) -> tuple[type[NamedTable[T]], tuple[KeySpec, tuple[T, ...]]]:
        return NamedTable, (self._spec, tuple(self))


Index = NamedTable
"""The name under which `linkforge_compile.core` exports the class."""


class TableField(Generic[T]):
    """A field that accepts any iterable of parts and holds them as a NamedTable.

    With `distinct`, assigning two parts of one name raises DUPLICATE_NAME and leaves the field as it was.
    """

    def __init__(self, spec: KeySpec, *, distinct: bool = False) -> None:
        self._spec = spec
        self._distinct = distinct

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, robot: None, owner: type) -> tuple[()]: ...
    @overload
    def __get__(self, robot: object, owner: type) -> NamedTable[T]: ...
    def __get__(self, robot: object | None, owner: type) -> NamedTable[T] | tuple[()]:
        if robot is None:
            return ()  # the field's default, to dataclasses
        table: NamedTable[T] = vars(robot)[self._name]
        return table

    def __set__(self, robot: object, parts: Iterable[T]) -> None:
        empty: NamedTable[T] = NamedTable(self._spec)
        vars(robot)[self._name] = empty.extended(parts) if self._distinct else NamedTable(self._spec, parts)
