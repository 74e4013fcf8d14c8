"""What newcomers write as xacro has it: `${length / 2}`, which is `$(length / 2)` here."""

from __future__ import annotations

import re

XACRO_EXPRESSION = re.compile(r"\$\{(?P<within>[^{}\r\n]*)\}")


def xacro_facts(text: str) -> tuple[dict[str, str], ...]:
    """Return each `${...}` in a text and what to write for it, as the code XACRO_EXPRESSION says it."""
    found = XACRO_EXPRESSION.finditer(text)
    return tuple({"text": each[0], "ours": f"$({each['within'].strip()})"} for each in found)
