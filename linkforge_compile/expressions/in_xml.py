"""Values of expressions in raw XML: whatever a value holds, it is text there, and no markup."""

from __future__ import annotations

from linkforge_compile.expressions.types import PathText

_REFERENCES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&apos;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
)


def in_xml(value: str, before: str) -> str:
    """Return the text of a value as raw XML says it behind what the author wrote before: escaped, but for comments.

    A comment knows no escapes; what would end it is put out of action.
    """
    if isinstance(value, PathText):
        return PathText(in_xml(str(value), before), in_xml(value.from_compiled, before))
    if _is_inside(before, "<!--", "-->"):
        return value.replace("--", "- -").replace("--", "- -").replace(">", "&gt;")
    escaped = value.translate(_REFERENCES)
    return f"]]>{escaped}<![CDATA[" if _is_inside(before, "<![CDATA[", "]]>") else escaped


def _is_inside(before: str, opening: str, closing: str) -> bool:
    """Whether text ends inside of what begins and ends with these; in XML neither kind lies in the other."""
    return before.rfind(opening) > before.rfind(closing)
