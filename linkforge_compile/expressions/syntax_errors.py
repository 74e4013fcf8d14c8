"""Explain why Python cannot parse an expression, by the habits of other languages."""

from __future__ import annotations

import keyword
import re
from typing import NamedTuple

from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.units import UNITS

STRING = r"'(?:[^'\\]|\\.)*'|\"(?:[^\"\\]|\\.)*\""
"""Matches a text in quotes in an expression."""

_UNITS = "|".join(re.escape(name) for name in sorted(UNITS, key=len, reverse=True))
_KEYWORDS = "|".join(keyword.kwlist)

_HABITS: tuple[tuple[str, str, str, bool], ...] = (
    # pattern, problem, what to write in its place, "" where that is not clear, and whether nothing else can be intended
    (r"^\s*find\s+([\w-]+)\s*$", "'$(find ...)' is xacro; write package://{1}/...", "", False),
    (r"^\s*arg\s+(.*?)\s*$", "'$(arg ...)' and '$(eval ...)' are xacro; write $({1})", "{1}", True),
    (r"^\s*eval\s+(.*?)\s*$", "'$(arg ...)' and '$(eval ...)' are xacro; write $({1})", "{1}", False),
    (r"^\s*(?:env|optenv)\s.*", "the environment is not read; declare a parameter", "", False),
    (r"&&", "write 'and' for '&&'", "and", True),
    (r"\|\|", "write 'or' for '||'", "or", True),
    # C's binds more closely than ours.
    (r"!(?!=)", "write 'not' for '!'", "not", False),
    (r"\?", "write: a if condition else b", "", False),
    (r"\$[({]?", "write names without '$' here", "", False),
    (r"#", "expressions cannot contain comments", "", False),
    (r"(?<![=!<>:])=(?!=)", "compare two values with '=='", "==", False),
    (
        rf"(?<![\w.])((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\s*(?!in\b)(?:{_UNITS}))(?!\w)",
        "units are not allowed here; declare '{1}' in 'variables'",
        "",
        False,
    ),
    (r"[×·⋅∙]", "write '*' for '{0}'", "*", True),
    (r"÷", "write '/' for '{0}'", "/", True),
    (r"[−–—]", "write '-' for '{0}'", "-", True),
    (r"≤", "write '<=' for '{0}'", "<=", True),
    (r"≥", "write '>=' for '{0}'", ">=", True),
    (r"≠", "write '!=' for '{0}'", "!=", True),
    (r"²", "write '** 2' for '{0}'", "** 2", True),
    (r"³", "write '** 3' for '{0}'", "** 3", True),
    (rf"\.\s*({_KEYWORDS})\b", "'{1}' is a reserved word; read that key with ['{1}']", "", False),
    (r"(?<![\w.])0[0-9]+\b(?!\.)", "a number cannot begin with 0", "", False),
    (r"\bif\b(?!.*\belse\b)", "'if' needs an 'else'", "", False),
)
"""Habits from other languages, searched in the text without its strings, and the problem; the first match wins."""


class SyntaxProblem(NamedTuple):
    """The offset and length of a syntax error in an expression, what is wrong, and what to write there, if known."""

    start: int
    length: int
    problem: str
    instead: Replacement | None = None


def explain_syntax_error(text: str, error: SyntaxError) -> SyntaxProblem:
    """Return where and what is wrong in an expression that Python cannot parse."""
    bare = re.sub(STRING, lambda found: found[0][0] + " " * (len(found[0]) - 2) + found[0][0], text, flags=re.DOTALL)
    for habit, problem, instead, is_safe in _HABITS:
        if found := re.search(habit, bare):
            facts = (found[0], *found.groups())
            old, new = text[found.start() : found.end()], _with_spaces(instead.format(*facts), found) if instead else ""
            replacement = Replacement(old, new, is_safe, is_whole=True) if new else None
            return SyntaxProblem(found.start(), len(found[0]), problem.format(*facts), replacement)
    # Python counts from 1 and saw one more parenthesis. Its own message differs between versions.
    start = min(max((error.offset or 0) - 2, 0), len(text))
    return SyntaxProblem(start, 1, "something is missing or unexpected here")


def _with_spaces(word: str, found: re.Match[str]) -> str:
    """Return a word with the spaces that part it from the words around what it replaces."""
    begins_apart = re.match(r"\w", word) is None or re.search(r"\w\Z", found.string[: found.start()]) is None
    ends_apart = re.search(r"\w\Z", word) is None or re.match(r"\w", found.string[found.end() :]) is None
    return f"{'' if begins_apart else ' '}{word}{'' if ends_apart else ' '}"
