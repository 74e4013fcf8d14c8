"""The elements of xacro files as they are written, to report what xacro made of them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.load.loader import ImportSite, Loader
from linkforge_compile.source import SourceFile, Span

if TYPE_CHECKING:
    from linkforge_compile.importers.xacro import Expanded, Failed, Place
    from linkforge_compile.source.xml_tree import XmlElement


class WrittenElements:
    """The elements of xacro files as written; each file is parsed when first needed."""

    def __init__(self, result: Expanded | Failed, main: SourceFile, loader: Loader) -> None:
        self.main, self._loader = main, loader
        self._paths = result.files
        self._elements: dict[int, tuple[XmlElement, ...]] = {}
        self.files = tuple(filter(None, map(self.open, result.files[1:])))
        for path in result.read:
            loader.add_read_by_xacro(path)

    def element(self, place: Place) -> XmlElement | None:
        elements = self._elements_of(place.file)
        return elements[place.element] if place.element < len(elements) else None

    def span(self, place: Place | None) -> Span | None:
        element = self.element(place) if place else None
        return element.span if element else None

    @property
    def all_elements(self) -> Iterator[XmlElement]:
        return (element for number in range(len(self._paths)) for element in self._elements_of(number))

    def named(self, tag: str) -> Iterator[str]:
        return (name for one in self.all_elements if one.tag == tag and (name := one.get("name")))

    def open(self, path: Path) -> SourceFile | None:
        """Read another file than the first; a file names it, not the user, so it must lie within the roots."""
        return self._loader.open_xml(path, Diagnostics(), ImportSite(str(path), self.main.whole))

    def _elements_of(self, number: int) -> tuple[XmlElement, ...]:
        if number not in self._elements:
            from linkforge_compile.importers.xml import read_xml

            file = self.main if number == 0 else self.open(self._paths[number])
            document = read_xml(file, Diagnostics()) if file else None
            self._elements[number] = tuple(document.root.walk()) if document else ()
        return self._elements[number]
