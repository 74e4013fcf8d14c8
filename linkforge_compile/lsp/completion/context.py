"""What completion knows of a position: the map around it as it is written now, and the latest analyses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from lsprotocol import types

from linkforge_compile.analysis import Analysis, Settings
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.lsp.cursor import (
    MARKER,
    Cursor,
    Role,
    closed,
    lines_of_section,
    section_lines,
    section_names,
)
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.schema.descriptions import Described, described_at
from linkforge_compile.schema.shapes import node_at
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, read_data


@dataclass(frozen=True)
class Context:
    """A position in an open text; `settings` are those that specs are analysed with."""

    document: Document
    cursor: Cursor
    position: types.Position
    settings: Settings

    @property
    def line(self) -> str:
        """The line of the position."""
        return self.document.file.line(self.cursor.word.line)

    @property
    def precedes_key(self) -> bool:
        """Whether the position is just before a key, which then is not the one to complete."""
        return self.cursor.role is Role.KEY and not self.cursor.typed and bool(self.cursor.word.text)

    @cached_property
    def word(self) -> Span:
        """The word to replace."""
        word = self.cursor.word
        return word._replace(end_column=word.column) if self.precedes_key else word

    @property
    def before_word(self) -> str:
        """What precedes the word in its line."""
        return self.line[: self.word.column - 1]

    @property
    def after_word(self) -> str:
        """What follows the word in its line."""
        return self.line[self.word.end_column - 1 :]

    @property
    def column(self) -> int:
        """The column of the position."""
        return self.document.columns.place(self.document.file, self.position).column

    @property
    def is_flow(self) -> bool:
        """Whether the position is in braces or brackets."""
        return self.cursor.is_flow

    @property
    def is_quoted(self) -> bool:
        """Whether the word begins in quotes."""
        return self.before_word.endswith(("'", '"'))

    def range(self, begin: int, end: int | None = None) -> types.Range:
        """Return the range from a column to another one in the line, the end of the word if there is none."""
        word = self.word
        end = word.end_column if end is None else end
        return self.document.columns.range(Span(word.file, word.line, begin, word.line, end))

    @cached_property
    def branches(self) -> tuple[Described, ...]:
        """The branches of the schema at the path."""
        return described_at(self.cursor.path)

    @cached_property
    def _section(self) -> YamlNode | None:
        """The tree of the section around the position, as it is written now, with MARKER as its word."""
        return _read_around(self)

    def node(self, path: Sequence[str | int]) -> YamlNode | None:
        """Return what is written at a path now, or was when the text was last readable; None for nothing."""
        found = node_at(self._section, tuple(path)) if self._section else None
        if found is None and path:
            found = node_at(self._other_section(str(path[0])), tuple(path))
        return found if found is not None or self.tree is None else node_at(self.tree, tuple(path))

    def _other_section(self, name: str) -> YamlNode:
        """Return the tree of another section of the text as written now, read alone; an empty one for none."""
        if name not in self._others:
            lines = lines_of_section(self.document.file, name)
            text = SourceFile(self.document.file.name, "\n".join(lines), self.document.path)
            self._others[name] = (read_data(text, Diagnostics(), {}) if lines else None) or YamlMap({}, text.whole)
        return self._others[name]

    @cached_property
    def _others(self) -> dict[str, YamlNode]:
        return {}

    @cached_property
    def around(self) -> Mapping[str, YamlNode]:
        """The entries of the map that the position is in, without its own word."""
        path = self.cursor.path if self.cursor.role is Role.KEY else self.cursor.path[:-1]
        if not path:
            line = 0 if self.precedes_key else self.cursor.word.line
            return {name: YamlFault(self.cursor.word) for name in section_names(self.document.file, line)}
        found = self.node(path)
        entries = {entry.name: entry.value for entry in found} if isinstance(found, YamlMap) else {}
        return {name: value for name, value in entries.items() if MARKER not in name}

    @property
    def items_around(self) -> tuple[str, ...]:
        """The other scalars in the list that the position is in."""
        found = self.node(self.cursor.path[:-1]) if self.cursor.role is Role.ITEM else None
        texts = (item.text for item in found if isinstance(item, YamlScalar)) if isinstance(found, YamlList) else ()
        return tuple(text for text in texts if MARKER not in text)

    @property
    def text_around(self) -> Mapping[str, str]:
        """The scalars among the entries around the position."""
        return {name: value.text for name, value in self.around.items() if isinstance(value, YamlScalar)}

    @property
    def readable(self) -> Analysis | None:
        """The latest analysis of a text that could be read."""
        return self.document.readable

    @property
    def robot(self) -> Robot | None:
        """The robot of that analysis, without its faulty parts."""
        return self.readable.robot if self.readable else None

    @property
    def tree(self) -> YamlMap | None:
        """The tree of that analysis as written, with includes merged."""
        return self.readable.spec.tree if self.readable and self.readable.spec else None

    def sections(self, *names: str) -> Iterator[tuple[str, str, YamlNode]]:
        """Yield the section, the name and the value of each entry of some sections, also in included files."""
        for section in names:
            written = self.node((section,))
            known = self.tree.get(section) if self.tree else None
            own = {entry.name: entry.value for entry in written} if isinstance(written, YamlMap) else {}
            others = (
                {entry.name: entry.value for entry in known if not self.document.holds(entry.key.span)}
                if isinstance(known, YamlMap)
                else {}
            )
            for name, value in {**others, **own}.items():
                if MARKER not in name:
                    yield section, name, value


def _read_around(context: Context) -> YamlNode | None:
    """Read the section of a text that the word of a position is in, with MARKER in place of the word.

    If what follows the position cannot be read, it is omitted.
    """
    file, line = context.document.file, context.cursor.word.line
    is_new_key = context.cursor.role is Role.KEY and context.cursor.is_own_line
    marker = f"{MARKER}:" if is_new_key and not context.after_word.lstrip().startswith(":") else MARKER
    before, after = context.before_word + marker, context.after_word
    whole = context.line if context.precedes_key else before + after
    first, last = section_lines(file, line)
    above, below = list(file.lines[first - 1 : line - 1]), list(file.lines[line:last])
    for text in ("\n".join([*above, whole, *below]), closed("\n".join([*above, before]))):
        tree = read_data(SourceFile(file.name, text), Diagnostics(), {}) if text is not None else None
        if tree is not None:
            return tree
    return None
