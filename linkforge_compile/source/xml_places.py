"""Where the tags, comments and sections of characters of an XML text stand.

lxml knows the line of an element, but no column, nor the places of attributes and comments.
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
"""Matches each piece of a document; its group is its kind, `rest` for all from where something is not closed."""

ATTRIBUTE = re.compile(r"""(?<=[\s"'])(?P<name>[^\s=/<>"']+)\s*=\s*(?:"(?P<double>[^"]*)"|'(?P<single>[^']*)')""")

# lxml takes these in names, the fourth edition of XML 1.0 does not, so that no name of a document has them.
_COLON, _NOTHING = "\ua789", "\ua78a"

_QUOTED = re.compile(r""""[^"]*"|'[^']*'""")
_HIDDEN = re.compile(rf"""({_QUOTED.pattern})|(:)|(?<=\s)xmlns(?=[\s=])""")
_SHOWN = str.maketrans({_COLON: ":", _NOTHING: None})


class Places:
    """Where the elements and comments of a text stand, in its order, once it was walked over."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.begins: list[int] = []
        self.ends: list[int] = []
        self.open: list[int] = []
        """The numbers of the elements that have no end yet, the innermost last."""
        self.trailing: set[int] = set()
        """Where the comments begin that stand on the line on which a tag ends, behind it."""
        self.has_foreign_names = False
        """Whether a name is not of ASCII."""
        self._line_from: int | None = None
        """What lies behind the tag, or the comment behind one, that ends on the line that is read."""
        self._hidden: list[str] = []
        self._hidden_to = 0

    def walk(self) -> Iterator[re.Match[str]]:
        """Yield each piece before it counts, to where something is not closed, or closes what is not open."""
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
        """The text with a letter for each ':' of its names, and behind `xmlns`.

        lxml would resolve prefixes, and refuse those that nothing declares; a name is to be what is written.
        """
        return "".join((*self._hidden, self.text[self._hidden_to :]))


def walked_over(text: str) -> Places:
    """Return the places of a text."""
    places = Places(text)
    for _ in places.walk():
        pass
    return places


def as_written(name: str) -> str:
    """Return a name in a text without namespaces as it was."""
    return name if name.isascii() else name.translate(_SHOWN)
