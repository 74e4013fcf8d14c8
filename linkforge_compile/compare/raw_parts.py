"""Raw XML as parts, so that a change in it is told at the tag and attribute where it is, whatever its layout."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.formats.raw import elements_of, plain_text
from linkforge_compile.source.xml_tree import XmlElement


@dataclass(frozen=True)
class RawElement:
    """An element of raw XML: `written` is the whole of it.

    `texts` are what stands in it before its first element, behind that and so on, at least one and up to the last that
    is not blank.
    """

    tag: str
    attributes: Mapping[str, str]
    texts: tuple[str, ...]
    inside: tuple[RawElement, ...]
    written: str = field(compare=False)

    @property
    def name(self) -> str | None:
        """Its attribute of that name."""
        return self.attributes.get("name")


def raw_parts(texts: Iterable[str]) -> tuple[RawElement | str, ...]:
    """Return the elements of texts of raw XML; one that is not well-formed, as only Python makes it, as it stands."""
    return tuple(part for text in texts for part in _parts(text))


def _parts(text: str) -> tuple[RawElement | str, ...]:
    try:
        return tuple(map(_element, elements_of(text)))
    except RobotGeneratorError:
        return (text,)


def _element(element: XmlElement) -> RawElement:
    inside = tuple(map(_element, element.children))
    return RawElement(element.tag, dict(element.values), _texts(element), inside, plain_text(element))


def _texts(element: XmlElement) -> tuple[str, ...]:
    runs: list[list[str]] = [[]]
    for item in element.content:
        if isinstance(item, XmlElement):
            runs.append([])
        elif isinstance(item, str):
            runs[-1].append(item)
    texts = ["".join(run).strip() for run in runs]
    while len(texts) > 1 and not texts[-1]:
        texts.pop()
    return tuple(texts)


def by_tag(elements: Iterable[RawElement]) -> Mapping[str, Sequence[RawElement]]:
    """Return the elements of each tag in their order."""
    found: dict[str, list[RawElement]] = {}
    for element in elements:
        found.setdefault(element.tag, []).append(element)
    return found
