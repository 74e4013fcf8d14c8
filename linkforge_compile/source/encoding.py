"""The bytes of an XML file as text, in the encoding that the file says."""

from __future__ import annotations

import codecs
import re

from linkforge_compile.source.file import SourceFile
from linkforge_compile.source.span import Span

_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))
_DECLARED = re.compile(rb"""<\?xml\s(?:(?!\?>).)*?encoding\s*=\s*["']([A-Za-z0-9._-]+)["']""", re.DOTALL)
_SEARCHED = 4096
"""A declaration is looked for in so many bytes: some generators write a comment before it."""

_BEGINS = re.compile(rb"(?:\xef\xbb\xbf|\xff\xfe|\xfe\xff)?[\s\x00]*<\x00?[?!A-Za-z_]")
"""XML behind a byte order mark and blanks; the merge key of YAML, which begins with `<` too, is none."""

# Names as Python has them. Not every codec: there are those that are no encodings of text, and those that unpack.
_KNOWN = frozenset(
    (
        *("utf-8", "utf-16", "utf-16-le", "utf-16-be", "ascii", "iso8859-1", "iso8859-2", "iso8859-15"),
        *("cp1250", "cp1251", "cp1252", "koi8-r", "gb2312", "gbk", "gb18030", "big5", "shift_jis", "euc_jp", "euc_kr"),
    )
)


_TWO_BYTES = ("utf-16", "utf-16-le", "utf-16-be")
_WAY_OUT = (
    "save the file as UTF-8, or declare the encoding that it has, as in <?xml version='1.0' encoding='iso-8859-1'?>"
)


class EncodingError(Exception):
    """The bytes are no text in the encoding that they are said to be; says why, and of which byte if of one."""

    def __init__(self, reason: str, undecoded: UnicodeDecodeError | None = None) -> None:
        self.undecoded = undecoded
        super().__init__(reason)


def place_of_byte(error: UnicodeDecodeError, name: str) -> Span:
    """Return where the byte stands that a decoder refused, in a file of that name that shows what can be read of it."""
    before, text = (data.decode(error.encoding, "replace") for data in (error.object[: error.start], error.object))
    lines = before.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    line, column = len(lines), len(lines[-1]) + 1
    return Span(SourceFile(name, text), line, column, line, column + 1)


def begins_xml(data: bytes | str) -> bool:
    """Whether a file is XML, whatever its name, by how it begins."""
    if isinstance(data, str):
        data = data[:_SEARCHED].encode("utf-8", errors="replace")
    return _BEGINS.match(data) is not None


def xml_text(data: bytes) -> str:
    """Return the bytes of an XML file as text, without byte order mark; UTF-8 where the file says nothing."""
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            return _decoded(data.removeprefix(mark), encoding)
    declared = _DECLARED.search(data[:_SEARCHED])
    encoding = declared[1].decode("ascii") if declared else "utf-8"
    if encoding.lower() in _TWO_BYTES:
        # Each letter of the declaration was one byte.
        raise EncodingError(f"it declares the encoding {encoding}, which it is not in; write encoding='utf-8'")
    return _decoded(data, encoding)


def _decoded(data: bytes, encoding: str) -> str:
    try:
        known = codecs.lookup(encoding).name
    except LookupError:
        known = ""
    if known not in _KNOWN:
        raise EncodingError(f"there is no encoding '{encoding}' of text here")
    try:
        return data.decode(known)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        reason = f"line {line} has the byte {data[error.start]:#04x}, which is not {encoding}; {_WAY_OUT}"
        raise EncodingError(reason, error) from error
