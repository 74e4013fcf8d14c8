"""The parts of a robot by kind: the list that grows, and the tuple with look-up by name that its readers get."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from enum import Enum, auto
from operator import attrgetter
from typing import Any, Final, Generic, NamedTuple, SupportsIndex, TypeAlias, TypeVar, overload

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
    """How items of a kind are told apart; `kind` names one of them in messages ("link")."""

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


class PartList(Generic[T]):
    """A list of parts that only grows, so that the tables that were made of it stay right."""

    def __init__(self, spec: KeySpec, parts: Iterable[T] = ()) -> None:
        self.spec = spec
        self.items = list(parts)
        self._positions: dict[Hashable, int] | None = None
        self._renamings = Link.renamings

    def position(self, key: Hashable) -> int:
        """Return where the first part of that key is; the length of the list if there is none."""
        if self._positions is None or self._renamings != Link.renamings:
            self._renamings = Link.renamings
            keys = map(self.spec.key, reversed(self.items))
            self._positions = dict(zip(keys, range(len(self.items) - 1, -1, -1), strict=True))
        return self._positions.get(key, len(self.items))

    def get(self, key: Hashable) -> T | None:
        """Return the first part of that key, None if there is none."""
        position = self.position(key)
        return self.items[position] if position < len(self.items) else None

    def require(self, name: str) -> T:
        """Return the first part of that name; raise NOT_FOUND if there is none."""
        part = self.get(name)
        if part is None:
            raise self.spec.missing_error(name)
        return part

    def select_new(self, parts: Iterable[T]) -> Sequence[T]:
        """Return those of the parts that are to be added.

        Raises:
            RobotValidationError: DUPLICATE_NAME for a key that is taken, where the spec refuses that.

        """
        if self.spec.on_duplicate is OnDuplicate.KEEP:
            return tuple(parts)
        new: dict[Hashable, T] = {}
        for part in parts:
            key = self.spec.key(part)
            if key not in new and self.position(key) == len(self.items):
                new[key] = part
            elif self.spec.on_duplicate is OnDuplicate.REFUSE:
                raise self.spec.duplicate_error(key)
        return tuple(new.values())

    def extend(self, parts: Sequence[T]) -> None:
        """Append parts without a check of their keys."""
        if self._positions is not None:
            for position, part in enumerate(parts, len(self.items)):
                self._positions.setdefault(self.spec.key(part), position)
        self.items += parts

    def copy(self) -> PartList[T]:
        """Return a list of its own with the same parts."""
        return PartList(self.spec, self.items)


Additions: TypeAlias = list[tuple[PartList[Any], Iterable[object]]]
"""Lists, each with what is to be added to it."""


def extend_all(additions: Additions) -> None:
    """Add parts to several lists, or to none of them.

    Raises:
        RobotValidationError: DUPLICATE_NAME for a key that is taken, where the list's spec refuses that.

    """
    selected = [(parts, parts.select_new(added)) for parts, added in additions]
    for parts, new in selected:
        parts.extend(new)


class NamedTable(tuple[T, ...]):
    """The tuple of a robot's parts of one kind, which answers to names as well.

    It never changes: it has the parts that the robot had when the table was read. Where a name occurs twice, the
    first part of that name is found. A link that is renamed in place is found by its new name.
    """

    _parts: PartList[T]

    def __new__(cls, parts: PartList[T]) -> NamedTable[T]:
        table = super().__new__(cls, parts.items)
        table._parts = parts
        return table

    def is_all_of(self, parts: PartList[T]) -> bool:
        """Tell whether these are the parts that the list has now."""
        return self._parts is parts and len(self) == len(parts.items)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the parts in their order, or what serves as such."""
        return tuple(map(str, map(self._parts.spec.key, self)))

    def get(self, name: Hashable) -> T | None:
        """Return the part of that name, None if there is none."""
        position = self._parts.position(name)
        return super().__getitem__(position) if position < len(self) else None

    @overload
    def __getitem__(self, place: SupportsIndex | str) -> T: ...
    @overload
    def __getitem__(self, place: slice) -> tuple[T, ...]: ...
    def __getitem__(self, place: SupportsIndex | str | slice) -> T | tuple[T, ...]:
        """Return the part of a name or at a position, or the tuple of a slice.

        Raises:
            RobotValidationError: NOT_FOUND for a name that no part has.

        """
        if not isinstance(place, str):
            return super().__getitem__(place)
        part = self.get(place)
        if part is None:
            raise self._parts.spec.missing_error(place)
        return part

    def __contains__(self, sought: object) -> bool:
        """Tell whether a name, or an equal part, is here."""
        return self.get(sought) is not None if isinstance(sought, str) else super().__contains__(sought)

    def __reduce__(self) -> tuple[type[NamedTable[T]], tuple[PartList[T]]]:
        return NamedTable, (PartList(self._parts.spec, self),)


Index = NamedTable
"""The name under which `linkforge_compile.core` exports the class."""
