"""`dataclass`, quick to define: what the standard library makes of a class, in a tenth of the time.

A compile defines sixty frozen classes before it reads its first file. Up to Python 3.12 each takes the standard library
a millisecond, nearly all of it to compile the texts of six methods, after the twenty that it takes to import it. Here
five of them are the same few functions for all classes, `__init__` has its code from `constructors.py`, and fields are
light. `fields`, `replace`, `match`, `copy`, `pickle`, subclasses and type checkers see what they saw, be it through
`dataclasses`, which is imported as somebody asks it for one of ours. Equality is that of tuples, as up to Python 3.12,
so that a NaN equals itself. A class without a docstring has its name for one, not its signature, and
`__dataclass_params__` shows itself otherwise.

So are classes made that are frozen and have slots, or are not frozen. What takes more than a look is left to the
standard library, to make or to refuse: `InitVar`, an annotation that is no text, or that Python would first have to
compute, a field that is the standard library's, or no argument where there are slots, a base that is made otherwise,
and faults.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from operator import attrgetter
from reprlib import recursive_repr
from types import CellType, FunctionType, MemberDescriptorType
from typing import TYPE_CHECKING, Final, TypeAlias, TypeVar

from linkforge_compile.constructors import init_code
from linkforge_compile.field import KNOWN, MISSING, THEIRS, Field, Fields, Standard, fields_of, replaced, standard

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["FIELDS", "dataclass", "field", "fields", "replace"]

FIELDS: Final = (KNOWN, THEIRS)
"""The attributes in one of which a class has a dictionary of its fields: made here, or by the standard library."""

_T = TypeVar("_T")


class _Made:
    """The default of a parameter that has a factory, as long as nobody says another."""

    def __repr__(self) -> str:
        return "<factory>"


_MADE: Final = _Made()

_COMPUTED: Final = frozenset({"__annotate__", "__annotate_func__"})
"""What a class of Python 3.14 has whose annotations are not texts yet, by the names of its versions."""


class _Parameters:
    """What the standard library notes of the decorator's arguments; of a base, it asks whether that is frozen."""

    init = repr = match_args = True
    order = unsafe_hash = weakref_slot = False

    def __init__(self, frozen: bool, slots: bool, eq: bool, kw_only: bool) -> None:
        self.frozen, self.slots = frozen, slots
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
        parameters = _Parameters(frozen, slots, eq, kw_only)
        known = _fields(cls, parameters) if slots or not frozen else None
        if known is None:
            return _theirs(cls, frozen=frozen, slots=slots, eq=eq, kw_only=kw_only)
        return _made(cls, known, parameters) if slots else _furnished(cls, known, parameters)

    return define if cls is None else define(cls)


def _theirs(cls: type[_T], *, frozen: bool, slots: bool, eq: bool, kw_only: bool) -> type[_T]:
    from dataclasses import dataclass

    for name, one in list(vars(cls).items()):
        if isinstance(one, Field):
            setattr(cls, name, standard(one))
    return dataclass(frozen=frozen, slots=slots, eq=eq, kw_only=kw_only)(cls)


def _fields(cls: type, parameters: _Parameters) -> Fields | None:
    """Return the fields of a class, inherited ones first; None where not all are plain, or not in an order to call."""
    if parameters.slots and "__slots__" in vars(cls):
        return None
    if parameters.frozen and not {"__setattr__", "__delattr__"}.isdisjoint(vars(cls)):
        return None
    known: dict[str, Field] = {}
    for base in reversed(cls.__mro__[1:]):
        inherited = vars(base).get("__dataclass_params__")
        if inherited is not None:
            if not isinstance(inherited, _Parameters) or inherited.frozen is not parameters.frozen:
                return None
            known |= vars(base)[KNOWN]
    own = _own_fields(cls, parameters)
    if own is None:
        return None
    known |= own
    positional = [one.may_be_left_out for one in known.values() if one.init and not one.kw_only]
    return known if positional == sorted(positional) and "self" not in known else None


