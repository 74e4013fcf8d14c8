"""Collections of parts of one kind: lists that grow, and tuples that find a part by its name."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from enum import Enum, auto
from operator import attrgetter
from typing import Any, Final, Generic, NamedTuple, SupportsIndex, TypeVar, overload

from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.part import dump_like

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
        return RobotValidationError.not_found(message, self._target, name)


PART: Final = KeySpec("part")


class PartList(Generic[T]):
    """Parts of one kind, to which others are appended, and the position of the first part of each key."""

    def __init__(self, spec: KeySpec, parts: Iterable[T] = ()) -> None:
        self.spec = spec
        self._parts = list(parts)
        self._positions: dict[Hashable, int] | None = None
        self._renamings = Link.renamings
        self._table: NamedTable[T] | None = None

    def __len__(self) -> int:
        return len(self._parts)

    def position(self, key: Hashable) -> int:
        """Return the position of the first part of a key; the number of parts if there is none."""
        if self._positions is None or self._renamings != Link.renamings:
            self._positions, self._renamings = {}, Link.renamings
            self._index(self._parts, 0)
        return self._positions.get(key, len(self._parts))

    def _index(self, parts: Iterable[T], start: int) -> None:
        if self._positions is not None:
            for position, part in enumerate(parts, start):
                self._positions.setdefault(self.spec.key(part), position)

    def select_new(self, parts: Iterable[T]) -> Sequence[T]:
        """Return those of the parts that are to be added.

        Raises:
            RobotValidationError: DUPLICATE_NAME for a name that is taken, where the spec refuses that.

        """
        if self.spec.on_duplicate is OnDuplicate.KEEP:
            return tuple(parts)
        new: dict[Hashable, T] = {}
        for part in parts:
            key = self.spec.key(part)
            if key not in new and self.position(key) == len(self):
                new[key] = part
            elif self.spec.on_duplicate is OnDuplicate.REFUSE:
                raise self.spec.duplicate_error(key)
        return tuple(new.values())

    def extend(self, parts: Sequence[T]) -> None:
        """Append parts that `select_new` returned; tables that were read before stay as they are."""
        if parts:
            self._index(parts, len(self))
            self._parts += parts
            self._table = None

    def get(self, key: Hashable) -> T | None:
        """Return the first part of a key, None if there is none."""
        position = self.position(key)
        return self._parts[position] if position < len(self) else None

    @property
    def table(self) -> NamedTable[T]:
        """The parts as a tuple, the same one until parts are added."""
        if self._table is None:
            self._table = NamedTable(self._parts, self.spec, self)
        return self._table

    def __reduce__(self) -> tuple[type[PartList[T]], tuple[KeySpec, list[T]]]:
        return PartList, (self.spec, self._parts)


class NamedTable(tuple[T, ...]):
    """A tuple of parts of one kind that answers to names as well.

    Where a name occurs twice, the first part of that name is found. A link that is renamed in place is found by its
    new name.
    """

    _list: PartList[T]  # of these parts, and of those that were added later

    def __new__(
        cls, parts: Iterable[T] = (), spec: KeySpec = PART, parts_list: PartList[T] | None = None
    ) -> NamedTable[T]:
        table = super().__new__(cls, parts)  # `dataclasses.asdict` gives the parts alone
        table._list = PartList(spec, table) if parts_list is None else parts_list
        return table

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the parts in their order, or what serves as such."""
        return tuple(map(str, map(self._list.spec.key, self)))

    def get(self, name: Hashable) -> T | None:
        """Return the part of that name, None if there is none."""
        position = self._list.position(name)
        return super().__getitem__(position) if position < len(self) else None

    def require(self, name: str) -> T:
        """Return the part of that name; raise NOT_FOUND if there is none."""
        part = self.get(name)
        if part is None:
            raise self._list.spec.missing_error(name)
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

    def extended(self, parts: Iterable[T]) -> NamedTable[T]:
        """Return a table of these parts and then the others, without those that the spec skips.

        Raises:
            RobotValidationError: DUPLICATE_NAME for a name that is taken, where the spec refuses that.

        """
        longer = self._list if len(self._list) == len(self) else PartList(self._list.spec, self)
        longer.extend(longer.select_new(parts))
        return longer.table

    def __reduce__(self) -> tuple[type[NamedTable[T]], tuple[tuple[T, ...], KeySpec]]:
        return NamedTable, (tuple(self), self._list.spec)


dump_like(NamedTable, list)

Index = NamedTable
"""The name under which `linkforge_compile.core` exports the class."""


class TableField(Generic[T]):
    """A field that accepts any iterable of parts, holds them as a PartList, and is read as a NamedTable.

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
        parts: PartList[T] = vars(robot)[self._name]
        return parts.table

    def __set__(self, robot: object, parts: Iterable[T]) -> None:
        new = PartList(self._spec, () if self._distinct else parts)
        if self._distinct:
            new.extend(new.select_new(parts))
        vars(robot)[self._name] = new
