"""Change the pairs in the text of a spec, and nothing else: every comment and all other lines stay as they are."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.collisions.scene import Names, is_own
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf_collisions import CollisionPair
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.source import Position, SourceFile
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar, has_expression, is_null, leaves_in, read
from linkforge_compile.syntax.writer import write

_GENERATED = SourceFile("<generated>", "").whole


def section_text(pairs: Mapping[Names, str | None]) -> str:
    """Return the section as lines of YAML, to be put below `semantic`."""
    by_first: dict[str, dict[str, YamlNode]] = {}
    for (first, second), reason in pairs.items():
        by_first.setdefault(first, {})[second] = _reason(reason)
    return write(_map({"disabled_collisions": _map({name: _map(each) for name, each in by_first.items()})}))


def entry_lines(pairs: Mapping[Names, str | None]) -> list[str]:
    """Return the lines below the key of the section, without their common indentation; none for no pairs."""
    return [line.removeprefix("  ") for line in section_text(pairs).splitlines()[1:]]


def _map(entries: Mapping[str, YamlNode]) -> YamlMap:
    named = {name: YamlEntry(_text(name), value) for name, value in entries.items()}
    return YamlMap(named, _GENERATED)


def _reason(reason: str | None) -> YamlScalar:
    return YamlScalar("", None, _GENERATED) if reason is None else _text(reason)


def _text(text: str) -> YamlScalar:
    return YamlScalar(text, text, _GENERATED)


SECTION = "disabled_collisions"

_INDENT = "  "

_COMMENT = re.compile(r"(?:^|(?<=\s))#[^\r\n]*")


class CannotRewriteError(Exception):
    """The pairs are written in a form that only a person can change; the message is the reason."""


class _Edit(NamedTuple):
    """The text between two indexes, and what replaces it."""

    begin: int
    end: int
    text: str


class _Written(NamedTuple):
    """An entry of the section, by its first link, with the pairs that it declares."""

    entry: YamlEntry
    pairs: Sequence[CollisionPair]

    @property
    def is_plain(self) -> bool:
        """Whether it declares the same pairs for all values of parameters."""
        leaves = [leaf.text for leaf in (self.entry.key, *leaves_in(self.entry.value)) if isinstance(leaf, YamlScalar)]
        return not any(has_expression(text) or text in {"for", "when"} for text in leaves)

    @property
    def names(self) -> set[str]:
        """The first links of its pairs."""
        return {self.entry.name, *(pair.link1 for pair in self.pairs)}


def file_to_rewrite(robot: Robot) -> SourceFile:
    """Return the file that declares pairs, the spec itself or one that it includes; the spec where none does.

    Raises:
        CannotRewriteError: It is no spec in YAML, or several files declare pairs.

    """
    files = {pair.source.span.file for pair in robot.semantic.disabled_collisions if is_own(pair) and pair.source}
    if not files and robot.source:
        files = {robot.source.span.file.outermost}
    names = sorted(file.shown for file in files)
    if len(files) != 1:
        raise CannotRewriteError(f"the pairs are written in several files, {' and '.join(names)}")
    (file,) = files
    if file.is_xml or file.path is None:
        raise CannotRewriteError(f"'{names[0]}' is not a spec in YAML; write one that uses it")
    return file


def rewrite(file: SourceFile, robot: Robot, wanted: Mapping[Names, str | None]) -> str:
    """Return the text of a spec with the wanted pairs in place of those that it declares.

    An entry whose pairs are all wanted stays as it is written, with its expressions. One that has to change is written
    anew, without expressions.

    Raises:
        CannotRewriteError: The section is no map in block style, or the pairs are not written in it.

    """
    declared = [pair for pair in robot.semantic.disabled_collisions if is_own(pair)]
    text = _Text(file)
    root = read(file, Diagnostics())
    entry = root.entries.get("semantic") if root else None
    if entry is None:
        return text.with_edits([text.append(["semantic:", *_section(wanted, _INDENT)])])
    if is_null(entry.value):
        return text.with_edits([text.clear(entry), text.insert_below(entry, _section(wanted, _INDENT))])
    semantic = text.require_block(entry, "semantic")
    section = semantic.entries.get(SECTION)
    if section is None:
        last = list(semantic)[-1]
        return text.with_edits([text.insert_below(last, _section(wanted, text.indent(last)))])
    if is_null(section.value):
        lines = _section(wanted, text.indent(section))[1:]
        return text.with_edits([text.clear(section), text.insert_below(section, lines)])
    written = _written(text, section, declared)
    return text.with_edits(_edits(text, written, wanted, section))


def _section(wanted: Mapping[Names, str | None], indent: str) -> list[str]:
    """Return the lines of a new section."""
    return [f"{indent}{SECTION}:", *(f"{indent}{_INDENT}{line}" for line in entry_lines(wanted))]


def _written(text: _Text, section: YamlEntry, declared: Iterable[CollisionPair]) -> list[_Written]:
    """Return the entries of the section with their pairs."""
    node = text.require_block(section, SECTION)
    pairs = list(declared)
    written: list[_Written] = []
    for entry in node:
        begin, end = text.begin(entry), text.end(entry)
        if begin < text.begin(section):
            raise CannotRewriteError(f"'{SECTION}' inserts what an anchor names")
        inside = [pair for pair in pairs if pair.source and begin <= text.at(pair.source.span.start) < end]
        written.append(_Written(entry, inside))
    if len(pairs) != sum(len(one.pairs) for one in written):
        raise CannotRewriteError(f"some pairs are not written under '{SECTION}' itself")
    return written


def _edits(
    text: _Text, written: Sequence[_Written], wanted: Mapping[Names, str | None], section: YamlEntry
) -> Iterator[_Edit]:
    """Yield the edits of entries that change, and one for the new entries after the last one."""
    left = dict(wanted)
    kept = [_kept(one, left) for one in written]
    added: list[dict[Names, str | None]] = [{} for _ in written]
    new: dict[Names, str | None] = {}
    for pair, reason in left.items():
        host, names = _host(pair, written)
        (new if host is None else added[host])[names] = reason
    for one, pairs, more in zip(written, kept, added, strict=True):
        if pairs | more != {(pair.link1, pair.link2): pair.reason for pair in one.pairs}:
            if any(pair.extra_attributes or pair.extra_elements for pair in one.pairs):
                raise CannotRewriteError(f"a pair of '{one.entry.name}' has raw XML")
            yield text.replace(one.entry, entry_lines(pairs | more))
    if new:
        last = written[-1].entry if written else section
        indent = text.indent(last) if written else text.indent(section) + _INDENT
        yield text.insert_below(last, [f"{indent}{line}" for line in entry_lines(new)])


def _kept(one: _Written, left: dict[Names, str | None]) -> dict[Names, str | None]:
    """Return the pairs of an entry that are still wanted, as they are written; remove them from `left`."""
    kept: dict[Names, str | None] = {}
    for pair in one.pairs:
        for names in ((pair.link1, pair.link2), (pair.link2, pair.link1)):
            if names in left:
                kept[pair.link1, pair.link2] = left.pop(names)
    return kept


def _host(pair: Names, written: Sequence[_Written]) -> tuple[int | None, Names]:
    """Return the place of the entry to which a new pair is added, None for a new entry, and the pair as it is written.

    An entry with expressions would be written out, so one of the other link is preferred to it.
    """
    ways = (pair, (pair[1], pair[0]))
    hosts = [next((place for place, one in enumerate(written) if names[0] in one.names), None) for names in ways]
    for host, names in zip(hosts, ways, strict=True):
        if host is not None and written[host].is_plain:
            return host, names
    return next(((host, names) for host, names in zip(hosts, ways, strict=True) if host is None), (hosts[0], pair))


class _Text:
    """The text of a file by index, and edits of its entries."""

    def __init__(self, file: SourceFile) -> None:
        self._file, self._text = file, file.counted
        self._starts = [0, *(found.end() for found in re.finditer(r"\r\n|\r|\n", self._text))]
        self._line_end = "\r\n" if "\r\n" in self._text else "\n"

    def at(self, position: Position) -> int:
        return self._starts[position.line - 1] + position.column - 1

    def begin(self, entry: YamlEntry) -> int:
        return self.at(entry.key.span.start)

    def end(self, entry: YamlEntry) -> int:
        """Return the index after the last character of an entry that is no space or comment."""
        return max(self.at(entry.key.span.end) + 1, self._end(entry.value))

    def _end(self, node: YamlNode) -> int:
        if self._is_block(node):
            assert isinstance(node, YamlMap)
            return max(self.end(entry) for entry in node)
        return self.at(node.span.end)

    def _is_block(self, node: YamlNode) -> bool:
        return isinstance(node, YamlMap) and len(node) > 0 and self._text[self.at(node.span.start)] != "{"

    def require_block(self, entry: YamlEntry, name: str) -> YamlMap:
        """Return the map of an entry that is written below its key, line by line."""
        node = entry.value
        if not isinstance(node, YamlMap) or not self._is_block(node) or self.at(node.span.start) < self.begin(entry):
            raise CannotRewriteError(f"'{name}' is not written below its key, line by line")
        return node

    def indent(self, entry: YamlEntry) -> str:
        return " " * (entry.key.span.column - 1)

    def insert_below(self, entry: YamlEntry, lines: Sequence[str]) -> _Edit:
        """Return the edit that adds lines below the last line of an entry."""
        end = re.compile(r"[^\r\n]*").match(self._text, self.end(entry))
        index = end.end() if end else len(self._text)
        return _Edit(index, index, "".join(f"{self._line_end}{line}" for line in lines))

    def clear(self, entry: YamlEntry) -> _Edit:
        """Return the edit that removes a written `null`."""
        return _Edit(self.at(entry.key.span.end) + 1, self.end(entry), "")

    def append(self, lines: Sequence[str]) -> _Edit:
        """Return the edit that adds lines at the end of the file, after an empty one."""
        end = len(self._text)
        text = "".join(f"{line}{self._line_end}" for line in ("", *lines))
        return _Edit(end, end, text if self._text.endswith(("\n", "\r")) else self._line_end + text)

    def replace(self, entry: YamlEntry, lines: Sequence[str]) -> _Edit:
        """Return the edit that replaces an entry, with the comments inside it above its new lines."""
        begin, end = self.begin(entry), self.end(entry)
        texts = [*self._comments(entry, begin, end), *lines]
        if texts:
            separator = self._line_end + self.indent(entry)
            return _Edit(begin, end, separator.join(texts))
        rest = re.compile(r"[ \t]*(\r\n|\r|\n)?").match(self._text, end)
        assert rest
        # With the whole line, unless a comment follows.
        return _Edit(self._starts[entry.key.span.line - 1] if rest[1] else begin, rest.end(), "")

    def _comments(self, entry: YamlEntry, begin: int, end: int) -> list[str]:
        """Return the comments inside an entry."""
        text = self._text[begin:end]
        for leaf in (entry.key, *leaves_in(entry.value)):
            first, last = self.at(leaf.span.start) - begin, self.at(leaf.span.end) - begin
            if 0 <= first < last <= len(text):
                text = text[:first] + "_" * (last - first) + text[last:]
        return _COMMENT.findall(text)

    def with_edits(self, edits: Iterable[_Edit]) -> str:
        text = self._text
        for edit in sorted(edits, reverse=True):
            text = text[: edit.begin] + edit.text + text[edit.end :]
        return self._file.text[: len(self._file.text) - len(self._text)] + text
