"""Explain what is wrong with malformed XML in the words of its author.

The faults are those of expat, which refuses all that lxml refuses except for its limits.
"""

from __future__ import annotations

import re
from xml.parsers import expat
from xml.parsers.expat import errors

_CONFLICT = re.compile(r"^(?:<{7}|>{7}) ", re.MULTILINE)
_REFERENCE = re.compile(r"&[\w.-]*\Z")
_NAME = re.compile(r"[^\s/<>\"']+")
_MOST_SHOWN = 40
ENDS_BEFORE = "it ends before "
"""Begins the problem of a text that lacks an end tag, which follows."""

_BARE_AMPERSAND = "write '&amp;' for the character '&'"
_BEFORE_VALUE = re.compile(r"<[^\s<>!?/][^<>]*=\s*")


class MalformedXmlError(Exception):
    """What is wrong with a text, and at which offset.

    `begun` is the place of `<tag` of an element that is not closed, None for other faults.
    """

    def __init__(self, problem: str, at: int, begun: tuple[int, int] | None = None) -> None:
        self.problem, self.at, self.begun = problem, at, begun
        super().__init__(problem)


class _DocumentTypeError(Exception):
    """Stops the parser at a document type, whose entities could expand."""


def find_xml_error(text: str, around: str = "", *, is_whole: bool = True) -> MalformedXmlError | None:
    """Return what is wrong with a text inside the tags `around`; None if nothing is, or after a document type.

    With `is_whole` False the text may end anywhere.
    """
    opened: list[tuple[str, int]] = []
    parser = expat.ParserCreate("utf-8")
    parser.StartElementHandler = lambda tag, _: opened.append((tag, parser.CurrentByteIndex))
    parser.EndElementHandler = lambda _: opened.pop()
    parser.StartDoctypeDeclHandler = _stop
    try:
        parser.Parse(around, False)
        outside = len(opened)
        parser.Parse(text, is_whole)
    except _DocumentTypeError:
        return None
    except expat.ExpatError as error:
        known = expat.ErrorString(error.code)
    else:
        return None
    finally:
        parser.StartElementHandler = None  # breaks a reference cycle: the garbage collector may be paused
    data = text.encode()

    def offset(byte: int) -> int:
        return len(data[: byte - len(around)].decode(errors="replace"))

    tag, byte = opened[-1] if len(opened) > outside else ("", len(around))
    begin = offset(byte)
    return _explain(known, text, offset(parser.ErrorByteIndex), tag, (begin, begin + len(tag) + 1))


def _stop(*_: object) -> None:
    raise _DocumentTypeError


def _explain(known: str, text: str, at: int, tag: str, begun: tuple[int, int]) -> MalformedXmlError:
    """Return the fault at which expat stopped, in its own words if the cause is not certain.

    `tag` is the element around the fault, empty outside of all.
    """
    if not text.strip():
        return MalformedXmlError("the file is empty", 0)
    if known == errors.XML_ERROR_INVALID_TOKEN and (fault := _of_invalid_token(text, at)):
        return fault
    if known == errors.XML_ERROR_UNCLOSED_TOKEN:
        if text.startswith("&", at):
            return MalformedXmlError(_BARE_AMPERSAND, at)
        what = "comment" if text.startswith("<!--", at) else "tag"
        return MalformedXmlError(f"this {what} is not closed", at)
    if known == errors.XML_ERROR_UNCLOSED_CDATA_SECTION:
        # A further `<![CDATA[` inside is text.
        begin = text.find("<![CDATA[", text.rfind("]]>", 0, at) + 1)
        return MalformedXmlError("this CDATA is not closed; it ends with ']]>'", begin)
    closing = _NAME.match(text, at) if known == errors.XML_ERROR_TAG_MISMATCH else None
    if closing and not tag:
        return MalformedXmlError(f"</{_shown(closing[0])}> closes no open element", at)
    if tag and known in (errors.XML_ERROR_NO_ELEMENTS, errors.XML_ERROR_TAG_MISMATCH):
        end = f"</{_shown(tag)}>"
        problem = f"expected {end}, found </{_shown(closing[0])}>" if closing else f"{ENDS_BEFORE}{end}"
        return MalformedXmlError(problem, at, begun)
    if known == errors.XML_ERROR_NO_ELEMENTS:
        return MalformedXmlError("there is no element in it", at)
    if known == errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT:
        return MalformedXmlError("only comments may follow the root element", at)
    return MalformedXmlError("invalid token" if known == errors.XML_ERROR_INVALID_TOKEN else known, at)


def _of_invalid_token(text: str, at: int) -> MalformedXmlError | None:
    before = text[:at]
    line = before.rfind("\n") + 1
    if _CONFLICT.match(text, line):
        return MalformedXmlError("this line belongs to a git merge conflict; keep one of the two sides", line)
    if before.rfind("<!--") > before.rfind("-->"):
        is_second = before.endswith("--")
        return MalformedXmlError("'--' is not allowed in a comment", at - 2) if is_second else None
    if reference := _REFERENCE.search(before, line):
        return MalformedXmlError(_BARE_AMPERSAND, reference.start())
    tag = before[max(before.rfind("<"), 0) :]
    if tag.count('"') % 2:
        found = "'<' is not allowed in an attribute value; close its quote, or write '&lt;'"
        return MalformedXmlError(found, at) if text.startswith("<", at) else None
    value = _NAME.match(text, at)
    if value and _BEFORE_VALUE.fullmatch(tag):
        return MalformedXmlError(
            f"an attribute value must be in quotes; write '\"{_shown(value[0].strip('“”‘’'))}\"'", at
        )
    return None


def _shown(name: str) -> str:
    return name if len(name) <= _MOST_SHOWN else f"{name[:_MOST_SHOWN]}..."
