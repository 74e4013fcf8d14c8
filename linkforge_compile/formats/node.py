"""Elements that are written, each on lines of its own, unless it holds text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, TypeAlias

from linkforge_compile.formats.markup import Xml, escaped, verbatim_text

Content: TypeAlias = "str | Node"
"""What stands in an element: text, an element, or a comment, which is Xml."""


class Node(NamedTuple):
    """An element as it was read or as parameters spell it; `content` is in document order, `mark` in its tag."""

    tag: str
    attributes: Sequence[tuple[str, str]]
    content: list[Content]
    mark: str = ""

    @property
    def start(self) -> str:
        """The opening tag without its end."""
        start = f"<{self.tag}{self.mark}"
        return (
            start + "".join(f' {name}="{escaped(value)}"' for name, value in self.attributes)
            if self.attributes
            else start
        )


def is_text(item: Content) -> bool:
    return isinstance(item, str) and not isinstance(item, Xml)


def lines_of(content: Sequence[Content]) -> Iterator[str]:
    for item in content:
        if isinstance(item, str):
            yield item
        elif not item.content:
            yield f"{item.start}/>"
        elif any(map(is_text, item.content)):
            yield inline(item)
        else:
            yield f"{item.start}>"
            yield from lines_of(item.content)
            yield f"</{item.tag}>"


def inline(item: Content) -> str:
    if isinstance(item, str):
        return item if isinstance(item, Xml) else verbatim_text(item)
    return f"{item.start}>{''.join(map(inline, item.content))}</{item.tag}>" if item.content else f"{item.start}/>"
