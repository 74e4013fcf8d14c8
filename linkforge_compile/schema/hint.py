"""What to write instead of a value: the end of a message, and its fix."""

from __future__ import annotations

from typing import NamedTuple

from linkforge_compile.diagnostics.fix import Fix, Replacement
from linkforge_compile.source import Span


class Hint(NamedTuple):
    """What to write instead of a value."""

    ending: str = ""
    """The end of a message, "" for no hint."""
    value: str = ""
    """The text to write for the value, "" if something else has to change."""
    is_safe: bool = False
    """Whether nothing else can be intended."""
    around: Span | None = None
    """The span to write it to, if that is more than the value."""
    other: Fix | None = None
    """The fix of what has to change, if that is not the value alone."""

    def fix(self, span: Span) -> Fix | None:
        """Return the fix of the value at a span; None if there is none, or if a part of it is not shown."""
        is_whole = self.value != "" and "…" not in self.value
        return Replacement("", self.value, self.is_safe).within(self.around or span) if is_whole else self.other


NO_HINT = Hint()


def write(value: str, *, is_safe: bool = False, words: str = "") -> Hint:
    """Return the hint to write a value; `words` show it in the message if they are more than the value."""
    shown_words = words or f"'{value}'"
    return Hint(f"; write {shown_words}", value, is_safe)


def change(words: str, fix: Fix | None = None) -> Hint:
    """Return the hint to write something that is more than the value."""
    return Hint(f"; write {words}", other=fix)
