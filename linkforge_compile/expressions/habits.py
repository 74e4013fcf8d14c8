"""What people write out of habit from other languages, xacro among them, and what they write here instead."""

from __future__ import annotations

import keyword
import re

from linkforge_compile.units import UNITS

_STRING = re.compile(r"'(?:[^'\\]|\\.)*'|\"(?:[^\"\\]|\\.)*\"", re.DOTALL)
_UNITS = "|".join(re.escape(name) for name in sorted(UNITS, key=len, reverse=True))
_KEYWORDS = "|".join(keyword.kwlist)

_HABITS = (
    (r"^\s*find\s+([\w-]+)\s*$", "'$(find ...)' is xacro syntax; a file of a package is package://{1}/..."),
    (r"^\s*(?:arg|eval)\s+(.*?)\s*$", "'$(arg ...)' and '$(eval ...)' are xacro's; write $({1})"),
    (r"^\s*(?:env|optenv)\s.*", "the environment is not read; declare a parameter"),
    (r"&&", "'and' is written for '&&'"),
    (r"\|\|", "'or' is written for '||'"),
    (r"!(?!=)", "'not' is written for '!'"),
    (r"\?", "a choice is written a if condition else b"),
    (r"\$[({]?", "write names without '$' here"),
    (r"#", "it cannot hold a comment"),
    (r"(?<![=!<>:])=(?!=)", "two values are compared with '=='"),
    (
        rf"(?<![\w.])((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\s*(?!in\b)(?:{_UNITS}))(?!\w)",
        "a unit is not allowed here; give '{1}' a name in 'variables'",
    ),
    (r"[×·⋅∙]", "'*' is written for '{0}'"),
    (r"÷", "'/' is written for '{0}'"),
    (r"[−–—]", "'-' is written for '{0}'"),
    (r"≤", "'<=' is written for '{0}'"),
    (r"≥", "'>=' is written for '{0}'"),
    (r"≠", "'!=' is written for '{0}'"),
    (r"²", "'** 2' is written for '{0}'"),
    (r"³", "'** 3' is written for '{0}'"),
    (rf"\.\s*({_KEYWORDS})\b", "'{1}' is a word of the grammar; that key is read with ['{1}']"),
    (r"(?<![\w.])0[0-9]+\b(?!\.)", "a number cannot begin with 0"),
    (r"\bif\b(?!.*\belse\b)", "'if' needs an 'else'"),
)
"""Patterns over the text with its strings blanked out, and what is wrong; the first that is found speaks."""


def explain_syntax_error(text: str, error: SyntaxError) -> tuple[int, int, str]:
    """Return where in an expression the fault is, as offset and length, and what is wrong in plain words."""
    bare = _STRING.sub(lambda found: found[0][0] + " " * (len(found[0]) - 2) + found[0][0], text)
    for habit, problem in _HABITS:
        if found := re.search(habit, bare):
            return found.start(), len(found[0]), problem.format(found[0], *found.groups())
    # Python counts from 1 and saw one parenthesis more; what it says differs from version to version.
    start = min(max((error.offset or 0) - 2, 0), len(text))
    return start, 1, "something is missing or too much here"
