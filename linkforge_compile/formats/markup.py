"""Text as XML: escaped, and laid out.

Whatever leaves this module is one tag a line, or one element with its text a line: line ends inside of texts
become character references, and in raw XML signs that stand for them until all lines are where they belong; so that
a document can be indented, or not, without touching what it says.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from operator import methodcaller
from typing import TypeAlias, TypeGuard

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.formats.marks import mark, recorded
from linkforge_compile.source import SourceRef
from linkforge_compile.units import double_text, number_text

_EMPTY = re.compile(r"<(([^\s<>/]++)[^<>]*+)(?<!/)></\2>")

_BREAK_IN_TAG = re.compile(r"""(?P<value>"[^"]*"|'[^']*')|\s*\n\s*""")

# No XML 1.0 document may hold these, not even as a reference.
_CONTROLS, _BEYOND_ASCII = "\x00-\x08\x0b\x0c\x0e-\x1f", "\ud800-\udfff\ufffe\uffff"
_UNWRITABLE = re.compile(f"[{_CONTROLS}{_BEYOND_ASCII}]")
_MARKED = re.compile(f'[&<>"\t\n\r{_CONTROLS}{_BEYOND_ASCII}]')
_REFERENCES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
)

_MARKED_IN_TEXT = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", "\r": "&#13;"})
_LINE_END, _LESS_THAN = "\x01", "\x02"
_STAND_INS = str.maketrans({"\n": _LINE_END, "<": _LESS_THAN})

# A letter or `_`, and then digits, `-` and `.` as well. Written as what of ASCII is none of these: ranges of what is
# beyond it take a fifth of a whole compile to be made ready.
_LOCAL_NAME = r"[^\x00-@\[-^`{-\x7f][^\x00-,/:-@\[-^`{-\x7f]*"
_XML_NAME = re.compile(rf"(?:{_LOCAL_NAME}:)?{_LOCAL_NAME}")


MARK = "\x00"
"""Begins a line that is no XML, and that none can be taken for: what `extra_inside` says of the element around it."""


_PIECE = re.compile(
    rf"""^{MARK}[^\n]*$|<!--.*?-->|<\?.*?\?>|(?P<text>(?:[^<{MARK}]++|<!\[CDATA\[.*?\]\]>)++)"""
    r"""|(?P<tag><(?:[^<>"']++|"[^"]*+"|'[^']*+')*+>)""",
    re.MULTILINE | re.DOTALL,
)
"""A line that is no XML, a comment, an instruction, a text with the CDATA in it, or a tag."""

_MARK_LINE = re.compile(f"^{MARK}.*$", re.MULTILINE)


class Xml(str):
    """Text that is XML already; templates write it as it stands."""

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
    """Whether it is a number or a truth of NumPy, alone or as an array without dimensions."""
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


def placed(text: str, source: SourceRef | None, *path: str | int) -> str:
    """Return text for a template, marked with where it was written: under a path of an object."""
    # An element without content closes itself, so an empty text stays empty.
    return Xml(mark(source, *path) + escaped(text)) if text and recorded() else text


def escaped(text: str) -> str:
    """Return text as it stands in an attribute or between tags.

    Raises:
        RobotGeneratorError: for a character that XML 1.0 cannot hold.

    """
    if text.isidentifier() or _MARKED.search(text) is None:  # names mostly, which Python knows at once
        return text
    require_writable(text)
    return text.translate(_REFERENCES)


def verbatim_text(text: str) -> Xml:
    """Return text between tags that keeps its lines: what is on one here `restored` breaks up again.

    Raises:
        RobotGeneratorError: for a character that XML 1.0 cannot hold.

    """
    if _MARKED.search(text) is None:
        return Xml(text)
    require_writable(text)
    return Xml(text.translate(_MARKED_IN_TEXT).translate(_STAND_INS))


def verbatim_comment(text: str) -> Xml:
    """Return a comment as it stands, on one line until it is `restored`; no tag in it is taken for one."""
    return Xml(f"<{f'!--{text}-->'.translate(_STAND_INS)}")


def restored(text: str) -> str:
    """Return a document, or a line of one, with the lines that its raw XML had."""
    return text.replace(_LINE_END, "\n").replace(_LESS_THAN, "<")


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
    from linkforge_compile.source.malformed_xml import fault_of

    return is_writable(name) and all(fault_of(f"<{local}/>") is None for local in name.split(":"))


def harmless_in_comment(text: str) -> str:
    """Return text without what would end a comment, or what XML cannot hold."""
    return _UNWRITABLE.sub("?", text).replace("--", "- -").replace("--", "- -")


INDENT = "  "
"""What a line of a document stands further in than the one around it."""


def document_text(text: str, *, pretty: bool) -> str:
    """Return what a template rendered, a tag or an element a line, as an indented document, or on one line.

    Comments and texts of raw XML keep their lines either way; while a map is recorded, whoever takes its marks out
    breaks them.
    """
    lines = laid_out(text)
    if MARK in text:
        from linkforge_compile.formats.inside import with_insides

        lines = laid_out(with_insides("\n".join(lines)))
    lines = [_EMPTY.sub(r"<\1/>", line) if "></" in line else line for line in lines]
    if not pretty:
        # Text on several lines would run together.
        lines = [line.lstrip(INDENT) + ("" if line.endswith(">") else "\n") for line in lines]
    text = ("\n" if pretty else "").join(lines)
    return text if recorded() else restored(text)


def with_layout_alone(text: str) -> str:
    """Return XML of a user's with a tag on one line, and signs for the line breaks of what `laid_out` must not touch.

    That is all but white space between tags: comments, CDATA, and texts that have more than one line.
    """
    return _PIECE.sub(_on_one_line, text)


def _on_one_line(piece: re.Match[str]) -> str:
    text = piece[0]
    if text[0] == MARK or ("\n" not in text and "<" not in text[1:]):
        return text
    if piece["tag"]:
        return _BREAK_IN_TAG.sub(lambda found: found[0].replace("\n", " ") if found["value"] else " ", text)
    if piece["text"]:
        return text.translate(_STAND_INS) if text.strip() else text
    return f"<{text[1:].translate(_STAND_INS)}"


def laid_out(text: str) -> list[str]:
    """Return the lines of a text indented, each an opening tag, a closing tag, or something whole.

    An element without content closes itself.
    """
    lines: list[str] = []
    begun: list[int] = []
    for line in filter(None, map(str.strip, text.split("\n"))):
        if not is_closing(line) or not begun:
            lines.append(INDENT * len(begun) + line)
            if is_opening(line):
                begun.append(len(lines))
        elif begun.pop() == len(lines) and _is_one_tag(lines[-1]) and _is_one_tag(line):
            lines[-1] = f"{lines[-1][:-1]}/>"
        else:
            lines.append(INDENT * len(begun) + line)
    return lines


def _is_one_tag(line: str) -> bool:
    """Whether a line is a tag and nothing else; one with a `>` in an attribute may be taken for more."""
    return line[-1] == ">" and line.count("<") == 1 and line.count(">") == 1


def without_marks(text: str) -> str:
    """Return what a template rendered as XML: without the lines that are none, and with the signs of raw XML."""
    return restored(_MARK_LINE.sub("", text))


def is_closing(line: str) -> bool:
    """Whether a line ends an element that an earlier one began."""
    return line.startswith("</")


def is_opening(line: str) -> bool:
    """Whether a line begins an element that a later one ends."""
    return line[0] == "<" and line[1:2] not in "!?" and line[-2] != "/" and "</" not in line
