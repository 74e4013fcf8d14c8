"""Python's collector of cycles, at rest while a robot is compiled, joined to another or rendered."""

from __future__ import annotations

import gc
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


def resting(function: Callable[P, T]) -> Callable[P, T]:
    """Keep Python from looking for cycles during a call; where the caller has it so, that is left as it is.

    It looks at the values made lately each time 700 more are there, and at all of them again and again: a third of the
    time of a robot of 1,000 links. What a right spec is compiled to holds no cycles, and lives until the end. What
    jsonschema tells of a wrong one does: of 3,000 wrong links 18 MB are kept until their compile ends. The collector is
    one for all threads: what holds cycles in others waits as long, and who switches it off there meanwhile finds it on
    at the end. When two compile at once, it may begin again with the end of the first.
    """

    @wraps(function)
    def rested(*arguments: P.args, **named: P.kwargs) -> T:
        if not gc.isenabled():
            return function(*arguments, **named)
        gc.disable()
        try:
            return function(*arguments, **named)
        finally:
            gc.enable()

    return rested
