"""Characters that specs may not hold, and escapes for those that messages cannot show."""

from __future__ import annotations

import re

# Characters that YAML or XML refuses or that they count differently: U+0085, U+2028 and U+2029 are line breaks to YAML
# 1.1 parsers but not to editors and YAML 1.2, so that all line numbers after one would be wrong.
FORBIDDEN_CHARACTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\x80-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]")
"""Matches a control character, a lone surrogate, a stray byte order mark, or a line separator of Unicode."""

LIKE_SPACES = re.compile(r"[ \t]*([\u00a0\u2000-\u200b\u202f\u3000])")
"""Matches what looks like a space at the start of a line but does not indent, such as a no-break space."""


def code_point(character: str) -> str:
    """Return the name of a character that cannot be seen: U+00A0."""
    return f"U+{ord(character):04X}"


def on_one_line(text: str) -> str:
    """Return the text with escapes for line ends, control characters and bytes that are not UTF-8.

    Messages quote the contents and names of untrusted files.
    """
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else each.encode("unicode_escape").decode() for each in text)
