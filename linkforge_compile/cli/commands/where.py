"""`linkforge where`: finds what in a spec wrote a line of an output, with the source map beside it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.banner import BANNER
from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.reports import add_report_options, report
from linkforge_compile.cli.targets import format_by_suffix
from linkforge_compile.source import SourceFile

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.map_file import MapFile, Stretch
    from linkforge_compile.source import Span

_EXAMPLES = """\
NAME is the name of a link, a joint, a sensor or another element in the file; in a file that is not XML, it is a word of
a line. The source map is FILE.map.json, which `linkforge compile --source-map` writes beside the file.

examples:
  linkforge compile arm.robot.yaml -o build/ --source-map
  linkforge where build/arm.urdf:81            what wrote line 81
  linkforge where build/arm.urdf:81:32         what wrote the attribute at column 32 of it
  linkforge where build/arm.urdf elbow         where the link or joint `elbow` was written
"""

_LARGEST = 256 * 1024 * 1024  # bytes


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge where FILE:LINE[:COLUMN] | FILE NAME"
    parser.epilog = _EXAMPLES
    parser.add_argument("file", metavar="FILE[:LINE[:COLUMN]]", help="a line of a file that linkforge wrote")
    parser.add_argument("name", metavar="NAME", nargs="?", help="the name of an element in the file, instead of a line")
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    path, line, column = _place_in(arguments.file)
    if (line is None) == (arguments.name is None):
        raise UsageError("takes a line of a file, such as robot.urdf:81, or a file and a name in it")
    document = _text_of(path)
    source_map = _map_of(path, document)
    from linkforge_compile.formats.map_file import hash_of

    is_changed = source_map.sha256 != hash_of(document)
    faults = [_changed(SourceFile(str(path), document), "its map was written")] if is_changed else []
    sources = _Sources(path.parent, source_map, faults)
    lines = _named(path, document, arguments.name) if line is None else [_Query(line, column, "")]
    from linkforge_compile.cli.output import write_to_stdout

    rows = (row for query in lines for row in _answer(path, document, sources, query))
    write_to_stdout("".join(f"{row}\n" for row in rows))
    return FAULTY_SPEC if report(sources.faults, arguments) else OK


class _Query(NamedTuple):
    """A line of the document to look up; `what` describes the element if it was given by name, else it is empty."""

    line: int
    column: int
    what: str


def _place_in(word: str) -> tuple[Path, int | None, int]:
    """Split `FILE:LINE:COLUMN`; the name of the file may contain colons."""
    found = re.fullmatch(r"(?P<file>.+?)(?::(?P<line>[0-9]{1,9})(?::(?P<column>[0-9]{1,9}))?)?:?", word)
    if found is None or Path(word).is_file():
        return Path(word), None, 1
    line, column = found["line"], found["column"]
    return Path(found["file"]), int(line) if line else None, int(column or 1)


def _text_of(path: Path) -> str:
    try:
        if not path.is_file():
            raise UsageError(f"there is no file '{path}'")
        if path.stat().st_size > _LARGEST:
            raise UsageError(f"'{path}' is larger than {_LARGEST // 1024**2} MiB")
        return path.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        raise UsageError(f"'{path}' is not UTF-8") from None
    except OSError as error:
        raise UsageError(f"cannot read '{path}': {error.strerror}") from error


def _map_of(path: Path, document: str) -> MapFile:
    """Read the map of a document; UsageError if there is none, with the command that writes it."""
    from linkforge_compile.formats.map_file import ENDING, NoMapError, read_map

    map_file = path.with_name(path.name + ENDING)
    if not map_file.exists():
        banner = BANNER.search(document[:10_000])
        spec = banner["spec"] if banner else "SPEC.robot.yaml"
        output = f" -o {path}" if format_by_suffix(path.name) else ""  # else a file in the folder of a format
        command = f"linkforge compile {spec}{output} --source-map"
        raise UsageError(f"there is no map '{map_file}'; `{command}`, with the same options as before, writes it")
    try:
        return read_map(_text_of(map_file))
    except NoMapError as error:
        raise UsageError(f"'{map_file}' cannot be read: {error}") from None


def _changed(file: SourceFile, when: str) -> Diagnostic:
    from linkforge_compile.diagnostics.codes.formats import CHANGED_SINCE

    return CHANGED_SINCE.at(file.whole, when=when)


def _named(path: Path, document: str, name: str) -> list[_Query]:
    """Return the elements with a name: those that declare it, or else those that refer to it."""
    from linkforge_compile.source.characters import begins_xml

    if not begins_xml(document):
        return _lines_with(path, document, name)
    elements = list(_elements_of(path, document))
    found = [element for element in elements if element.name == name]
    declared = [element for element in found if element.is_declared]
    if not found:
        raise _no_such_name(path, name, [element.name for element in elements])
    return [_Query(element.line, 1, f"{element.tag} '{name}'") for element in declared or found]


def names_in(path: Path) -> tuple[str, ...]:
    """Return the names that elements of a file declare, none for a file that is not XML."""
    from linkforge_compile.source.characters import begins_xml

    document = _text_of(path)
    elements = _elements_of(path, document) if begins_xml(document) else ()
    return tuple(dict.fromkeys(element.name for element in elements if element.is_declared))


def _lines_with(path: Path, document: str, name: str) -> list[_Query]:
    """Return the lines of a file that is not XML in which a name is a whole word."""
    whole_word = re.compile(rf"(?<![\w./-]){re.escape(name)}(?![\w./-])")
    lines = enumerate(document.split("\n"), 1)
    found = [_Query(number, 1, "") for number, line in lines if whole_word.search(line)]
    if not found:
        raise _no_such_name(path, name, re.findall(r"[\w./-]+", document))
    return found


def _no_such_name(path: Path, name: str, names: list[str]) -> UsageError:
    from linkforge_compile.diagnostics.enumerations import listed
    from linkforge_compile.diagnostics.suggest import did_you_mean

    longer = [other for other in dict.fromkeys(names) if name in other]
    there_are = f"; there is {listed(longer, 'and')}" if longer else ""
    return UsageError(f"there is no '{name}' in {path}{did_you_mean(name, names) or there_are}")


class _Element(NamedTuple):
    """An element with a name; nested ones may only refer to it, and are not `is_declared`."""

    tag: str
    name: str
    line: int
    is_declared: bool


def _elements_of(path: Path, document: str) -> Iterator[_Element]:
    from linkforge_compile.source.malformed_xml import MalformedXmlError
    from linkforge_compile.source.xml_tree import XmlElement, parse_xml

    def inside(element: XmlElement, around: tuple[str, ...]) -> Iterator[_Element]:
        if (name := element.get("name")) is not None:
            is_declared = len(around) == 1 or (element.tag == "sensor" and around[-1:] == ("gazebo",))
            yield _Element(element.tag, name, element.span.line, is_declared)
        for child in element.children:
            yield from inside(child, (*around, element.tag))

    file = SourceFile(str(path), document)
    try:
        return inside(parse_xml(file).root, ())
    except MalformedXmlError as error:
        line = file.between(error.at, error.at).line
        raise UsageError(f"'{path}' is not XML: {error.problem} in line {line}") from None


class _Sources:
    """The sources of a map, each read once; `faults` collects diagnostics about missing and changed ones."""

    def __init__(self, folder: Path, source_map: MapFile, faults: list[Diagnostic]) -> None:
        self.map = source_map
        self.faults = faults
        self._folder = folder
        self._read: dict[int, Span] = {}

    def span(self, stretch: Stretch) -> Span:
        whole = self._read.get(stretch.source) or self._whole(stretch.source)
        line, column = stretch.line, stretch.column
        end = column + (stretch.length or max(1, len(whole.file.line(line)) - column + 1))
        return whole._replace(line=line, column=column, end_line=line, end_column=end)

    def _whole(self, number: int) -> Span:
        from linkforge_compile.diagnostics.codes.formats import SOURCE_NOT_SHOWN
        from linkforge_compile.formats.map_file import hash_of

        source = self.map.sources[number]
        name = _from_here(self._folder / source.path)
        try:
            file = SourceFile(name, _text_of(Path(name)))
        except UsageError as error:
            file = SourceFile(name, "")
            self.faults.append(SOURCE_NOT_SHOWN.at(file.whole, reason=error))
        else:
            if hash_of(file.text) != source.sha256:
                self.faults.append(_changed(file, "it was compiled"))
        self._read[number] = file.whole
        return self._read[number]


def _from_here(path: Path) -> str:
    import os

    try:
        return os.path.relpath(path)
    except ValueError:  # another drive of Windows
        return str(path)


def _answer(path: Path, document: str, sources: _Sources, query: _Query) -> Iterator[str]:
    from linkforge_compile.cli.reports import place_lines

    lines = document.split("\n")
    if not 0 < query.line <= len(lines):
        raise UsageError(f"'{path}' has {len(lines)} lines, found {query.line}")
    line = lines[query.line - 1].rstrip("\r")
    if query.column > max(1, len(line)):
        raise UsageError(f"line {query.line} of '{path}' has {len(line)} columns, found {query.column}")
    yield f"{path}:{query.line}: {query.what or line.strip()}"
    found = sources.map.at(query.line, query.column)
    if found is None:
        yield "no source is recorded for this line"
        return
    stretch, trail = found
    place = sources.span(stretch)
    yield from place_lines("written", place)
    # A whole map or list is not computed; its values have stretches of their own.
    text = place.text or ""
    if stretch.length and "$(" in text.replace("$$(", "") and not text.startswith(("{", "[")):
        yield f"computed: {text}"
    for how, step in trail:
        yield from place_lines(how, sources.span(step))
