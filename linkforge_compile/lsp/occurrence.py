"""A name at a place in a text."""

from __future__ import annotations

from typing import NamedTuple

from linkforge_compile.source import Span
from linkforge_compile.syntax import has_expression


class Occurrence(NamedTuple):
    """A name at a place; `name` is the final one, with the prefixes, of which `written` is what the place writes.

    A place in a file that is used several times has an occurrence for each use. The text at the place is another one
    where an expression makes the name. `suffix` is what the name has after what is written: `_joint` for the joint of
    a frame or module that gives it no name. `scope` is where a name of expressions is known, each use of a file being
    the same; "" for the name of a part.
    """

    kind: str
    name: str
    written: str
    span: Span
    is_declaration: bool = False
    suffix: str = ""
    scope: str = ""

    @property
    def named(self) -> tuple[str, str, str]:
        """What the name names: the same for all of its occurrences."""
        return self.kind, self.name, self.scope

    @property
    def is_computed(self) -> bool:
        """Whether an expression makes the name."""
        return has_expression(self.span.text or "")
