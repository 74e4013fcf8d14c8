"""Recognize XML that xacro is to expand by its content."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import NamedTuple
from xml.parsers import expat

from linkforge_compile.source.characters import UnreadableError, without_declaration, xml_text

DEFINITIONS = frozenset(f"xacro:{tag}" for tag in ("include", "macro", "property", "arg", "if", "unless"))
"""The tags that every xacro has; files that xacro has written may have calls that are left over."""

_SUBSTITUTION = re.compile(r"\$\((?:find|arg|env|optenv)\s")


class XacroContent(NamedTuple):
    """What of a document is for xacro; both are false where the root does not declare the namespace."""

    has_definition: bool = False
    has_substitution: bool = False


class _EnoughReadError(Exception):
    """Stops the parser."""


def find_xacro(content: bytes) -> XacroContent:
    """Return what of a document is for xacro, up to its first definition; nothing of what is no XML."""
    search = _Search()
    parser = expat.ParserCreate("utf-8")
    parser.buffer_text = True
    parser.StartElementHandler = search.begin
    parser.CharacterDataHandler = search.read_text
    parser.StartDoctypeDeclHandler = search.refuse
    # What is malformed is reported by the reader that comes next.
    with suppress(_EnoughReadError, UnreadableError, expat.ExpatError, UnicodeEncodeError):
        parser.Parse(without_declaration(xml_text(content)).encode(), True)
    return XacroContent(search.has_definition, search.has_substitution)


class _Search:
    def __init__(self) -> None:
        self.has_definition = self.has_substitution = False
        self._is_inside = False

    def begin(self, tag: str, attributes: dict[str, str]) -> None:
        if not self._is_inside and "xmlns:xacro" not in attributes:
            raise _EnoughReadError
        self._is_inside = True
        if tag in DEFINITIONS:
            self.has_definition = True
            raise _EnoughReadError
        for value in attributes.values():
            self.read_text(value)

    def read_text(self, text: str) -> None:
        self.has_substitution = self.has_substitution or _SUBSTITUTION.search(text) is not None

    def refuse(self, *_declared: object) -> None:
        """Stop at a document type, whose entities could expand."""
        raise _EnoughReadError
