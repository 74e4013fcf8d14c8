"""Lay out what hovers show, in Markdown."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path

from linkforge_compile.source import SourceFile

RULE = "\n\n---\n\n"

MAX_SHOWN = 6
"""How many uses, copies or parts of one kind are shown."""


def code_block(lines: Iterable[str], language: str = "text") -> str:
    """Return lines as they are; "" for none."""
    text = "\n".join(lines)
    return f"```{language}\n{text}\n```" if text else ""


def bullets(items: Iterable[str]) -> str:
    return "\n".join(f"- {item}" for item in items if item)


def code(text: str) -> str:
    """Return a text on one line that Markdown does not interpret."""
    text = text.replace("\n", " ")
    return f"`` {text} ``" if "`" in text else f"`{text}`"


def and_more(count: int) -> str:
    """Return the line for what is not shown; "" if there is nothing."""
    return f"… and {count} more" if count > 0 else ""


def seen_from(folder: Path, text: str, sources: Iterable[SourceFile]) -> str:
    """Return a text in which the names of files are relative to a folder."""
    names = {one.shown: os.path.relpath(one.path, folder) for one in sources if one.path and one.shown in text}
    for name in sorted(names, key=len, reverse=True):
        text = re.sub(rf"(?<![\w./-]){re.escape(name)}", names[name].replace("\\", r"\\"), text)
    return text
