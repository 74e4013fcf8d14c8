"""One use of a xacro file: its arguments, the answers to the xacro process, and the elements as written."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.arguments import Arguments
from linkforge_compile.expand.evaluate import Evaluator
from linkforge_compile.expand.loader import ImportSite, Loader
from linkforge_compile.expand.packages import Package, find_package
from linkforge_compile.source import SourceFile

if TYPE_CHECKING:
    from linkforge_compile.importers.xacro import Expanded, Failed, Place
    from linkforge_compile.source.xml_tree import XmlElement


@dataclass(frozen=True)
class XacroUse:
    """What names a xacro file, its arguments, and the package folders that the using file declares.

    `evaluator` computes the arguments, None if they hold no expressions. `package` is the one through whose
    `package://` the file was reached. `used_elsewhere` are the arguments that the robot's other file uses; None if
    that file reports the unknown ones.
    """

    path: Path
    used: ImportSite
    arguments: Arguments
    evaluator: Evaluator | None = None
    packages: Mapping[str, Path] | None = None
    package: Package | None = None
    used_elsewhere: Collection[str] | None = ()


class XacroAnswers:
    """Answers the questions of the xacro process, and records what it may not have."""

    def __init__(self, use: XacroUse, loader: Loader) -> None:
        self._use, self._loader = use, loader
        self.missing_packages: list[str] = []
        self.refused: list[Path] = []
        """Files outside of the roots."""

    def find(self, name: str) -> Path | None:
        declared = {**(self._use.packages or {}), **self._loader.packages}
        folder = find_package(name, declared, self._use.path.parent, self._loader.roots)
        if folder is None:
            self.missing_packages.append(name)
        return folder

    def may_read(self, path: Path) -> bool:
        # The loader has read the file itself already.
        is_allowed = path == self._use.path.absolute() or self._loader.roots.hold(path)
        if not is_allowed:
            self.refused.append(path)
        return is_allowed


class WrittenElements:
    """The elements of xacro files as written; each file is parsed when first needed."""

    def __init__(self, result: Expanded | Failed, main: SourceFile, loader: Loader) -> None:
        self.main, self._loader = main, loader
        self._paths = result.files
        self._elements: dict[int, tuple[XmlElement, ...]] = {}
        files = (self.open(path) for path in result.files[1:])
        self.files = tuple(file for file in files if file)
        for path in result.read:
            loader.add_read_by_xacro(path)

    def element(self, place: Place) -> XmlElement | None:
        elements = self._elements_of(place.file)
        return elements[place.element] if place.element < len(elements) else None

    @property
    def all_elements(self) -> Iterator[XmlElement]:
        return (element for number in range(len(self._paths)) for element in self._elements_of(number))

    def named(self, tag: str) -> Iterator[str]:
        """Yield the names of all elements with a tag."""
        return (name for one in self.all_elements if one.tag == tag and (name := one.get("name")))

    def open(self, path: Path) -> SourceFile | None:
        """Read another file than the first; a file names it, not the user, so it must lie within the roots."""
        return self._loader.open_xml(path, Diagnostics(), ImportSite(str(path), self.main.whole))

    def _elements_of(self, number: int) -> tuple[XmlElement, ...]:
        if number not in self._elements:
            from linkforge_compile.importers.xml import read_xml

            file = self.main if number == 0 else self.open(self._paths[number])
            document = read_xml(file, Diagnostics()) if file else None
            self._elements[number] = tuple(in_order(document.root)) if document else ()
        return self._elements[number]


def in_order(element: XmlElement) -> list[XmlElement]:
    """Return an element and all elements in it in document order, as xacro's parser counts them."""
    return [element, *(inner for child in element.children for inner in in_order(child))]
