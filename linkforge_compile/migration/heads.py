"""The name of a spec, and the comments with which it begins."""

from __future__ import annotations

import re
from pathlib import Path

from linkforge_compile.source.xml_tree import XmlElement


def stem_of(path: Path) -> str:
    """Return the name of the spec of a xacro, without its ending."""
    name = path.name
    for suffix in (".xacro", ".urdf", ".xml"):
        name = name.removesuffix(suffix)
    return name


def comments_above(root: XmlElement | None) -> list[str]:
    """Return the comments above the root of a file, such as its license."""
    return re.findall(r"<!--\s*(.*?)\s*-->", root.file.text[: root.begin], re.DOTALL) if root else []


def as_comment(text: str) -> str:
    """Return a text as a comment that begins a spec."""
    lines = (f"# {line.strip()}".rstrip() for line in text.splitlines())
    return "".join(f"{line}\n" for line in lines) + "\n" * bool(text)
