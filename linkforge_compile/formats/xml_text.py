"""Values as text of XML: spelled as URDF spells them, and escaped."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from operator import methodcaller
from typing import TypeAlias, TypeGuard

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.units import double_text, number_text

# No XML 1.0 document may hold these, not even as a reference.
_CONTROLS, _BEYOND_ASCII = "\x00-\x08\x0b\x0c\x0e-\x1f", "\ud800-\udfff\ufffe\uffff"
_UNWRITABLE = re.compile(f"[{_CONTROLS}{_BEYOND_ASCII}]")
_TO_ESCAPE = re.compile(f'[&<>"\t\n\r{_CONTROLS}{_BEYOND_ASCII}]')
_REFERENCES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
)
_REFERENCES_IN_RAW_TEXT = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", "\r": "&#13;"})

# A letter or `_`, and then digits, `-` and `.` as well. Written as what of ASCII is none of these: compiling ranges of
# the characters beyond it takes a fifth of a whole compile.
_LOCAL_NAME = r"[^\x00-@\[-^`{-\x7f][^\x00-,/:-@\[-^`{-\x7f]*"
_XML_NAME = re.compile(rf"(?:{_LOCAL_NAME}:)?{_LOCAL_NAME}")

_MOST_SHOWN = 80
"""Characters of raw XML that a message quotes."""


class RawXmlError(RobotGeneratorError):
    """Raw XML that cannot be read: `problem` is what is wrong at the index `at` of `text`.

    `begun` is the index of the element that is not closed, None for other faults.
    """

    def __init__(self, problem: str, text: str, at: int, begun: int | None = None) -> None:
        self.problem, self.text, self.at, self.begun = problem, text, at, begun
        super().__init__(f"{problem}, in line {text.count(chr(10), 0, at) + 1} of {shown(text)}")


def shown(text: str) -> str:
    """Return raw XML as a message quotes it."""
    return repr(text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}…")


RESERVED = f"linkforge-{os.urandom(8).hex()}:"
"""Begins the names of attributes and elements that the writer of a document removes.

It is random in each process, so that no author writes it.
"""

KEEPS_SPACE = f' {RESERVED}space="preserve"'
"""An attribute, not written, of an element whose blank texts are no layout."""

XML_BLANKS = " \t\r\n"
"""White space by the rules of XML; for Python, a no-break space is white space as well."""


class Xml(str):
    """Text that is XML already; templates write it unchanged."""

    __slots__ = ()

    def __html__(self) -> Xml:
        """Return the text itself: what MarkupSafe, and so Jinja2, asks of what is escaped already."""
        return self


NOTHING = Xml()
"""Where a part of the robot is not stated."""

Spellable: TypeAlias = str | float | bool | Iterable[float]
"""What an attribute or a text may be: words, a number, yes or no, or numbers with spaces between them."""

_item: Callable[[object], float | bool] = methodcaller("item")
"""Makes of a value of NumPy that of Python."""


def is_of_numpy(value: object) -> TypeGuard[float]:
    """Whether it is a number or a boolean of NumPy, alone or as an array without dimensions."""
    return getattr(value, "ndim", None) == 0


def spelled(value: Spellable) -> str:
    """Return a value as the text that URDF writes, not escaped yet."""
    if value.__class__ is Vector3:
        x, y, z = value.x, value.y, value.z
        if x.__class__ is y.__class__ is z.__class__ is float:
            return f"{double_text(x)} {double_text(y)} {double_text(z)}"
    if isinstance(value, str):
        return value
    if is_of_numpy(value):
        value = _item(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if not isinstance(value, Iterable):
        return number_text(value)
    return " ".join(map(number_text, value))


def escaped(text: str) -> str:
    """Return text as it is written in an attribute or between tags.

    Raises:
        RobotGeneratorError: for a character that XML 1.0 cannot hold.

    """
    if text.isidentifier() or _TO_ESCAPE.search(text) is None:  # names mostly, which Python knows at once
        return text
    require_writable(text)
    return text.translate(_REFERENCES)


def raw_text(text: str) -> str:
    """Return text between tags, with its line breaks and quotes as they are.

    Raises:
        RobotGeneratorError: for a character that XML 1.0 cannot hold.

    """
    if _TO_ESCAPE.search(text) is None:
        return text
    require_writable(text)
    return text.translate(_REFERENCES_IN_RAW_TEXT)


def element_text(tag: str, attributes: Iterable[tuple[str, str]], content: str, note: str = "") -> str:
    """Return an element; blank content is kept as text. `note` are attributes that are written already."""
    start = "".join([f"<{tag}{note}", *(f' {name}="{escaped(value)}"' for name, value in attributes)])
    if not content:
        return f"{start}/>"
    if is_xml_blank(content) and KEEPS_SPACE not in note:
        start += KEEPS_SPACE
    return f"{start}>{content}</{tag}>"


def is_xml_blank(text: str) -> bool:
    """Whether a text is empty, or white space by the rules of XML."""
    return not text.strip(XML_BLANKS)


def is_writable(text: str) -> bool:
    """Whether XML can hold all of a text."""
    return _UNWRITABLE.search(text) is None


def require_writable(text: str) -> None:
    """Refuse a character that XML 1.0 cannot hold.

    Raises:
        RobotGeneratorError: with the character and the text.

    """
    if found := _UNWRITABLE.search(text):
        raise RobotGeneratorError(f"XML cannot hold the character U+{ord(found[0]):04X}, found in {text!r}")


def is_xml_name(name: str) -> bool:
    """Tell whether an element or an attribute may have this name, with a namespace prefix or without."""
    return _XML_NAME.fullmatch(name) is not None and (name.isascii() or _is_read_by_all(name))


def _is_read_by_all(name: str) -> bool:
    # Beyond ASCII, XML 1.0 allows fewer names in its fourth edition than in its fifth. expat, and with it xacro and
    # Python's own parsers, keeps to the fourth, so a name of the fifth would be lost on them.
    from linkforge_compile.source.malformed_xml import find_xml_error

    return is_writable(name) and all(find_xml_error(f"<{local}/>") is None for local in name.split(":"))


def harmless_in_comment(text: str) -> str:
    """Return text without what would end a comment, or what XML cannot hold."""
    return _UNWRITABLE.sub("?", text).replace("--", "- -").replace("--", "- -")
