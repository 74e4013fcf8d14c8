"""Put a prefix before the names in a part of the IR and in the parts that it holds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

from linkforge_compile.core.frozen_map import FrozenMap

P = TypeVar("P")


def prefixed_copy(part: P, prefix: str) -> P:
    """Return a dataclass with the prefix before what stands in the fields that its class lists in PREFIXED.

    A frozen part whose fields all stay as they are is returned itself.

    Raises:
        RobotModelError: What the constructor raises, where the prefix makes a name that it refuses.

    """
    # Any: a field's value is a name, names, parts or a mapping by names, as its class says.
    values: dict[str, Any] = {name: getattr(part, name) for name in part.PREFIXED}  # type: ignore[attr-defined]  # a Part
    changed = {name: _prefixed(value, prefix) for name, value in values.items() if value}
    if all(value is values[name] for name, value in changed.items()):
        return part
    copy: P = replace(part, **changed)  # type: ignore[type-var]  # a dataclass, which a type variable cannot say
    return copy


def prefixed_copies(parts: Iterable[P], prefix: str) -> list[P]:
    """Return each part under the prefix, as its own `with_prefix` says."""
    return [part.with_prefix(prefix) for part in parts]  # type: ignore[attr-defined]  # parts and links


def _prefixed(value: Any, prefix: str) -> Any:
    if isinstance(value, str):
        return prefix + value if value else value
    if isinstance(value, Mapping):
        return FrozenMap({prefix + name: each for name, each in value.items()})
    if isinstance(value, Iterable):
        values = tuple(value)
        copies = tuple(_prefixed(each, prefix) for each in values)
        return value if all(map(_is_same, copies, values)) else copies
    return value.with_prefix(prefix)


def _is_same(one: object, other: object) -> bool:
    return one is other
