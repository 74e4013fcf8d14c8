"""Edits that format a text."""

from __future__ import annotations

from lsprotocol import types

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.formatter import format_source
from linkforge_compile.lsp.changes import edits_to
from linkforge_compile.lsp.workspace import Document


def format_edits(document: Document) -> list[types.TextEdit]:
    """Return the edits that format a text; none if it is not YAML."""
    formatted = format_source(document.file, Diagnostics())
    return [] if formatted is None else edits_to(formatted, document)
