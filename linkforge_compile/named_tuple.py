"""`NamedTuple`, quick to define: what `typing` makes of a named tuple, in a fifth of the time.

The standard library compiles the text of each annotation and of each class's `__new__`. Here annotations stay the texts
that they are, `__new__` has its code from `constructors.py`, and the other methods are those of one
base, without docstrings. Nothing else differs: order, unpacking, `match`, `pickle`, `_replace` and type checkers see
what they saw.

What takes more than a look is left to the standard library, to make or to refuse: further bases, an annotation that is
no text, or that Python would first have to compute, and faults.
"""

from __future__ import annotations

import collections
import sys
import typing
from collections.abc import Iterable, Mapping, Sequence
from types import CellType, FunctionType, new_class
from typing import TYPE_CHECKING, Final, Self

from linkforge_compile.constructors import new_code

__all__ = ["NamedTuple"]

_getter: Final = vars(collections)["_tuplegetter"]
"""What gives a field by its number: the standard library's, in C."""

_REFUSED: Final = frozenset(
    {
        *("__new__", "__init__", "__slots__", "__getnewargs__"),
        *("_fields", "_field_defaults", "_make", "_replace", "_asdict", "_source"),
    }
)
"""Attributes that the standard library refuses to a named tuple of its own."""


class _Row(tuple[object, ...]):
    """The methods of all named tuples."""

    __slots__ = ()
    if TYPE_CHECKING:
        _fields: tuple[str, ...]

    @classmethod
    def _make(cls, values: Iterable[object]) -> Self:
        row = tuple.__new__(cls, values)
        if len(row) != len(cls._fields):
            raise TypeError(f"Expected {len(cls._fields)} arguments, got {len(row)}")
        return row

    def _replace(self, /, **changes: object) -> Self:
        row = self._make(map(changes.pop, self._fields, self))
        if changes:
            # As of Python 3.13 the standard library calls that a wrong type.
            raise _WRONG_FIELD(f"Got unexpected field names: {list(changes)!r}")
        return row

    def _asdict(self) -> dict[str, object]:
        return dict(zip(self._fields, self, strict=True))

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={value!r}" for name, value in zip(self._fields, self, strict=True))
        return f"{type(self).__name__}({shown})"

    def __getnewargs__(self) -> tuple[object, ...]:
        return tuple(self)

    if sys.version_info >= (3, 13):
        __replace__ = _replace


_WRONG_FIELD: Final = TypeError if sys.version_info >= (3, 13) else ValueError


class _Rows(type):
    """The metaclass of `NamedTuple` and of nothing else: what derives from that is an ordinary class."""

    def __new__(cls, name: str, bases: tuple[type, ...], body: dict[str, object]) -> type:
        # Python 3.14 has them in the body only where they are texts.
        annotations = body.get("__annotations__")
        if not isinstance(annotations, dict) or len(bases) > 1 or not _is_plain(body, annotations):
            return _theirs(name, bases, body)
        fields = tuple(annotations)
        return type(name, (_Row,), _shown(name, fields) | body | _made(body, fields, annotations))


def _theirs(name: str, bases: tuple[type, ...], body: dict[str, object]) -> type:
    # What a body says of its bases: they are other than those that were written where one of them is generic.
    written = body.pop("__orig_bases__", bases)
    assert isinstance(written, tuple)
    theirs = tuple(typing.NamedTuple if isinstance(base, _Rows) else base for base in written)
    return new_class(name, theirs, {}, lambda namespace: namespace.update(body))


def _is_plain(body: Mapping[str, object], annotations: Mapping[str, object]) -> bool:
    has_default = [field in body for field in annotations]
    return (
        _REFUSED.isdisjoint(body)
        and has_default == sorted(has_default)
        and all(isinstance(annotation, str) for annotation in annotations.values())
        and not any(field.startswith("_") for field in annotations)
    )


def _shown(name: str, fields: Sequence[str]) -> dict[str, object]:
    """Return what the body of a class may say otherwise."""
    return {"__doc__": f"{name}({', '.join(fields)})", "__match_args__": fields}


def _made(body: Mapping[str, object], fields: tuple[str, ...], annotations: dict[str, object]) -> dict[str, object]:
    defaults = {field: body[field] for field in fields if field in body}
    code = new_code(len(fields)).replace(co_varnames=("_cls", *fields), co_qualname=f"{body['__qualname__']}.__new__")
    module = sys.modules.get(str(body["__module__"]))
    new = FunctionType(code, vars(module) if module else {}, argdefs=tuple(defaults.values()), closure=_CLOSURE)
    new.__annotations__ = annotations
    getters = {field: _getter(number, f"Alias for field number {number}") for number, field in enumerate(fields)}
    return {"__slots__": (), "__new__": new, "_fields": fields, "_field_defaults": defaults, **getters}


_CLOSURE: Final = (CellType(tuple.__new__),)


if TYPE_CHECKING:
    from typing import NamedTuple
else:
    NamedTuple = type.__new__(_Rows, "NamedTuple", (), {"__doc__": typing.NamedTuple.__doc__})
