"""Convert places in texts to ranges of the protocol and back, and paths to URIs.

Our lines and columns count from 1, columns in characters; the protocol's count from 0, columns in the unit on which
client and server agree: UTF-16 code units unless the client offers another one.
"""

from __future__ import annotations

import os
from pathlib import Path

from lsprotocol import types
from pygls import uris
from pygls.workspace import PositionCodec

from linkforge_compile.diagnostics import Severity
from linkforge_compile.source import Position, SourceFile, Span

SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.NOTE: types.DiagnosticSeverity.Information,
}


def uri_of(path: Path) -> str:
    """Return the `file:` URI of a path, with its links as written."""
    # Path.absolute would keep the `..` that the user wrote.
    return str(uris.from_fs_path(os.path.abspath(path)))  # noqa: PTH100


def path_of(uri: str) -> Path | None:
    """Return the path of a `file:` URI; None for another one, such as `untitled:`."""
    path = uris.to_fs_path(uri) if uris.uri_scheme(uri) == "file" else None
    return None if path is None or "\0" in path else Path(path)


class Columns:
    """Converts places for one client; `codec` knows its unit of columns."""

    def __init__(self, codec: PositionCodec) -> None:
        self._codec = codec

    def position(self, file: SourceFile, at: Position) -> types.Position:
        """Return the protocol's position of a place in a file."""
        line = file.line(at.line)
        # Only text beyond ASCII is counted: a generated spec may have thousands of places in one line.
        if line.isascii():
            return types.Position(at.line - 1, min(at.column - 1, len(line)))
        return types.Position(at.line - 1, self._codec.client_num_units(line[: at.column - 1]))

    def range(self, span: Span) -> types.Range:
        """Return the protocol's range of a span."""
        return types.Range(self.position(span.file, span.start), self.position(span.file, span.end))

    def location(self, span: Span) -> types.Location | None:
        """Return the protocol's location of a span; None for a text that is no file."""
        return types.Location(uri_of(span.file.path), self.range(span)) if span.file.path else None

    def place(self, file: SourceFile, at: types.Position) -> Position:
        """Return the place of a position of the protocol; the end of its line for one beyond it."""
        line, units = file.line(at.line + 1), 0
        if line.isascii():
            return Position(at.line + 1, min(at.character, len(line)) + 1)
        for column, character in enumerate(line, start=1):
            if units >= at.character:
                return Position(at.line + 1, column)
            units += self._codec.client_num_units(character)
        return Position(at.line + 1, len(line) + 1)
