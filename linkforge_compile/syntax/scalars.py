"""Values of plain scalars by YAML 1.2's core schema; PyYAML's own loaders read YAML 1.1."""

from __future__ import annotations

import math
import re

from linkforge_compile.syntax.nodes import ScalarValue

_WORDS: dict[str, ScalarValue] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((sign + word for sign in ("", "+") for word in (".inf", ".Inf", ".INF")), math.inf),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -math.inf),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
}

TRUTHS_OF_YAML_1_1 = {"yes": "true", "on": "true", "no": "false", "off": "false"}
"""Words, in any case, that YAML 1.1 reads as booleans and YAML 1.2 as text, and what to write for each."""

_NUMBER = re.compile(
    r"""(?P<decimal> [-+]? [0-9]+ )
      | (?P<octal> 0o [0-7]+ )
      | (?P<hexadecimal> 0x [0-9a-fA-F]+ )
      | (?P<fraction> [-+]? (?: \.[0-9]+ | [0-9]+ (?: \.[0-9]* )? ) (?: [eE] [-+]? [0-9]+ )? )""",
    re.VERBOSE,
)
IN_QUOTES = re.compile(r"'[^']*'|\"[^\"]*\"")

_BASES = {"decimal": 10, "octal": 8, "hexadecimal": 16}
_MOST_DIGITS = 400
"""More than the 309 digits of a double; Python refuses integers of more than 4,300."""


def scalar_value(text: str) -> ScalarValue:
    """Return null, a boolean or a number if the plain text is one, else the text itself.

    A quantity such as `90 deg` is text here. Numbers beyond a double are infinite, integers too.
    """
    if text in _WORDS:
        return _WORDS[text]
    match = _NUMBER.fullmatch(text)
    if match is None:
        return text
    base = _BASES.get(str(match.lastgroup))
    if base is None:
        return float(text)
    return _whole_number(text, base)


def is_overflow(text: str, value: ScalarValue) -> bool:
    """Whether plain text is a number too large for a double; `.inf` is not."""
    return isinstance(value, float) and math.isinf(value) and text not in _WORDS


def has_expression(text: str) -> bool:
    """Whether text holds an expression `$(...)`, or `$$(` for a literal `$(`."""
    return "$(" in text


def is_cut_expression(text: str) -> bool:
    """Whether a plain scalar holds `$(` without its `)`, because a comma or bracket of a flow list ended it."""
    start = text.find("$(")
    if start < 0:
        return False
    rest = IN_QUOTES.sub("", text[start:])
    return rest.count("(") > rest.count(")")


def word_value(text: str) -> ScalarValue:
    """Return the value that text has without quotes; the text itself where it needs quotes.

    Without quotes, null would be no value, and a number too large for a double an error.
    """
    value = scalar_value(text)
    return text if value is None or is_overflow(text, value) else value


def _whole_number(text: str, base: int) -> int | float:
    too_large = -math.inf if text.startswith("-") else math.inf
    if len(text) > _MOST_DIGITS:
        return too_large
    number = int(text, base)
    try:
        float(number)
    except OverflowError:
        return too_large
    return number


# Expressions of xacro, which newcomers write

XACRO_EXPRESSION = re.compile(r"\$\{(?P<within>[^{}\r\n]*)\}")


def xacro_facts(text: str) -> tuple[dict[str, str], ...]:
    """Return for each `${length / 2}` in a text the facts of the code XACRO_EXPRESSION."""
    found = XACRO_EXPRESSION.finditer(text)
    return tuple({"text": each[0], "ours": f"$({each['within'].strip()})"} for each in found)
