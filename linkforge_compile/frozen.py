"""`dataclass`, quick to define: what the standard library makes of a frozen class with slots, in a tenth of the time.

A compile defines a hundred classes before it reads its first file. Up to Python 3.12 each takes the standard library a
millisecond, nearly all of it to compile the texts of six methods. Here five of them are the same few functions for all
classes, and `__init__` is compiled once for all that have as many fields. `fields`, `replace`, `match`, `copy`,
`pickle`, subclasses and type checkers see what they saw. Equality is that of tuples, as up to Python 3.12, so that a
NaN equals itself. A class without a docstring has its name for one, not its signature, and `__dataclass_params__` shows
itself otherwise.

What takes more than a look is left to the standard library, to make or to refuse: a class that is not frozen or has no
slots, `InitVar`, `KW_ONLY`, a field that is no argument, an annotation that is no text, or that Python would first have
to compute, a base of those, and faults.
"""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, Field, FrozenInstanceError, field, fields
from functools import cache
from operator import attrgetter
from reprlib import recursive_repr
from types import CellType, CodeType, FunctionType, MemberDescriptorType
from typing import TYPE_CHECKING, Final, TypeAlias, TypeVar

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["dataclass"]

_T = TypeVar("_T")
_Fields: TypeAlias = Mapping[str, Field[object]]

_MADE: Final = vars(dataclasses)["_HAS_DEFAULT_FACTORY"]
"""The default of a parameter that has a factory, as long as nobody says another: signatures show it as `<factory>`."""

_COMPUTED: Final = frozenset({"__annotate__", "__annotate_func__"})
"""What a class of Python 3.14 has whose annotations are not texts yet, by the names of its versions."""

_MARK: Final = "_field_type"
_PLAIN: Final = vars(dataclasses)["_FIELD"]
"""By this mark `fields` tells a field from `ClassVar` and `InitVar`; there is no public way to set it."""


class _Parameters:
    """What the standard library notes of the decorator's arguments; of a base, it asks whether that is frozen."""

    init = repr = frozen = match_args = slots = True
    order = unsafe_hash = weakref_slot = False

    def __init__(self, eq: bool, kw_only: bool) -> None:
        self.eq, self.kw_only = eq, kw_only


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
        if frozen and slots and {"__slots__", "__setattr__", "__delattr__"}.isdisjoint(vars(cls)):
            known = _fields(cls, kw_only)
            if known is not None:
                return _made(cls, known, eq, kw_only)
        return dataclasses.dataclass(frozen=frozen, slots=slots, eq=eq, kw_only=kw_only)(cls)

    return define if cls is None else define(cls)


def _fields(cls: type, kw_only: bool) -> _Fields | None:
    """Return the fields of a class, inherited ones first; None where not all are plain, or not in an order to call."""
    known: dict[str, Field[object]] = {}
    for base in reversed(cls.__mro__[1:]):
        if (parameters := getattr(base, "__dataclass_params__", None)) is not None:
            if not isinstance(parameters, _Parameters):
                return None
            known |= getattr(base, "__dataclass_fields__", {})
    own = _own_fields(cls, kw_only)
    if own is None:
        return None
    known |= own
    positional = [_may_be_left_out(one) for one in known.values() if not one.kw_only]
    return known if positional == sorted(positional) and "self" not in known else None


def _own_fields(cls: type, kw_only: bool) -> _Fields | None:
    """Return the fields that a class does not inherit; None where that takes more than a look."""
    if not _COMPUTED.isdisjoint(vars(cls)):
        return None
    annotations: Mapping[str, object] = cls.__annotations__
    own: dict[str, Field[object]] = {}
    for name, annotation in annotations.items():
        if not isinstance(annotation, str) or "InitVar" in annotation or "KW_ONLY" in annotation:
            return None
        if annotation.startswith("ClassVar["):
            continue
        default: object = getattr(cls, name, MISSING)
        if isinstance(default, MemberDescriptorType):
            default = MISSING  # the slot of a base's field of that name
        # The type is ignored: typeshed says of `field` that it returns the default, as a class body wants it.
        one: Field[object] = default if isinstance(default, Field) else field(default=default)  # type: ignore[arg-type]
        is_plain = one.init and one.hash is None and type(one.default).__hash__ is not None
        if "ClassVar" in annotation or not is_plain:
            return None
        one.name, one.type = name, annotation
        one.kw_only = kw_only if one.kw_only is MISSING else one.kw_only
        setattr(one, _MARK, _PLAIN)
        own[name] = one
    return None if any(isinstance(vars(cls)[name], Field) for name in vars(cls).keys() - own.keys()) else own


def _may_be_left_out(one: Field[object]) -> bool:
    return one.default is not MISSING or one.default_factory is not MISSING


