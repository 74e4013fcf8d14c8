"""The comments with which a spec begins."""

from __future__ import annotations

import re

from linkforge_compile.source.xml_tree import XmlElement


def comments_above(root: XmlElement | None) -> list[str]:
    """Return the comments above the root of a file, such as its license."""
    return re.findall(r"<!--\s*(.*?)\s*-->", root.file.text[: root.begin], re.DOTALL) if root else []


def as_comment(text: str) -> str:
    """Return a text as a comment that begins a spec."""
    lines = (f"# {line.strip()}".rstrip() for line in text.splitlines())
    return "".join(f"{line}\n" for line in lines) + "\n" * bool(text)
