"""Format a text, and compare what is read of it before and after."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import zip_longest

import yaml
from yaml.events import Event

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.syntax import UNSAFE_FORMAT
from linkforge_compile.diagnostics.sink import BeyondLimitError
from linkforge_compile.formatter.layout import lay_out
from linkforge_compile.formatter.pieces import LINE_BREAK, Piece, UnsafeError, scan, split
from linkforge_compile.source import SourceFile
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER
from linkforge_compile.syntax import read
from linkforge_compile.syntax.parser import MAX_READ_TWICE, PARSER, Marks, Parser, limited_events

_MAX_PASSES = 10
"""A pass may move columns apart that were aligned before it, and the next one then ends their alignment."""

_READ = ("anchor", "tag", "implicit", "value", "style", "flow_style", "explicit", "version", "tags")
"""The attributes of events that make a difference."""


def format_text(text: str) -> str:
    """Return the text of a spec formatted; the text itself if it cannot be formatted."""
    formatted = format_source(SourceFile("<text>", text), Diagnostics())
    return text if formatted is None else formatted


def format_source(file: SourceFile, sink: Diagnostics) -> str | None:
    """Return the text of a file formatted, with the byte order mark and the kind of line ends that it has.

    None if it is not YAML, or if formatting would change more than white space, which is reported.
    """
    found = None if FORBIDDEN_CHARACTER.search(file.counted) else _parse(file.counted)
    if found is None:
        try:
            read(file, sink)
        except BeyondLimitError as beyond:
            sink.abort(beyond)
        return None
    parser, before = found
    text = LINE_BREAK.sub("\n", file.counted)
    try:
        formatted = _format_until_stable(text, parser)
        changed = _first_change(before, yaml.parse(formatted, Loader=parser)) if formatted != text else None
    except (UnsafeError, yaml.YAMLError):
        changed = before[0]
    if changed is not None:
        sink.report(UNSAFE_FORMAT.at(Marks(file).event(changed)))
        return None
    first_break = LINE_BREAK.search(file.counted)
    if first_break and first_break[0] == "\r\n":
        formatted = formatted.replace("\n", "\r\n")
    return file.text.removesuffix(file.counted) + formatted


def _parse(text: str) -> tuple[Parser, list[Event]] | None:
    """Return the first parser that reads a text, and its events; None if it is not YAML."""
    # As in the reader: what libyaml rejects, PyYAML's slow parser may accept.
    for parser in (PARSER, yaml.BaseLoader) if len(text) <= MAX_READ_TWICE else (PARSER,):
        try:
            return parser, list(limited_events(text, parser))
        except yaml.YAMLError:
            continue
    return None


def _format_until_stable(text: str, parser: Parser) -> str:
    """Return the text formatted; UnsafeError if that would move a comment to another token or line."""
    pieces = first = list(split(text, scan(text, parser)))
    for _ in range(_MAX_PASSES):
        before, text = text, lay_out(pieces)
        if text == before:
            break
        pieces = list(split(text, scan(text, parser)))
    if text != before or _comments(pieces) != _comments(first):
        raise UnsafeError
    return text


def _comments(pieces: Iterable[Piece]) -> list[tuple[int, bool, str]]:
    """Return the comments, each with the number of tokens before it and whether it is on its own line."""
    return [
        (number, one.is_own_line, one.text) for number, piece in enumerate(pieces) for one in piece.gap.lines if one
    ]


def _first_change(before: Iterable[Event], after: Iterable[Event]) -> Event | None:
    """Return the first event that is another one after formatting, None if all are the same."""
    pairs = zip_longest(before, after)
    return next((one or other for one, other in pairs if not (one and other and _read(one) == _read(other))), None)


def _read(event: Event) -> tuple[object, ...]:
    # To PyYAML's slow parser, the style of a list with its dashes below the key is None, and of others False.
    return (type(event), *(getattr(event, name, None) or None for name in _READ))
