"""What is wrong with a text that is no XML, in the words of whoever wrote it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple
from xml.parsers.expat import ErrorString, errors

_CONFLICT = re.compile(r"^(?:<{7}|>{7}) ", re.MULTILINE)
_REFERENCE = re.compile(r"&[\w.-]*\Z")
_NAME = re.compile(r"[^\s/<>\"']+")
_MOST_SHOWN = 40
_BEFORE_VALUE = re.compile(r"<[^\s<>!?/][^<>]*=\s*")


class Malformed(NamedTuple):
    """What is wrong, the offset at which it is, and whether that is that an element is not closed."""

    problem: str
    at: int
    is_open: bool = False


def malformed(code: int, text: str, at: int, open_tags: Sequence[str]) -> Malformed:
    """Return what is wrong where a parser gave up, with the elements that are open there, the innermost last.

    What is not certain stays as the parser says it.
    """
    if not text.strip():
        return Malformed("the file is empty", 0)
    known, innermost = ErrorString(code), _shown(open_tags[-1]) if open_tags else None
    if known == errors.XML_ERROR_INVALID_TOKEN and (fault := _of_invalid_token(text, at)):
        return fault
    if known == errors.XML_ERROR_UNCLOSED_TOKEN:
        what = "comment" if text.startswith("<!--", at) else "tag"
        return Malformed(f"this {what} is not closed", at)
    if known == errors.XML_ERROR_UNCLOSED_CDATA_SECTION:
        return Malformed("this CDATA is not closed; it ends with ']]>'", text.rfind("<![CDATA[", 0, at))
    if known == errors.XML_ERROR_TAG_MISMATCH and (name := _NAME.match(text, at)):
        found = f"</{_shown(name[0])}>"
        if innermost is None:
            return Malformed(f"{found} closes nothing that is open", at)
        return Malformed(f"expected </{innermost}>, found {found}", at, is_open=True)
    if innermost and known in (errors.XML_ERROR_NO_ELEMENTS, errors.XML_ERROR_TAG_MISMATCH):
        return Malformed(f"it ends before </{innermost}>", at, is_open=True)
    if known == errors.XML_ERROR_NO_ELEMENTS:
        return Malformed("there is no element in it", at)
    if known == errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT:
        return Malformed("it has one element, behind which nothing but comments may stand", at)
    return Malformed("invalid token" if known == errors.XML_ERROR_INVALID_TOKEN else known, at)


def _of_invalid_token(text: str, at: int) -> Malformed | None:
    before = text[:at]
    line = before.rfind("\n") + 1
    if _CONFLICT.match(text, line):
        return Malformed("this line is one that git leaves of a merge conflict; keep one of the two sides", line)
    if before.rfind("<!--") > before.rfind("-->"):
        is_second = before.endswith("--")
        return Malformed("a comment holds no '--'", at - 2) if is_second else None
    if reference := _REFERENCE.search(before, line):
        return Malformed("'&' by itself is written '&amp;'", reference.start())
    tag = before[max(before.rfind("<"), 0) :]
    if tag.count('"') % 2:
        found = "the value of an attribute holds no '<'; close its quote, or write '&lt;'"
        return Malformed(found, at) if text.startswith("<", at) else None
    value = _NAME.match(text, at)
    if value and _BEFORE_VALUE.fullmatch(tag):
        return Malformed(
            f"the value of an attribute stands in quotes; write '\"{_shown(value[0].strip('“”‘’'))}\"'", at
        )
    return None


def _shown(name: str) -> str:
    return name if len(name) <= _MOST_SHOWN else f"{name[:_MOST_SHOWN]}..."
