"""What newcomers write as xacro has it: `${length / 2}`, which is `$(length / 2)` here."""

from __future__ import annotations

import re

XACRO_EXPRESSION = re.compile(r"\$\{(?P<within>[^{}\r\n]*)\}")


def xacro_facts(text: str) -> dict[str, str] | None:
    """Return the first `${...}` in a text and what to write for it, as the code XACRO_EXPRESSION says it, or None."""
    found = XACRO_EXPRESSION.search(text)
    return {"text": found[0], "ours": f"$({found['within'].strip()})"} if found else None
