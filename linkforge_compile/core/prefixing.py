"""Copies of frozen parts under a prefix, which is most of what joining robots costs."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from typing import Any, TypeAlias, TypeVar

from linkforge_compile.core.frozen_map import FrozenMap
from linkforge_compile.core.naming import is_valid_name
from linkforge_compile.frozen import fields, replace
from linkforge_compile.unjudged import opened

P = TypeVar("P")

Copies: TypeAlias = dict[int, Any]
"""The copies, under one prefix, of parts that other parts have in a field of their own, by the `id` of each: links of
one material share its copy as well. Nobody lets go of the parts meanwhile."""

_Copier = Callable[[Sequence[Any], str, Copies], list[Any]]
"""Copies parts, of which the first is of its class and nearly always all are. Any: parts of one class, and theirs."""


def prefixed_copy(part: P, prefix: str) -> P:
    """Return a frozen dataclass with the prefix before what stands in the fields that its class calls PREFIXED.

    A prefix that could be a name itself makes nothing wrong that was right before, so nobody looks again; any other
    one goes through the constructor, which says what is wrong with it. So does a part of somebody else's class, which
    may check or compute more than ours.
    """
    if is_harmless(prefix):
        return written_copies((part,), prefix, {})[0]
    copy: P = _constructed_copy(part, prefix)
    return copy


def prefixed_copies(parts: Sequence[P], prefix: str, shared: Copies | None = None) -> list[P]:
    """Return parts as `with_prefix` of each gives them, asked only where its class has a way of its own.

    `shared` begins empty, and is handed to every call whose copies share parts under this prefix; None for this alone.
    """
    if not parts:
        return []
    if not is_harmless(prefix):
        return _asked(parts, prefix)
    return _harmless_copies(parts, prefix, {} if shared is None else shared)


def written_copies(parts: Sequence[P], prefix: str, shared: Copies) -> list[P]:
    """Return copies under a prefix that is harmless, of parts of one class, whatever way of its own that has.

    That way calls this, for what it asks before it copies.
    """
    if not parts:
        return []
    kind = type(parts[0])
    return (_COPIERS.get(kind) or _copier_of(kind))(parts, prefix, shared)


def _harmless_copies(parts: Sequence[P], prefix: str, shared: Copies) -> list[P]:
    """Return what `prefixed_copies` does for some parts and a prefix that is harmless."""
    return _DIRECT.get(type(parts[0]), _asked_or_learned)(parts, prefix, shared)


@lru_cache
def is_harmless(prefix: str) -> bool:
    """Tell whether names that are right stay so under the prefix."""
    return is_valid_name(prefix)


_OURS = f"{__name__.partition('.')[0]}."
_COPIERS: dict[type, _Copier] = {}
_DIRECT: dict[type, _Copier] = {}
"""The copiers of classes that have no `with_prefix` of their own: what holds such parts need not ask them for it."""


def _copier_of(kind: type[Any]) -> _Copier:
    copier = _written_copier(kind) if kind.__module__.startswith(_OURS) else _constructing_copier(kind)
    _COPIERS[kind] = copier
    if not _has_own_way(kind):
        _DIRECT[kind] = copier
    return copier


def _asked(parts: Sequence[Any], prefix: str, shared: Copies | None = None) -> list[Any]:
    return [part.with_prefix(prefix) for part in parts]


def _asked_or_learned(parts: Sequence[Any], prefix: str, shared: Copies) -> list[Any]:
    kind = type(parts[0])
    return (_asked if _has_own_way(kind) else _copier_of(kind))(parts, prefix, shared)


def _has_own_way(kind: type[Any]) -> bool:
    from linkforge_compile.core.part import Part  # which imports this module

    return kind.with_prefix is not Part.with_prefix


def _copy_in_field(part: Any, prefix: str, shared: Copies) -> Any:
    copy = shared[id(part)] = _harmless_copies((part,), prefix, shared)[0]
    return copy


def _constructing_copier(kind: type[Any]) -> _Copier:
    def copies(parts: Sequence[Any], prefix: str, shared: Copies) -> list[Any]:
        return [
            _constructed_copy(part, prefix) if type(part) is kind else _harmless_copies((part,), prefix, shared)[0]
            for part in parts
        ]

    return copies


def _constructed_copy(part: Any, prefix: str) -> Any:
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
    """Return a function that copies slot by slot, written out as dataclass does for `__init__`: a loop is slower.

    So is a call for each part, of which a module has some sixty: the function takes all that stand side by side, and
    what these hold as well.
    """
    scope: dict[str, Any] = {"FrozenMap": FrozenMap, "direct": _DIRECT.get}
    scope |= {"ask": _asked_or_learned, "harmless": _harmless_copies, "copy_in_field": _copy_in_field}
    lines = ["def copies(parts_0, prefix, shared):", *_indented(_loop(kind, 0, scope)), " return made_0"]
    exec("\n".join(lines), scope)
    copier: _Copier = scope["copies"]
    return copier


def _loop(kind: type[Any], level: int, scope: dict[str, Any]) -> Iterator[str]:
    """Yield the Python that copies parts of a level, nearly all of one class, and name in `scope` what it asks for.

    Of links, with those of their fields that stand for all others:

        made_0 = []
        for part_0 in parts_0:
         if type(part_0) is not Link:
          copy_0 = harmless((part_0,), prefix, shared)[0]
         else:
          copy_0 = OpenedLink()
          value = part_0.name
          copy_0.name = value and prefix + value
          copy_0.inertial = part_0.inertial
          parts_1 = part_0.visuals or ()
          for one in parts_1:
           if type(one) is not Visual or one.material or one.name:
            made_1 = []  # and so on, as for made_0
            copy_0.visuals = tuple(made_1)
            break
          else:
           copy_0.visuals = tuple(parts_1)
          copy_0.__class__ = Link
         made_0.append(copy_0)
    """
    name, part, copy = kind.__name__, f"part_{level}", f"copy_{level}"
    scope |= {name: kind, f"Opened{name}": opened(kind)}
    yield f"made_{level} = []"
    yield f"for {part} in parts_{level}:"
    yield f" if type({part}) is not {name}:"
    yield f"  {copy} = harmless(({part},), prefix, shared)[0]"
    if kind.__dataclass_params__.frozen:
        # What nobody changes, and has no name, is the same in all robots.
        yield f" elif not ({_any_name(kind, part)}):"
        yield f"  {copy} = {part}"
    yield " else:"
    yield f"  {copy} = Opened{name}()"
    for field in fields(kind):
        if field.name not in kind.PREFIXED:
            yield f"  {copy}.{field.name} = {part}.{field.name}"
        elif level == 0 and (inner := inner_kind(kind, str(field.type))):
            yield from _indented(_inner_loop(inner, field.name, scope), 2)
        else:
            yield f"  value = {part}.{field.name}"
            yield f"  {copy}.{field.name} = {_prefixed(str(field.type))}"
    yield f"  {copy}.__class__ = {name}"
    yield f" made_{level}.append({copy})"


def _inner_loop(kind: type[Any], field: str, scope: dict[str, Any]) -> Iterator[str]:
    """Yield the Python that copies what a part holds, but for a tuple in which nothing has a name: it is kept."""
    yield f"parts_1 = part_0.{field} or ()"
    yield "for one in parts_1:"
    yield f" if type(one) is not {kind.__name__} or {_any_name(kind, 'one')}:"
    yield from _indented(_loop(kind, 1, scope), 2)
    yield f"  copy_0.{field} = tuple(made_1)"
    yield "  break"
    yield "else:"
    yield f" copy_0.{field} = tuple(parts_1)"  # a link may hold a list


def _any_name(kind: type[Any], part: str) -> str:
    return " or ".join(f"{part}.{name}" for name in kind.PREFIXED)


def _indented(lines: Iterable[str], by: int = 1) -> Iterator[str]:
    return (" " * by + line for line in lines)


def inner_kind(kind: type[Any], annotation: str) -> type[Any] | None:
    """Return the class of the parts that a field of a class holds several of, by its annotation.

    None for other fields, for parts with a way of their own, and where the class's module does not import theirs: a
    function for these is asked for each.
    """
    name = annotation.removeprefix("Sequence[").removesuffix("]")
    inner = vars(sys.modules[kind.__module__]).get(name) if name != annotation else None
    return inner if isinstance(inner, type) and hasattr(inner, "PREFIXED") and not _has_own_way(inner) else None


def _prefixed(kind: str) -> str:
    """Return the Python for the value of a field of a kind under a prefix; what is empty or None stays so."""
    if kind.startswith("str"):
        return "value and prefix + value"
    if kind == "Sequence[str]":
        return "value and tuple([name and prefix + name for name in value])"
    if kind.startswith("Sequence["):
        return "value and tuple(direct(type(value[0]), ask)(value, prefix, shared))"
    if kind.startswith("Mapping[str"):
        return "FrozenMap({prefix + name: each for name, each in value.items()})"
    return "value and (shared.get(id(value)) or copy_in_field(value, prefix, shared))"
