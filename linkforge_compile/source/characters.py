"""Characters and encodings: what files may hold, and escapes for what messages cannot show."""

from __future__ import annotations

import codecs
import re

# Characters that YAML or XML refuses or that they count differently: U+0085, U+2028 and U+2029 are line breaks to YAML
# 1.1 parsers but not to editors and YAML 1.2, so that all line numbers after one would be wrong.
FORBIDDEN_CHARACTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\x80-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]")
"""Matches a control character, a lone surrogate, a stray byte order mark, or a line separator of Unicode."""

LIKE_SPACES = re.compile(r"[ \t]*([\u00a0\u2000-\u200b\u202f\u3000])")
"""Matches what looks like a space at the start of a line but does not indent, such as a no-break space."""


def code_point(character: str) -> str:
    """Return the name of a character that cannot be seen: U+00A0."""
    return f"U+{ord(character):04X}"


def on_one_line(text: str) -> str:
    """Return the text with escapes for line ends, control characters and bytes that are not UTF-8.

    Messages quote the contents and names of untrusted files.
    """
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else each.encode("unicode_escape").decode() for each in text)


_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))
_DECLARED = re.compile(rb"""<\?xml\s(?:(?!\?>).)*?encoding\s*=\s*["']([A-Za-z0-9._-]+)["']""", re.DOTALL)
_SEARCHED = 4096
"""How many bytes are searched for a declaration: some generators write a comment before it."""

_BEGINS = re.compile(rb"(?:\xef\xbb\xbf|\xff\xfe|\xfe\xff)?[\s\x00]*<\x00?[?!A-Za-z_]")
"""Matches XML after a byte order mark and blanks, but not the merge key of YAML, which begins with `<` too."""

# Names as Python has them. Not every codec: some are no encodings of text, and some decompress.
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


# XML allows a declaration at the very start only; generated files have comments and blank lines before it.
_DECLARATION = re.compile(r"(?:\s|<!--(?:(?!-->).)*-->)*(<\?xml\s(?:(?!\?>).)*\?>)", re.DOTALL)


class UnreadableError(Exception):
    """Bytes that cannot be read as text; `undecoded` is the error at the first wrong byte, None for other reasons."""

    def __init__(self, reason: str, undecoded: UnicodeDecodeError | None = None) -> None:
        self.undecoded = undecoded
        super().__init__(reason)


def begins_xml(data: bytes | str) -> bool:
    """Whether a file begins as XML, whatever its name."""
    if isinstance(data, str):
        data = data[:_SEARCHED].encode("utf-8", errors="replace")
    return _BEGINS.match(data) is not None


def text_of(data: bytes) -> str:
    """Return the text of a file: XML in the encoding that it declares, anything else in UTF-8.

    Raises:
        UnreadableError: if the bytes are not in the encoding.

    """
    if begins_xml(data):
        return xml_text(data)
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            raise UnreadableError("it is UTF-16, as PowerShell writes; save it as UTF-8") from error
        line = data.count(b"\n", 0, error.start) + 1
        reason = f"it is not UTF-8: line {line} has the byte {data[error.start]:#04x}; save it as UTF-8"
        raise UnreadableError(reason, error) from error


def xml_text(data: bytes) -> str:
    """Return the text of an XML file without byte order mark; UTF-8 if the file declares no encoding.

    Raises:
        UnreadableError: if the bytes are not in the encoding.

    """
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            return _decoded(data.removeprefix(mark), encoding)
    declared = _DECLARED.search(data[:_SEARCHED])
    encoding = declared[1].decode("ascii") if declared else "utf-8"
    if encoding.lower() in _TWO_BYTES:
        # Each letter of the declaration was one byte.
        raise UnreadableError(f"it declares the encoding {encoding}, which it is not in; write encoding='utf-8'")
    return _decoded(data, encoding)


def _decoded(data: bytes, encoding: str) -> str:
    try:
        known = codecs.lookup(encoding).name
    except LookupError:
        known = ""
    if known not in _KNOWN:
        raise UnreadableError(f"there is no encoding '{encoding}' of text here")
    try:
        return data.decode(known)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        reason = f"line {line} has the byte {data[error.start]:#04x}, which is not {encoding}; {_WAY_OUT}"
        raise UnreadableError(reason, error) from error


def without_declaration(text: str) -> str:
    """Return the text with blanks in place of its XML declaration, because it is decoded already."""
    found = _DECLARATION.match(text)
    if found is None:
        return text
    blank = re.sub(r"[^\r\n]", " ", found[1])
    return text[: found.start(1)] + blank + text[found.end(1) :]
