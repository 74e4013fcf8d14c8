r"""What plain text is, text without quotes, as patterns for simple YAML: what libyaml takes for it, or less.

Sets of characters name those that they leave out, all of ASCII: of such a set `re` makes a table, where `\w` asks for
each character what it is. Groups repeat so many times at most, for `re` remembers each time.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final, TypeAlias

from linkforge_compile.syntax.nodes import ScalarValue
from linkforge_compile.syntax.scalars import is_cut_expression, is_overflow, scalar_value

Match: TypeAlias = Callable[..., re.Match[str] | None]
"""What matches a compiled pattern with a text, from an index on where one is given."""

BEGIN: Final = r"[^ \n\0?:,\[\]{}#&*!|>'\"%@`]"
"""What it may begin with; of a dash and of three dots more is asked."""

INSIDE: Final = r"[^ \n\0:#]"
"""What does not end it in block style, nor needs a look at what comes next."""

INSIDE_BRACKETS: Final = r"[^ \n\0:#,\[\]{}?]"

_BEGIN = rf"(?!-(?![\w.$(/])|\.\.\.){BEGIN}"

QUOTED: Final = re.compile(r"\"[^\"\\\n]*\"|'[^'\n]*'(?!')").match
"""A text in quotes, on one line, without escapes."""


class PlainTexts:
    """Plain texts of one style, with what they mean, of all that was read of a file so far."""

    def __init__(self, inside: str, *, are_in_brackets: bool) -> None:
        # A colon and what could begin a comment are part of a word, where no blank stands behind or before them.
        behind_colon = r"[\w/]" if are_in_brackets else r"[^ \n\0]"
        more = rf" *:(?={behind_colon})|#| +(?={inside})"
        self.match: Final[Match] = re.compile(rf"{_BEGIN}{inside}*(?:(?:{more}){inside}*){{0,999}}").match
        self._are_in_brackets = are_in_brackets
        self.values: Final[dict[str, ScalarValue]] = {}

    def learns(self, text: str) -> bool:
        """Whether all of a text that was cut out is plain, and has no tags: what it means is in `values` then."""
        found = self.match(text)
        if (
            found is None
            or found.end() < len(text)
            or "<" in text
            or not self.may_mean(text, value := scalar_value(text))
        ):
            return False
        self.values[text] = value
        return True

    def may_mean(self, text: str, value: ScalarValue) -> bool:
        """Whether a value is no number beyond all, and its text no expression that brackets cut in pieces."""
        return not is_overflow(text, value) and not (self._are_in_brackets and is_cut_expression(text))