def _made(cls: type[_T], known: _Fields, eq: bool, kw_only: bool) -> type[_T]:
    """Return the class anew, with methods and slots: Python gives slots to a class only as it is made."""

    def refuse_to_set(self: object, name: str, value: object) -> None:
        if type(self) is made or name in known:
            raise FrozenInstanceError(f"cannot assign to field {name!r}")
        super(made, self).__setattr__(name, value)  # type: ignore[misc]  # mypy takes no class that is a variable

    def refuse_to_delete(self: object, name: str) -> None:
        if type(self) is made or name in known:
            raise FrozenInstanceError(f"cannot delete field {name!r}")
        super(made, self).__delattr__(name)  # type: ignore[misc]  # see above

    own = _own_attributes(cls, known, eq)
    attributes = _METHODS | (_comparison(known) if eq else {}) | _description(cls, known) | own
    attributes |= {
        "__setattr__": refuse_to_set,
        "__delattr__": refuse_to_delete,
        "__dataclass_fields__": known,
        "__dataclass_params__": _Parameters(eq, kw_only),
        "__doc__": cls.__doc__ or cls.__name__,
    }
    metaclass: Callable[..., type[_T]] = type(cls)
    made = metaclass(cls.__name__, cls.__bases__, attributes)
    if "__init__" not in own:
        type.__setattr__(made, "__init__", _init(made, known))
    return made


def _own_attributes(cls: type, known: _Fields, eq: bool) -> dict[str, object]:
    # Where the class was as yet without slots, its objects had these two.
    left = known.keys() | {"__dict__", "__weakref__"}
    if eq and "__eq__" in vars(cls) and vars(cls)["__hash__"] is None:
        left.add("__hash__")  # Python's word for having the one and not the other; fields have a hash
    return {name: value for name, value in vars(cls).items() if name not in left}


def _description(cls: type, known: _Fields) -> dict[str, object]:
    inherited = {slot for base in cls.__mro__[1:] for slot in _slots(base)}
    return {
        "__qualname__": cls.__qualname__,
        "__slots__": tuple(name for name in known if name not in inherited),
        "__match_args__": tuple(one.name for one in known.values() if not one.kw_only),
    }


def _slots(cls: type) -> Iterable[str]:
    slots: str | Iterable[str] = vars(cls).get("__slots__", ())
    return (slots,) if isinstance(slots, str) else slots


def _init(cls: type, known: _Fields) -> FunctionType:
    """Return `__init__`: the code for as many fields, with their names, and in its cells what sets each."""
    ordered = sorted(known.values(), key=attrgetter("kw_only"))
    made = tuple(number for number, one in enumerate(ordered) if one.default_factory is not MISSING)
    code = _code(len(ordered), made, hasattr(cls, "__post_init__"))
    # The slot itself sets its field, and need not look for it by name.
    cells = {f"set_{number}": getattr(cls, one.name).__set__ for number, one in enumerate(ordered)}
    cells |= {f"make_{number}": ordered[number].default_factory for number in made} | {"MADE": _MADE}
    keyword = {one.name: _default(one) for one in ordered if one.kw_only}
    init = FunctionType(
        code.replace(
            co_varnames=("self", *(one.name for one in ordered)),
            co_argcount=1 + len(ordered) - len(keyword),
            co_kwonlyargcount=len(keyword),
            co_qualname=f"{cls.__qualname__}.__init__",
        ),
        vars(sys.modules[cls.__module__]) if cls.__module__ in sys.modules else {},
        argdefs=tuple(_default(one) for one in ordered if not one.kw_only and _may_be_left_out(one)),
        closure=tuple(CellType(cells[name]) for name in code.co_freevars),
    )
    init.__kwdefaults__ = {name: default for name, default in keyword.items() if default is not MISSING}
    init.__annotations__ = {one.name: one.type for one in known.values()} | {"return": None}
    return init


def _default(one: Field[object]) -> object:
    return one.default if one.default_factory is MISSING else _MADE


@cache
def _code(count: int, made: Sequence[int], has_post_init: bool) -> CodeType:
    """Return the code of an `__init__` that sets so many fields, of which some, by number, have a factory."""
    fields = [f"field_{number}" for number in range(count)]
    body = [
        f"set_{number}(self, make_{number}() if {name} is MADE else {name})"
        if number in made
        else f"set_{number}(self, {name})"
        for number, name in enumerate(fields)
    ]
    body += ["self.__post_init__()"] if has_post_init else []
    free = [f"set_{number}" for number in range(count)] + [f"make_{number}" for number in made]
    text = (
        f"def outer({', '.join(['MADE', *free])}):\n def __init__({', '.join(['self', *fields])}):\n  "
        + "\n  ".join(body or ["pass"])
        + "\n return __init__"
    )
    names: dict[str, Callable[..., FunctionType]] = {}
    exec(text, names)
    return names["outer"](*[None] * (len(free) + 1)).__code__


def _comparison(known: _Fields) -> dict[str, object]:
    names = [one.name for one in known.values() if one.compare]
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
    shown = ", ".join(f"{one.name}={getattr(self, one.name)!r}" for one in fields(self) if one.repr)
    return f"{self.__class__.__qualname__}({shown})"


def _state(self: DataclassInstance) -> list[object]:
    return [getattr(self, one.name) for one in fields(self)]


def _set_state(self: DataclassInstance, state: Sequence[object]) -> None:
    for one, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, one.name, value)


_METHODS: Final[dict[str, object]] = {
    "__repr__": _repr,
    "__getstate__": _state,
    "__setstate__": _set_state,
    **({"__replace__": dataclasses.replace} if sys.version_info >= (3, 13) else {}),
}


if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    dataclass = _dataclass
