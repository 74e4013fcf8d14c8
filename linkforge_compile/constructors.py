"""The codes of what makes objects of so many fields, compiled once for all classes that have as many.

A class gives them the names of its fields, and in their cells what sets these. Python compiles a text in the time of
ten such classes, so the codes of usual sizes are kept between processes.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from types import CodeType, FunctionType
from typing import Final

from linkforge_compile.bytecode import kept

_USUAL: Final = range(1, 17)
"""Of the classes that a compile defines, all have so many fields; for more, a code is compiled as it is asked for."""


@cache
def init_code(count: int, has_post_init: bool) -> CodeType:
    """Return that of an `__init__` whose cells, one for each field in order, are called with the object and a value."""
    return _usual().get(_init_name(count, has_post_init)) or _compiled(_init(count, has_post_init)).popitem()[1]


@cache
def new_code(count: int) -> CodeType:
    """Return that of a `__new__` whose cell `new` is called with the class and the values."""
    return _usual().get(_new_name(count)) or _compiled(_new(count)).popitem()[1]


@cache
def filling_code(count: int) -> CodeType:
    """Return that of a function that sets fields by name, and whose cells are `kind` and `opened`.

    `opened` makes an object that refuses no field, which becomes one of the class `kind` in the end.
    """
    return _usual().get(_filling_name(count)) or _compiled(_filling(count)).popitem()[1]


@cache
def _usual() -> dict[str, CodeType]:
    return kept(__file__, "constructors", [Path(__file__)], lambda: _compiled("".join(map(_of_all_kinds, _USUAL))))


def _of_all_kinds(count: int) -> str:
    return _init(count, has_post_init=False) + _init(count, has_post_init=True) + _new(count) + _filling(count)


def _init(count: int, has_post_init: bool) -> str:
    cells = [f"set_{number:03}" for number in range(count)]  # Python orders cells by their names
    fields = [f"field_{number}" for number in range(count)]
    lines = [f"{cell}(self, {field})" for cell, field in zip(cells, fields, strict=True)]
    lines += ["self.__post_init__()"] if has_post_init else []
    return (
        f"def {_init_name(count, has_post_init)}({', '.join(cells)}):\n"
        f" def __init__({', '.join(['self', *fields])}):\n  " + "\n  ".join(lines or ["pass"]) + "\n return __init__\n"
    )


def _new(count: int) -> str:
    fields = "".join(f"field_{number}, " for number in range(count))
    made = f"def __new__(_cls, {fields}):\n  return new(_cls, ({fields}))"
    return f"def {_new_name(count)}(new):\n {made}\n return __new__\n"


def _filling(count: int) -> str:
    fields = [f"field_{number}" for number in range(count)]
    lines = ["made = opened()", *(f"made.{field} = {field}" for field in fields), "made.__class__ = kind"]
    filled = f" def fill({', '.join(fields)}):\n  " + "\n  ".join([*lines, "return made"])
    return f"def {_filling_name(count)}(kind, opened):\n{filled}\n return fill\n"


def _init_name(count: int, has_post_init: bool) -> str:
    return f"init_{count}_{has_post_init}"


def _new_name(count: int) -> str:
    return f"new_{count}"


def _filling_name(count: int) -> str:
    return f"filling_{count}"


def _compiled(text: str) -> dict[str, CodeType]:
    """Return the codes of what the functions of a text return, by the names of the functions."""
    functions: dict[str, FunctionType] = {}
    exec(text, {}, functions)
    return {name: function(*[None] * function.__code__.co_argcount).__code__ for name, function in functions.items()}
