"""Values of expressions in raw XML: whatever a value holds, it is text there, and no markup."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from linkforge_compile.expressions.types import PathText

_REFERENCES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&apos;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
)

_BEGIN = re.compile(r"<!--|<!\[CDATA\[")
_END_OF_COMMENT = re.compile("-->")
_END_OF_CDATA = re.compile(r"\]\]>")
_END = {"<!--": _END_OF_COMMENT, "<![CDATA[": _END_OF_CDATA}
_LONGEST_PART = len("<![CDATA[") - 1


def values_in_xml(texts: Iterable[tuple[str, bool]]) -> Iterator[str]:
    """Yield the texts that stand behind one another in raw XML, those that are values as it says them.

    Values are escaped, but in comments, which know no escapes: what would end one is put out of action.
    """
    awaited, behind = _BEGIN, ""
    for text, is_value in texts:
        said = _in_xml(text, awaited) if is_value else text
        yield said
        awaited, behind = _read(behind + said, awaited)


def _in_xml(value: str, awaited: re.Pattern[str]) -> str:
    if isinstance(value, PathText):
        return PathText(_in_xml(str(value), awaited), _in_xml(value.from_compiled, awaited))
    if awaited is _END_OF_COMMENT:
        return value.replace("--", "- -").replace("--", "- -").replace(">", "&gt;")
    escaped = value.translate(_REFERENCES)
    return f"]]>{escaped}<![CDATA[" if awaited is _END_OF_CDATA else escaped


def _read(text: str, awaited: re.Pattern[str]) -> tuple[re.Pattern[str], str]:
    """Return what ends the comment or CDATA that is open behind text, or begins the next, and a part of that mark."""
    position = 0
    while found := awaited.search(text, position):
        position = found.end()
        awaited = _END.get(found[0], _BEGIN)
    return awaited, text[max(position, len(text) - _LONGEST_PART) :]
