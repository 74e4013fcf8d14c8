"""Copies of frozen parts under a prefix, which is most of what joining robots costs."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import Any, TypeAlias, TypeVar

from linkforge_compile.core.frozen_map import FrozenMap
from linkforge_compile.core.naming import is_valid_name
from linkforge_compile.frozen import fields, replace
from linkforge_compile.unjudged import opened

P = TypeVar("P")

Copies: TypeAlias = dict[type, tuple[Any, Any]]
"""Of each class whose parts are SHARED the last part that was copied under one prefix, and its copy."""

_Copier = Callable[[Any, str, Copies], Any]  # Any: it takes a part of one class and returns another of that class


def prefixed_copy(part: P, prefix: str) -> P:
    """Return a frozen dataclass with the prefix before what stands in the fields that its class calls PREFIXED.

    A prefix that could be a name itself makes nothing wrong that was right before, so nobody looks again; any other
    one goes through the constructor, which says what is wrong with it. So does a part of somebody else's class, which
    may check or compute more than ours.
    """
    copier = _COPIERS.get(part.__class__) or _copier_of(part.__class__)
    copy: P = copier(part, prefix, {}) if is_harmless(prefix) else _constructed_copy(part, prefix, {})
    return copy


def prefixed_copies(parts: Iterable[P], prefix: str, shared: Copies | None = None) -> list[P]:
    """Return parts as `with_prefix` of each gives them, asked only where its class has a way of its own.

    `shared` begins empty, and is handed to every call whose copies share parts under this prefix; None for this alone.
    """
    shared = {} if shared is None else shared
    if not is_harmless(prefix):
        return [_ask(part, prefix) for part in parts]
    return harmless_copies(parts, prefix, shared)


def harmless_copies(parts: Iterable[P], prefix: str, shared: Copies) -> list[P]:
    """Return what `prefixed_copies` does for a prefix that is harmless."""
    copies = []
    for part in parts:  # mostly one, for which a comprehension, a function call more, is slow
        copies.append(_DIRECT.get(part.__class__, _ask_or_learn)(part, prefix, shared))
    return copies


def _copier_of(kind: type[Any]) -> _Copier:
    copier = _written_copier(kind) if kind.__module__.startswith(_OURS) else _constructed_copy
    if kind.SHARED:
        copier = _keeping_the_last(kind, copier)
    _COPIERS[kind] = copier
    if not _has_own_way(kind):
        _DIRECT[kind] = copier
    return copier


def _keeping_the_last(kind: type, copier: _Copier) -> _Copier:
    def copy(part: Any, prefix: str, shared: Copies) -> Any:
        copied, made = shared.get(kind, _NOTHING)
        if copied is not part:
            made = copier(part, prefix, shared)
            shared[kind] = part, made
        return made

    return copy


_NOTHING = None, None


@lru_cache
def is_harmless(prefix: str) -> bool:
    """Tell whether names that are right stay so under the prefix."""
    return is_valid_name(prefix)


_OURS = f"{__name__.partition('.')[0]}."
_COPIERS: dict[type, _Copier] = {}
_DIRECT: dict[type, _Copier] = {}
"""The copiers of classes that have no `with_prefix` of their own: what holds such parts need not ask them for it."""


def _ask(part: Any, prefix: str) -> Any:
    return part.with_prefix(prefix)


def _ask_or_learn(part: Any, prefix: str, shared: Copies) -> Any:
    kind = part.__class__
    return _ask(part, prefix) if _has_own_way(kind) else _copier_of(kind)(part, prefix, shared)


def _has_own_way(kind: type[Any]) -> bool:
    from linkforge_compile.core.part import Part  # which imports this module

    return kind.with_prefix is not Part.with_prefix


def _constructed_copy(part: Any, prefix: str, shared: Copies) -> Any:
    return replace(part, **{name: _under_prefix(getattr(part, name), prefix) for name in part.PREFIXED})


def _under_prefix(value: Any, prefix: str) -> Any:
    """Return what a field holds, be it a name, names, parts or a mapping by names, under a prefix."""
    if not value:
        return value
    if isinstance(value, str):
        return prefix + value
    if isinstance(value, tuple):
        return tuple(_under_prefix(each, prefix) for each in value)
    if isinstance(value, FrozenMap):
        return FrozenMap({prefix + name: each for name, each in value.items()})
    return value.with_prefix(prefix)


def _written_copier(kind: type[Any]) -> _Copier:
    """Return a function that copies slot by slot, written out as dataclass does for `__init__`: a loop is slower."""
    any_name = " or ".join(f"part.{name}" for name in kind.PREFIXED)
    lines = [
        "def copy(part, prefix, shared):",
        f"    if not ({any_name}):",
        "        return part",
        "    copy = opened()",
    ]
    scope: dict[str, Any] = {"kind": kind, "opened": opened(kind), "FrozenMap": FrozenMap}
    scope |= {"direct": _DIRECT.get, "ask": _ask_or_learn, "copies": harmless_copies}
    for field in fields(kind):
        if field.name in kind.PREFIXED:
            lines += [f"    value = part.{field.name}", f"    copy.{field.name} = {_prefixed(str(field.type))}"]
        else:
            lines.append(f"    copy.{field.name} = part.{field.name}")
    exec("\n".join([*lines, "    copy.__class__ = kind", "    return copy"]), scope)
    copier: _Copier = scope["copy"]
    return copier


def _prefixed(kind: str) -> str:
    """Return the Python for the value of a field of a kind under a prefix; what is empty or None stays so."""
    if kind.startswith("str"):
        return "value and prefix + value"
    if kind == "Sequence[str]":
        return "value and tuple([name and prefix + name for name in value])"
    if kind.startswith("Sequence["):
        return "value and tuple(copies(value, prefix, shared))"
    if kind.startswith("Mapping[str"):
        return "FrozenMap({prefix + name: each for name, each in value.items()})"
    return "value and direct(value.__class__, ask)(value, prefix, shared)"
