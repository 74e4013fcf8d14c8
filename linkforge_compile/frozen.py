"""`dataclass`, quick to define: the standard one, but for the methods of frozen classes, of which it compiles six each.

A compile defines a hundred classes before it reads its first file. Up to Python 3.12 each takes 0.7 ms, and a sixth of
that where only `__init__` is compiled and the rest are the same few functions. Nothing else differs: `fields`,
`replace`, `match`, `pickle` and type checkers see what they saw.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, Field, FrozenInstanceError, fields
from operator import attrgetter
from reprlib import recursive_repr
from types import MemberDescriptorType
from typing import TYPE_CHECKING, Final, TypeVar

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["dataclass"]

_T = TypeVar("_T")

_MADE: Final = object()
"""The default of a parameter that has a factory, as long as nobody says another."""


def _dataclass(
    cls: type[_T] | None = None,
    /,
    *,
    frozen: bool = False,
    slots: bool = False,
    eq: bool = True,
    kw_only: bool = False,
) -> type[_T] | Callable[[type[_T]], type[_T]]:
    def define(cls: type[_T]) -> type[_T]:
        if not frozen:
            return dataclasses.dataclass(slots=slots, eq=eq, kw_only=kw_only)(cls)
        own = frozenset(vars(cls))
        # Without one, the standard library makes one of the signature, which takes as long as a method.
        cls.__doc__ = cls.__doc__ or cls.__name__
        with _thawed(cls.__mro__[1:]):
            made: type[_T] = dataclasses.dataclass(init=False, repr=False, eq=False, slots=slots, kw_only=kw_only)(cls)
        for name, method in _methods(made, slots, eq).items():
            if name not in own:
                setattr(made, name, method)
        vars(made)["__dataclass_params__"].frozen = True
        return made

    return define if cls is None else define(cls)


@contextmanager
def _thawed(bases: Sequence[type]) -> Iterator[None]:
    """Let the standard library make a class of frozen bases that it need not freeze: that is what takes it long."""
    known = [vars(base).get("__dataclass_params__") for base in bases]
    frozen = [parameters for parameters in known if parameters is not None and parameters.frozen]
    for parameters in frozen:
        parameters.frozen = False
    try:
        yield
    finally:
        for parameters in frozen:
            parameters.frozen = True


def _methods(cls: type, slots: bool, eq: bool) -> dict[str, object]:
    methods: dict[str, object] = {
        "__init__": _init(cls),
        "__repr__": _repr,
        "__setattr__": _refuse_to_set,
        "__delattr__": _refuse_to_delete,
    }
    if slots:
        methods |= {"__getstate__": _state, "__setstate__": _set_state}
    return methods | (_comparison(cls) if eq else {})


def _init(cls: type) -> Callable[..., None]:
    """Return `__init__`, compiled, since every object passes through it."""
    known: dict[str, object] = {"_MADE": _MADE}
    positional, keyword = ["self"], list[str]()
    body = []
    for field in fields(cls):
        name = field.name
        (keyword if field.kw_only else positional).append(_parameter(field, known))
        value = name if field.default_factory is MISSING else f"_make_{name}() if {name} is _MADE else {name}"
        known[f"_set_{name}"] = _setter(cls, name)
        body.append(f"_set_{name}(self, {value})")
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    parameters = ", ".join([*positional, *(("*", *keyword) if keyword else ())])
    methods: dict[str, Callable[..., None]] = {}
    exec(f"def __init__({parameters}):\n " + "\n ".join(body or ["pass"]), known, methods)
    made = methods["__init__"]
    made.__qualname__ = f"{cls.__qualname__}.__init__"
    made.__annotations__ = {field.name: field.type for field in fields(cls)} | {"return": None}
    return made


def _setter(cls: type, name: str) -> Callable[[object, object], None]:
    """Return what sets a field: its slot itself, which need not look for it by name; a slotless class has none."""
    slot = next((vars(base)[name] for base in cls.__mro__ if name in vars(base)), None)
    if isinstance(slot, MemberDescriptorType):
        return slot.__set__
    return lambda one, value: object.__setattr__(one, name, value)


def _parameter(field: Field[object], known: dict[str, object]) -> str:
    if not field.init or field.hash is not None:
        raise TypeError(f"'{field.name}' asks for what frozen classes do not take here")
    if field.default_factory is not MISSING:
        known[f"_make_{field.name}"] = field.default_factory
        return f"{field.name}=_MADE"
    if field.default is not MISSING:
        known[f"_default_{field.name}"] = field.default
        return f"{field.name}=_default_{field.name}"
    return field.name


def _comparison(cls: type) -> dict[str, object]:
    names = [field.name for field in fields(cls) if field.compare]
    values = _values(names)

    def equals(self: object, other: object) -> bool:
        # `is` is no shortcut for equality of a NaN, which a tuple takes as equal to itself.
        return values(self) == values(other) if other.__class__ is self.__class__ else NotImplemented

    def hashed(self: object) -> int:
        return hash(values(self))

    return {"__eq__": equals, "__hash__": hashed}


def _values(names: Sequence[str]) -> Callable[[object], tuple[object, ...]]:
    if len(names) > 1:
        return attrgetter(*names)
    return lambda one: tuple(getattr(one, name) for name in names)


@recursive_repr()
def _repr(self: DataclassInstance) -> str:
    shown = ", ".join(f"{field.name}={getattr(self, field.name)!r}" for field in fields(self) if field.repr)
    return f"{self.__class__.__qualname__}({shown})"


def _refuse_to_set(self: object, name: str, value: object) -> None:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_to_delete(self: object, name: str) -> None:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


def _state(self: DataclassInstance) -> list[object]:
    return [getattr(self, field.name) for field in fields(self)]


def _set_state(self: DataclassInstance, state: Sequence[object]) -> None:
    for field, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, field.name, value)


if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    dataclass = _dataclass
