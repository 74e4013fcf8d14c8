"""`pattern`: `re.compile` that waits until its pattern is used, for those that a common spec never needs.

To compile one takes longer than to define a class, and one with characters far beyond ASCII as long as to define ten:
`Characters` waits with these until a text has some that are not ASCII.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, AnyStr, Generic

__all__ = ["Characters", "pattern"]


class _Pattern(Generic[AnyStr]):
    """What stands for a compiled pattern, and has its methods as soon as they are asked for.

    It is none itself: call its own methods, for the functions of `re` do not take it. Its copies are compiled.
    """

    def __init__(self, text: AnyStr, flags: int = 0) -> None:
        self._text: AnyStr = text
        self._flags = flags

    def __reduce__(self) -> tuple[Callable[[AnyStr, int], re.Pattern[AnyStr]], tuple[AnyStr, int]]:
        return re.compile, (self._text, self._flags)

    def __getattr__(self, name: str) -> object:
        if name.startswith("_"):  # its own, which `__init__` gives it, and what Python asks of everything
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        # `re` remembers what it compiled; what is found here is not asked for again.
        value: object = getattr(re.compile(self._text, self._flags), name)
        setattr(self, name, value)
        return value


if TYPE_CHECKING:
    from re import compile as pattern
else:
    pattern = _Pattern


class Characters:
    """What finds characters in text: those of ASCII, and those beyond it, each as between the brackets of a pattern."""

    __slots__ = ("_all", "_of_ascii")

    def __init__(self, of_ascii: str, beyond: str) -> None:
        self._of_ascii = re.compile(f"[{of_ascii}]")
        self._all = pattern(f"[{of_ascii}{beyond}]")

    def search(self, text: str) -> re.Match[str] | None:
        return (self._of_ascii if text.isascii() else self._all).search(text)

    def sub(self, replacement: str, text: str) -> str:
        return (self._of_ascii if text.isascii() else self._all).sub(replacement, text)