def _own_fields(cls: type, parameters: _Parameters) -> Fields | None:
    """Return the fields that a class does not inherit; None where that takes more than a look."""
    if not _COMPUTED.isdisjoint(vars(cls)):
        return None
    annotations: Mapping[str, object] = cls.__annotations__
    texts = [text for text in annotations.values() if isinstance(text, str)]
    if len(texts) < len(annotations):
        return None
    said_of_fields = " ".join(texts)
    may_be_none = "Var" in said_of_fields or "KW_ONLY" in said_of_fields
    kw_only = parameters.kw_only
    own: dict[str, Field] = {}
    for name, annotation in zip(annotations, texts, strict=True):
        if may_be_none and any(word in annotation for word in _NO_FIELDS):
            if not annotation.startswith("ClassVar[") and annotation != "KW_ONLY":
                return None
            kw_only = kw_only or annotation == "KW_ONLY"
            continue
        default: object = getattr(cls, name, MISSING)
        if isinstance(default, MemberDescriptorType):
            default = MISSING  # the slot of a base's field of that name
        one = own[name] = default if isinstance(default, Field) else Field(default=default)
        if type(one.default).__hash__ is None or not (one.init or _is_left_alone(one, parameters)):
            return None
        one.name, one.type = name, annotation
        one.kw_only = kw_only if one.kw_only is None else one.kw_only
    # One without an annotation, or of the standard library's.
    strays = [name for name, value in vars(cls).items() if _is_field(value) and own.get(name) is not value]
    return None if strays else own


_NO_FIELDS: Final = ("ClassVar", "InitVar", "KW_ONLY")
"""What an annotation has that tells of no field, or of one that takes more than a look."""


def _is_left_alone(one: Field, parameters: _Parameters) -> bool:
    """Tell whether a field that is no argument has its default, if any, from its class."""
    return not parameters.slots and one.default_factory is MISSING


def _is_field(value: object) -> bool:
    return isinstance(value, Field) or type(value).__module__ == "dataclasses"


def _furnished(cls: type[_T], known: Fields, parameters: _Parameters) -> type[_T]:
    """Return the class itself, with what it has not of its own."""
    for name, one in known.items():
        if isinstance(vars(cls).get(name), Field):
            # Where an object has no value, Python takes that of its class.
            delattr(cls, name) if one.default is MISSING else setattr(cls, name, one.default)
    methods = _methods(known, parameters) | {"__init__": _init(cls, known, _named_setter)}
    for name, value in methods.items():
        if name not in vars(cls):
            setattr(cls, name, value)
    for name, value in _marks(cls, known, parameters).items():
        setattr(cls, name, value)
    return cls


def _made(cls: type[_T], known: Fields, parameters: _Parameters) -> type[_T]:
    """Return the class anew, with methods and slots: Python gives slots to a class only as it is made."""

    def refuse_to_set(self: object, name: str, value: object) -> None:
        if type(self) is made or name in known:
            raise _frozen(f"cannot assign to field {name!r}")
        super(made, self).__setattr__(name, value)  # type: ignore[misc]  # mypy takes no class that is a variable

    def refuse_to_delete(self: object, name: str) -> None:
        if type(self) is made or name in known:
            raise _frozen(f"cannot delete field {name!r}")
        super(made, self).__delattr__(name)  # type: ignore[misc]  # see above

    own = _own_attributes(cls, known, parameters)
    attributes = _methods(known, parameters)
    attributes |= {"__qualname__": cls.__qualname__, "__slots__": _slots(cls, known), **own}
    if parameters.frozen:
        attributes |= {"__setattr__": refuse_to_set, "__delattr__": refuse_to_delete}
    attributes |= _marks(cls, known, parameters)
    metaclass: Callable[..., type[_T]] = type(cls)
    made = metaclass(cls.__name__, cls.__bases__, attributes)
    if "__init__" not in own:
        setter = _slot_setter if parameters.frozen else _named_setter
        type.__setattr__(made, "__init__", _init(made, known, setter))
    return made


def _methods(known: Fields, parameters: _Parameters) -> dict[str, object]:
    """Return what a class has that does not say it itself."""
    methods = _METHODS | {"__match_args__": _match_args(known)}
    if parameters.eq:
        methods |= _comparison(known) | ({} if parameters.frozen else {"__hash__": None})
    return methods | _STATE if parameters.frozen else methods


def _marks(cls: type, known: Fields, parameters: _Parameters) -> dict[str, object]:
    """Return what tells that a class is one of these."""
    return {
        KNOWN: known,
        THEIRS: _STANDARD,
        "__dataclass_params__": parameters,
        "__doc__": cls.__doc__ or cls.__name__,
    }


