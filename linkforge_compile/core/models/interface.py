"""Interfaces of ros2_control: names of what may be commanded or read, with parameters where they have some."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NoReturn

from linkforge_compile.core.frozen_map import FrozenMap
from linkforge_compile.core.part import Inside, attribute_pairs
from linkforge_compile.source import SourceRef


class Interface(str):
    """The name of an interface, such as `position`: `<command_interface name>` or `<state_interface name>`.

    It sorts, hashes and prints as that name, and equals it; two interfaces are equal if their parameters and extras
    are, too. `parameters` are texts by name (`min`, `max`, `initial_value`): `<param name>`.
    `source` is where it was written, None if it was not read.
    """

    __slots__ = ("extra_attributes", "extra_elements", "extra_inside", "parameters", "source")

    parameters: Mapping[str, str]
    source: SourceRef | None
    extra_attributes: tuple[tuple[str, str], ...]
    extra_elements: tuple[str, ...]
    extra_inside: tuple[Inside, ...]

    def __new__(
        cls,
        name: str,
        parameters: Mapping[str, str] = FrozenMap(),
        *,
        source: SourceRef | None = None,
        extra_attributes: Sequence[tuple[str, str]] = (),
        extra_elements: Sequence[str] = (),
        extra_inside: Sequence[Inside] = (),
    ) -> Interface:
        interface = super().__new__(cls, name)
        facts = {
            "parameters": FrozenMap(parameters),
            "source": source,
            "extra_attributes": attribute_pairs(extra_attributes),
            "extra_elements": tuple(extra_elements),
            "extra_inside": tuple(extra_inside),
        }
        for fact, value in facts.items():
            object.__setattr__(interface, fact, value)
        return interface

    @classmethod
    def of(cls, name: str) -> Interface:
        """Return the interface itself, or one without parameters for a bare name."""
        return name if isinstance(name, Interface) else cls(name)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Interface):
            return str.__eq__(self, other) and self._facts == other._facts
        return str.__eq__(self, other) if isinstance(other, str) else NotImplemented

    def __ne__(self, other: object) -> bool:
        # str defines `__ne__` itself and does not call `__eq__`.
        equal = self.__eq__(other)
        return equal if equal is NotImplemented else not equal

    __hash__ = str.__hash__

    @property
    def _facts(self) -> tuple[object, ...]:
        return tuple(getattr(self, fact) for fact in _FACTS)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"an Interface cannot be changed: {name}")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"an Interface cannot be changed: {name}")

    def __copy__(self) -> Interface:
        return self

    def __deepcopy__(self, memo: object) -> Interface:
        return self

    def __reduce__(self) -> tuple[object, ...]:
        return _revive, (str(self), {name: getattr(self, name) for name in ("source", *_FACTS)})


_FACTS = ("parameters", "extra_attributes", "extra_elements", "extra_inside")


def _revive(name: str, facts: Mapping[str, Any]) -> Interface:  # Any: each fact has a type of its own
    return Interface(name, **facts)
