"""Change the pairs in the text of a spec, and nothing else: every comment and all other lines stay as they are."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.collisions.scene import Names, is_own
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf_collisions import CollisionPair
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.fix import Edit, apply_edits
from linkforge_compile.source import SourceFile
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
        return apply_edits(file, [text.append(["semantic:", *_section(wanted, _INDENT)])])
    if is_null(entry.value):
        return apply_edits(file, [text.clear(entry), text.insert_below(entry, _section(wanted, _INDENT))])
    semantic = text.require_block(entry, "semantic")
    section = semantic.entries.get(SECTION)
    if section is None:
        last = list(semantic)[-1]
        return apply_edits(file, [text.insert_below(last, _section(wanted, text.indent(last)))])
    if is_null(section.value):
        lines = _section(wanted, text.indent(section))[1:]
        return apply_edits(file, [text.clear(section), text.insert_below(section, lines)])
    written = _written(text, section, declared)
    return apply_edits(file, _edits(text, written, wanted, section))


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
        inside = [pair for pair in pairs if pair.source and begin <= pair.source.span.range[0] < end]
        written.append(_Written(entry, inside))
    if len(pairs) != sum(len(one.pairs) for one in written):
        raise CannotRewriteError(f"some pairs are not written under '{SECTION}' itself")
    return written


def _edits(
    text: _Text, written: Sequence[_Written], wanted: Mapping[Names, str | None], section: YamlEntry
) -> Iterator[Edit]:
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

    def begin(self, entry: YamlEntry) -> int:
        return entry.key.span.range[0]

    def end(self, entry: YamlEntry) -> int:
        """Return the index after the last character of an entry that is no space or comment."""
        return max(entry.key.span.range[1] + 1, self._end(entry.value))

    def _end(self, node: YamlNode) -> int:
        if self._is_block(node):
            assert isinstance(node, YamlMap)
            return max(self.end(entry) for entry in node)
        return node.span.range[1]

    def _is_block(self, node: YamlNode) -> bool:
        return isinstance(node, YamlMap) and len(node) > 0 and not node.span.is_flow

    def require_block(self, entry: YamlEntry, name: str) -> YamlMap:
        """Return the map of an entry that is written below its key, line by line."""
        node = entry.value
        if not isinstance(node, YamlMap) or not self._is_block(node) or node.span.start < entry.key.span.start:
            raise CannotRewriteError(f"'{name}' is not written below its key, line by line")
        return node

    def indent(self, entry: YamlEntry) -> str:
        return " " * (entry.key.span.column - 1)

    def insert_below(self, entry: YamlEntry, lines: Sequence[str]) -> Edit:
        """Return the edit that adds lines below the last line of an entry."""
        end = self._line_end(entry)
        return self._edit(end, end, "".join(f"{self._file.newline}{line}" for line in lines))

    def clear(self, entry: YamlEntry) -> Edit:
        """Return the edit that removes a written `null`."""
        return self._edit(entry.key.span.range[1] + 1, self.end(entry), "")

    def append(self, lines: Sequence[str]) -> Edit:
        """Return the edit that adds lines at the end of the file, after an empty one."""
        end = len(self._text)
        text = "".join(f"{line}{self._file.newline}" for line in ("", *lines))
        return self._edit(end, end, text if self._text.endswith(("\n", "\r")) else self._file.newline + text)

    def replace(self, entry: YamlEntry, lines: Sequence[str]) -> Edit:
        """Return the edit that replaces an entry, with the comments inside it above its new lines."""
        begin, end = self.begin(entry), self.end(entry)
        texts = [*self._comments(entry, begin, end), *lines]
        if texts:
            separator = self._file.newline + self.indent(entry)
            return self._edit(begin, end, separator.join(texts))
        line_end, above = self._line_end(entry), entry.key.span.line - 1
        if comment := self._text[end:line_end].lstrip():
            return self._edit(begin, line_end - len(comment), "")
        return self._edit(self._file.index_of(above, len(self._file.line(above)) + 1), line_end, "")

    def _line_end(self, entry: YamlEntry) -> int:
        """Return the index of the end of the last line of an entry."""
        found = re.compile(r"[^\r\n]*").match(self._text, self.end(entry))
        return found.end() if found else len(self._text)

    def _comments(self, entry: YamlEntry, begin: int, end: int) -> list[str]:
        """Return the comments inside an entry."""
        text = self._text[begin:end]
        for leaf in (entry.key, *leaves_in(entry.value)):
            first, last = (index - begin for index in leaf.span.range)
            if 0 <= first < last <= len(text):
                text = text[:first] + "_" * (last - first) + text[last:]
        return _COMMENT.findall(text)

    def _edit(self, begin: int, end: int, text: str) -> Edit:
        return Edit(self._file.between(begin, end), text)