_STANDARD: Final = Standard()


def _frozen(message: str) -> AttributeError:
    from dataclasses import FrozenInstanceError

    return FrozenInstanceError(message)


def _own_attributes(cls: type, known: Fields, parameters: _Parameters) -> dict[str, object]:
    # Where the class was as yet without slots, its objects had these two.
    left = known.keys() | {"__dict__", "__weakref__"}
    if parameters.eq and "__eq__" in vars(cls) and vars(cls)["__hash__"] is None:
        left.add("__hash__")  # Python's word for having the one and not the other; fields have a hash
    return {name: value for name, value in vars(cls).items() if name not in left}


def _slots(cls: type, known: Fields) -> tuple[str, ...]:
    inherited = {slot for base in cls.__mro__[1:] for slot in _slots_of(base)}
    return tuple(name for name in known if name not in inherited)


def _slots_of(cls: type) -> Iterable[str]:
    slots: str | Iterable[str] = vars(cls).get("__slots__", ())
    return (slots,) if isinstance(slots, str) else slots


def _match_args(known: Fields) -> tuple[str, ...]:
    return tuple(name for name, one in known.items() if one.init and not one.kw_only)


_Setter: TypeAlias = Callable[[object, object], None]


def _init(cls: type, known: Fields, setter: Callable[[type, str], _Setter]) -> FunctionType:
    """Return `__init__`: the code for as many fields, with their names, and in its cells what sets each."""
    ordered = sorted([one for one in known.values() if one.init], key=attrgetter("kw_only"))
    names = [one.name for one in ordered]
    keyword = [one for one in ordered if one.kw_only]
    code = init_code(len(ordered), hasattr(cls, "__post_init__"))
    init = FunctionType(
        code.replace(
            co_varnames=("self", *names),
            co_argcount=1 + len(ordered) - len(keyword),
            co_kwonlyargcount=len(keyword),
            co_qualname=f"{cls.__qualname__}.__init__",
        ),
        vars(sys.modules[cls.__module__]) if cls.__module__ in sys.modules else {},
        argdefs=tuple([_default(one) for one in ordered if one.may_be_left_out and not one.kw_only]),
        closure=tuple([CellType(_or_made(one, setter(cls, one.name))) for one in ordered]),
    )
    init.__kwdefaults__ = {one.name: _default(one) for one in keyword if one.may_be_left_out}
    init.__annotations__ = {one.name: one.type for one in ordered} | {"return": None}
    return init


def _slot_setter(cls: type, name: str) -> _Setter:
    # The slot itself sets its field, and need not look for it by name.
    set_slot: _Setter = getattr(cls, name).__set__
    return set_slot


def _named_setter(cls: type, name: str) -> _Setter:
    return lambda self, value: setattr(self, name, value)


def _or_made(one: Field, set_field: _Setter) -> _Setter:
    """Return what sets a field, to what its factory makes where no value is said."""
    make = one.default_factory
    if not callable(make):
        return set_field
    return lambda self, value: set_field(self, make() if value is _MADE else value)


def _default(one: Field) -> object:
    return one.default if one.default_factory is MISSING else _MADE


def _comparison(known: Fields) -> dict[str, object]:
    values = _values([name for name, one in known.items() if one.compare])

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
    shown = ", ".join(f"{one.name}={getattr(self, one.name)!r}" for one in fields_of(self) if one.repr)
    return f"{self.__class__.__qualname__}({shown})"


def _state(self: DataclassInstance) -> list[object]:
    return [getattr(self, one.name) for one in fields_of(self)]


def _set_state(self: DataclassInstance, state: Sequence[object]) -> None:
    for one, value in zip(fields_of(self), state, strict=True):
        object.__setattr__(self, one.name, value)


_METHODS: Final[dict[str, object]] = {"__repr__": _repr} | (
    {"__replace__": replaced} if sys.version_info >= (3, 13) else {}
)
_STATE: Final[dict[str, object]] = {"__getstate__": _state, "__setstate__": _set_state}


if TYPE_CHECKING:
    from dataclasses import dataclass, field, fields, replace
else:
    dataclass, field, fields, replace = _dataclass, Field, fields_of, replaced
