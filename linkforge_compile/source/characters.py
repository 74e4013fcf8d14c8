"""Which characters text may hold: those that YAML and XML both accept and both count alike."""

from __future__ import annotations

import re

# U+0085, U+2028 and U+2029 are line breaks to YAML 1.1 parsers and none to editors and YAML 1.2: every line number
# behind one would be wrong. The list is of what is forbidden because one of what is allowed takes 4 ms to compile.
FORBIDDEN_CHARACTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\x80-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]")
"""Finds a control character, a lone surrogate, a stray byte order mark, or one of those line separators."""


LIKE_SPACES = re.compile(r"[ \t]*([\u00a0\u2000-\u200b\u202f\u3000])")
"""Finds what looks like a space where a line begins, such as a no-break space of a web page: it indents nothing."""


def code_point(character: str) -> str:
    """Return the character as messages name what cannot be seen: U+00A0."""
    return f"U+{ord(character):04X}"


def on_one_line(text: str) -> str:
    """Return the text with line ends, control characters and bytes that are no UTF-8 spelled out.

    Messages quote what hostile files hold, and how they are called.
    """
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else each.encode("unicode_escape").decode() for each in text)
