"""Where a value of a finished robot was written, as a spec's author tells places apart."""

from __future__ import annotations

from typing import NamedTuple

from linkforge_compile.expand.defaults import is_default
from linkforge_compile.source import Span


class Place(NamedTuple):
    """Where a value was written; `is_default` in the `defaults` of a file."""

    span: Span
    is_default: bool


def place_of(span: Span) -> Place:
    return Place(span, is_default(span))
