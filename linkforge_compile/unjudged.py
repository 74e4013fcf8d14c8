"""Objects of classes with slots, of judged values: made without another look, in a seventh of the time."""

from __future__ import annotations

from collections.abc import Callable
from types import CellType, FunctionType
from typing import Any, ParamSpec, TypeVar

from linkforge_compile.constructors import filling_code

P = TypeVar("P")
Arguments = ParamSpec("Arguments")


def unjudged(kind: Callable[Arguments, P]) -> Callable[Arguments, P]:
    """Return what is called as a class with slots is, and makes of right values what that does, but looks at none.

    Whoever calls it knows that the constructor would refuse no value, and keep each as it is: numbers are floats
    in the range of their field, sequences are tuples.
    """
    assert isinstance(kind, type)
    constructor = vars(kind)["__init__"]
    assert isinstance(constructor, FunctionType)
    called = constructor.__code__
    names = called.co_varnames[1 : called.co_argcount + called.co_kwonlyargcount]  # without self
    code = filling_code(len(names)).replace(
        co_qualname=kind.__qualname__,
        co_names=(*names, "__class__"),
        co_varnames=(*names, "made"),
        co_argcount=called.co_argcount - 1,
        co_kwonlyargcount=called.co_kwonlyargcount,
    )
    cells = CellType(kind), CellType(opened(kind))  # in the order of their names in the code
    make = FunctionType(code, {}, kind.__name__, constructor.__defaults__, cells)
    make.__kwdefaults__ = constructor.__kwdefaults__
    return make


_OPENED: dict[type[Any], type[Any]] = {}


def opened(kind: type[Any]) -> type[Any]:
    """Return the class without its refusal to set a field, which lets Python set slots in a fifth of the time.

    It has the same slots, so that Python takes an object of it for one of the class once it is told to. Whoever asks
    the class for its `__subclasses__()` finds this one among them.
    """
    if kind not in _OPENED:
        plain = {name: vars(object)[name] for name in ("__init__", "__setattr__", "__delattr__")}
        _OPENED[kind] = type(f"Opened{kind.__name__}", (kind,), {"__slots__": (), **plain})
    return _OPENED[kind]
