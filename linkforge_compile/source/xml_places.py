"""Find the places of tags, attributes, comments and CDATA sections in XML text.

lxml knows the line of an element, but no columns, nor the places of attributes and comments.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

MARKUP = re.compile(
    r"""(?P<text>[^<]+)
    | (?P<comment><!--.*?-->)
    | (?P<section><!\[CDATA\[.*?\]\]>)
    | (?P<instruction><\?(?P<target>[^\s?]*+).*?\?>)
    | (?P<end></[^<>]*>)
    | (?P<start><(?P<tag>[^\s/<>!?"'][^\s/<>=?"']*+)(?:[^<>"']++|"[^"<]*"|'[^'<]*')*+>)
    | (?P<rest><.*)""",
    re.DOTALL | re.VERBOSE,
)
"""Matches each piece of a document; the group is its kind, `rest` for all after something that is not closed."""

ATTRIBUTE = re.compile(r"""(?<=[\s"'])(?P<name>[^\s=/<>"']+)\s*=\s*(?:"(?P<double>[^"]*)"|'(?P<single>[^']*)')""")

# lxml accepts these in names, the fourth edition of XML 1.0 does not, so no name of a document has them.
_COLON, _NOTHING = "\ua789", "\ua78a"

_QUOTED = re.compile(r""""[^"]*"|'[^']*'""")
_HIDDEN = re.compile(rf"""({_QUOTED.pattern})|(:)|(?<=\s)xmlns(?=[\s=])""")
_SHOWN = str.maketrans({_COLON: ":", _NOTHING: None})


class Places:
    """The places of the elements and comments of a text, in its order, after `walk`."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.begins: list[int] = []
        self.ends: list[int] = []
        self.open: list[int] = []
        """The numbers of the elements that have no end yet, the innermost last."""
        self.trailing: set[int] = set()
        """Where the comments begin that follow a tag on the line on which it ends."""
        self.has_foreign_names = False
        """Whether a name has characters outside of ASCII."""
        self._line_from: int | None = None
        """The index after the tag, or the comment after one, that ends on the current line."""
        self._hidden: list[str] = []
        self._hidden_to = 0

    def walk(self) -> Iterator[re.Match[str]]:
        """Yield each piece before it is counted, up to one that is not closed or closes nothing."""
        is_ascii = self.text.isascii()
        for piece in MARKUP.finditer(self.text):
            yield piece
            kind = piece.lastgroup
            if kind == "start":
                if not piece[0].endswith("/>"):
                    self.open.append(len(self.begins))
                self._line_from = piece.end()
            elif kind == "end" and self.open:
                self.ends[self.open.pop()] = self._line_from = piece.end()
            elif kind == "comment":
                self._note_trailing(piece)
            elif kind == "instruction":
                self._line_from = None
            elif kind in ("text", "section"):
                continue
            else:
                return
            if kind in ("start", "comment"):
                self.begins.append(piece.start())
                self.ends.append(piece.end())
            if kind != "comment":
                self._hide_namespaces(piece)
                self.has_foreign_names |= not (is_ascii or _QUOTED.sub("", piece[0]).isascii())

    def _note_trailing(self, comment: re.Match[str]) -> None:
        between = "\n" if self._line_from is None else self.text[self._line_from : comment.start()]
        self._line_from = None
        if not (between.strip() or "\n" in between or "\r" in between):
            self.trailing.add(comment.start())
            self._line_from = comment.end()

    def _hide_namespaces(self, tag: re.Match[str]) -> None:
        if ":" in tag[0] or "xmlns" in tag[0]:
            hidden = _HIDDEN.sub(lambda found: found[1] or (_COLON if found[2] else f"xmlns{_NOTHING}"), tag[0])
            self._hidden += [self.text[self._hidden_to : tag.start()], hidden]
            self._hidden_to = tag.end()

    @property
    def without_namespaces(self) -> str:
        """The text with a letter in place of each ':' in its names, and one after `xmlns`.

        lxml would resolve prefixes and refuse undeclared ones; names are kept as written instead.
        """
        return "".join((*self._hidden, self.text[self._hidden_to :]))


def walked_over(text: str) -> Places:
    """Return the places in a text."""
    places = Places(text)
    for _ in places.walk():
        pass
    return places


def as_written(name: str) -> str:
    """Return a name of a text without namespaces as it was written."""
    return name if name.isascii() else name.translate(_SHOWN)
