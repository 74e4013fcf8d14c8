"""Read YAML into the positioned tree: parser events become nodes, each with its span in the file."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import yaml
from yaml import events
from yaml.events import (
    AliasEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes import syntax as codes
from linkforge_compile.diagnostics.enumerations import alternatives
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import SourceFile
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point
from linkforge_compile.syntax.entries import STUCK, kind_of, make_entries
from linkforge_compile.syntax.fixes import indent_line, space_after_colon
from linkforge_compile.syntax.flow_lines import find_outdented_line
from linkforge_compile.syntax.nodes import (
    MAX_DEPTH,
    ScalarValue,
    Tags,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    is_cut_expression,
    is_overflow,
    scalar_value,
)
from linkforge_compile.syntax.parser import MAX_READ_TWICE, PARSER, Marks, Parser

_cached_value = lru_cache(maxsize=4096)(scalar_value)
"""A robot repeats a few words and numbers."""

_Beginning: TypeAlias = ScalarEvent | SequenceStartEvent | MappingStartEvent
"""The first event of a node that is no alias."""

_BEGINNINGS = (ScalarEvent, SequenceStartEvent, MappingStartEvent)


def read(file: SourceFile, sink: Diagnostics, budget: Budget | None = None) -> YamlMap | None:
    """Read the one YAML document of a file; None where the text or its top level is faulty, which is reported.

    Faulty nodes, such as the values of a repeated key, become YamlFault, and reading continues; only malformed
    YAML ends it. Every node is charged to the budget, each alias as a copy; without a budget it gets a new one.
    """
    root = _read_root(file, sink, budget or Budget(), None)
    if root is None or isinstance(root, YamlMap):
        return root
    if isinstance(root, YamlScalar) and root.value is None:
        sink.report(codes.EMPTY_DOCUMENT.at(root.span.file.whole))
    elif isinstance(root, YamlScalar) and STUCK.fullmatch(root.text):
        sink.report(space_after_colon(root.span, root.text))
    elif not isinstance(root, YamlFault):
        sink.report(codes.TOP_LEVEL_NOT_MAP.at(root.span, found=kind_of(root)))
    return None


def read_data(file: SourceFile, sink: Diagnostics, tags: Tags, budget: Budget | None = None) -> YamlNode | None:
    """Read a file of data, whose top may be any node and which may use `tags`; None as for `read`."""
    root = _read_root(file, sink, budget or Budget(), tags)
    if isinstance(root, YamlScalar) and root.value is None:
        sink.report(codes.EMPTY_DATA.at(file.whole))
        return None
    return root


def _read_root(file: SourceFile, sink: Diagnostics, budget: Budget, tags: Tags | None) -> YamlNode | None:
    """Return the top node, None where the text cannot be read; `tags` is None for a spec."""
    if forbidden := FORBIDDEN_CHARACTER.search(file.counted):
        span = file.between(*forbidden.span())
        sink.report(codes.FORBIDDEN_CHARACTER.at(span, character=code_point(forbidden[0])))
        return None
    return _read_document(Marks(file), sink, budget, tags, PARSER)


def _read_document(
    marks: Marks, sink: Diagnostics, budget: Budget, tags: Tags | None, parser: Parser
) -> YamlNode | None:
    reader = _Reader(marks, sink, budget, tags, parser)
    root = None
    try:
        root = reader.read_document()
    except _UnreadableError as unreadable:
        sink.report(unreadable.diagnostic)
    except yaml.MarkedYAMLError as error:
        # libyaml rejects `{mass:}`, which is YAML 1.2. What is reported twice is kept once.
        is_empty_field = parser is not yaml.BaseLoader and error.problem == "found unexpected ':'"
        if is_empty_field and len(marks.text) <= MAX_READ_TWICE:
            return _read_document(marks, sink, budget, tags, yaml.BaseLoader)
        from linkforge_compile.syntax.errors import explain_parser_error

        sink.report_all(explain_parser_error(error, marks, reader.last_scalar, reader.brackets))
    # The nodes before an error were read as well.
    budget.spend(Limit.VALUES, reader.size, marks.file.whole)
    return root


class _UnreadableError(Exception):
    """The rest of the document cannot be read, for the reason in `diagnostic`."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(str(diagnostic))


class _CutExpression(YamlFault):
    """A piece of an expression that a comma has cut; the flow list or map that holds it is faulty as a whole."""

    __slots__ = ()


def _is_cut(nodes: Iterable[YamlNode]) -> bool:
    return any(isinstance(node, _CutExpression) for node in nodes)


@dataclass(frozen=True)
class _Anchor:
    """An anchored node, its size with every alias in it counted as a copy, and its depth in levels."""

    node: YamlNode
    size: int
    height: int


class _Reader:
    """Makes the nodes of one document from parser events."""

    def __init__(self, marks: Marks, sink: Diagnostics, budget: Budget, tags: Tags | None, parser: Parser) -> None:
        self.size = 0
        """The number of nodes so far, each alias counted as a copy."""
        self.last_scalar: ScalarEvent | None = None
        self.brackets: list[events.CollectionStartEvent] = []
        """The open flow lists and maps."""
        self._budget = budget
        self._most = budget.left(Limit.VALUES)
        self._marks, self._file = marks, marks.file
        self._sink = sink
        self._tags = tags
        self._next: Callable[[], events.Event | None] = parser(marks.text).get_event
        self._anchors: dict[str, _Anchor | None] = {}  # None while the anchored node is being read
        self._deepest = 0
        self._end = 0  # the index after the last scalar, alias or bracket
        self._indent = -1  # the column of the block list or map that is being read

    def read_document(self) -> YamlNode:
        """Return the top node; null for an empty document."""
        self._next()  # start of the stream
        if isinstance(self._next(), events.StreamEndEvent):
            return YamlScalar("", None, self._file.whole)
        root = self._node(self._next(), depth=1, flow=False)
        self._next()  # end of the document
        after = self._next()
        if isinstance(after, events.DocumentStartEvent):
            raise _UnreadableError(codes.SEVERAL_DOCUMENTS.at(self._marks.event(after)))
        return root

    def _node(self, event: events.Event | None, depth: int, flow: bool) -> YamlNode:
        """Read the node that begins with `event`; `flow` is whether it is inside [..] or {..}."""
        if isinstance(event, AliasEvent):
            return self._alias(event, depth)
        assert isinstance(event, _BEGINNINGS), "the parser ends only what it began"
        if event.anchor is None:
            return self._unanchored(event, depth, flow)
        size_before, deepest_outside = self.size, self._deepest
        self._anchors[event.anchor] = None
        self._deepest = depth
        node = self._unanchored(event, depth, flow)
        self._anchors[event.anchor] = _Anchor(node, self.size - size_before, self._deepest - depth)
        self._deepest = max(deepest_outside, self._deepest)
        return node

    def _count(self, nodes: int, event: events.Event) -> None:
        self.size += nodes
        if self.size > self._most:
            self._budget.spend(Limit.VALUES, self.size, self._marks.event(event))  # which raises

    def _alias(self, event: AliasEvent, depth: int) -> YamlNode:
        name, span = event.anchor, self._marks.event(event)
        self._end = self._marks.end(event)
        if name not in self._anchors:
            self._sink.report(codes.UNKNOWN_ANCHOR.at(span, name=name, near=self._anchors))
            return YamlFault(span)
        anchor = self._anchors[name]
        if anchor is None:
            self._sink.report(codes.RECURSIVE_ALIAS.at(span, name=name))
            return YamlFault(span)
        self._count(anchor.size, event)
        self._descend(depth + anchor.height, event)
        return anchor.node

    def _unanchored(self, event: _Beginning, depth: int, flow: bool) -> YamlNode:
        """Read a node that is no alias; one with an unknown tag becomes a YamlFault."""
        node: YamlNode
        make = None if event.tag is None else self._find_tag(event)
        if isinstance(event, MappingStartEvent):
            node = self._map(event, depth)
        elif isinstance(event, SequenceStartEvent):
            node = self._list(event, depth)
        else:
            node = self._scalar(event, flow)
        if event.tag is None or isinstance(node, YamlFault):
            return node
        return make(node) if make and isinstance(node, YamlScalar) else YamlFault(node.span)

    def _find_tag(self, event: _Beginning) -> Callable[[YamlScalar], YamlNode] | None:
        """Return the function of a scalar's tag; report a tag that has none."""
        if self._tags and isinstance(event, ScalarEvent) and event.tag is not None and event.tag in self._tags:
            return self._tags[event.tag]
        span = self._marks.tag(event)
        if self._tags is None:
            self._sink.report(codes.TAG.at(span, tag=span.text))
        else:
            self._sink.report(codes.OTHER_TAG.at(span, tag=span.text, known=alternatives([*self._tags], "and")))
        return None

    def _descend(self, depth: int, event: events.Event) -> None:
        if depth > MAX_DEPTH:
            raise _UnreadableError(codes.TOO_DEEP.at(self._marks.event(event), limit=MAX_DEPTH))
        self._deepest = max(self._deepest, depth)

    def _scalar(self, event: ScalarEvent, flow: bool) -> YamlScalar | YamlFault:
        text = event.value
        # Each tag of raw XML counts as a node.
        self._count(1 + text.count("<"), event)
        if event.style:
            return self._text(event, text, flow)
        value = _cached_value(text)
        node = self._text(event, value, flow)
        if isinstance(value, float) and is_overflow(text, value):
            self._sink.report(codes.NUMBER_TOO_LARGE.at(node.span))
            return YamlFault(node.span)
        return node

    def _text(self, event: ScalarEvent, value: ScalarValue, flow: bool) -> YamlScalar | YamlFault:
        """Read a scalar of this value; for keys and scalars in quotes, the value is the text itself."""
        self.last_scalar = event
        text, (begin, end) = event.value, self._marks.scalar_ends(event)
        self._end = end
        # The file has no forbidden character, but an escape in double quotes can make one.
        if event.style == '"' and (forbidden := FORBIDDEN_CHARACTER.search(text)):
            span = self._file.between(begin, end)
            self._sink.report(codes.FORBIDDEN_CHARACTER.at(span, character=code_point(forbidden[0])))
            return YamlFault(span)
        if flow and not event.style and "$(" in text and is_cut_expression(text):
            from linkforge_compile.syntax.errors import explain_cut_expression

            self._sink.report(explain_cut_expression(event, self._marks))
            return _CutExpression(self._file.between(begin, end))
        return YamlScalar(text, value, self._file, begin, end)

    def _list(self, start: SequenceStartEvent, depth: int) -> YamlNode:
        flow, outer = self._open(start, depth), self._indent
        # The event begins at an anchor, and ends before the first dash, but after a dash at the column of the key.
        if (dash := start.end_mark) and not flow and self._marks.text.startswith("-", dash.index):
            self._indent = dash.column
        items: list[YamlNode] = []
        while not isinstance(event := self._next(), SequenceEndEvent):
            items.append(self._node(event, depth + 1, flow))
        self._indent = outer
        begin, end = self._close(start, event, flow)
        if flow and _is_cut(items):
            return YamlFault(self._file.between(begin, end))
        return YamlList(tuple(items), self._file, begin, end)

    def _map(self, start: MappingStartEvent, depth: int) -> YamlNode:
        flow, outer = self._open(start, depth), self._indent
        pairs: list[tuple[YamlNode, YamlNode]] = []
        while not isinstance(event := self._next(), MappingEndEvent):
            if event and event.start_mark and not flow:
                self._indent = event.start_mark.column
            key = self._key(event, depth + 1, flow)
            pairs.append((key, self._node(self._next(), depth + 1, flow)))
        self._indent = outer
        begin, end = self._close(start, event, flow)
        if flow and any(map(_is_cut, pairs)):
            return YamlFault(self._file.between(begin, end))
        return YamlMap(make_entries(pairs, self._sink, flow=flow, is_top=depth == 1), self._file, begin, end)

    def _key(self, event: events.Event | None, depth: int, flow: bool) -> YamlNode:
        if not isinstance(event, ScalarEvent) or event.anchor is not None or event.tag is not None:
            return self._node(event, depth, flow)
        self._count(1, event)
        return self._text(event, event.value, flow)

    def _open(self, start: events.CollectionStartEvent, depth: int) -> bool:
        """Begin a list or map; return whether it is in flow style."""
        self._count(1, start)
        self._descend(depth, start)
        if start.flow_style:
            self.brackets.append(start)
        return bool(start.flow_style)

    def _close(self, start: events.Event, end: events.Event, flow: bool) -> tuple[int, int]:
        """Return where a list or map begins and ends: at its bracket, or in block style after its last node."""
        begin, closing = start.start_mark, end.end_mark
        assert begin is not None, "the parser marks every event"
        assert closing is not None, "the parser marks every event"
        if flow:
            self.brackets.pop()
            self._end = closing.index
            if closing.line > begin.line and not self.brackets and self._tags is None:
                self._check_lines(begin.index, closing.index)
        return begin.index, self._end

    def _check_lines(self, begin: int, end: int) -> None:
        """Warn about a line of the outermost flow list or map that other parsers do not take for a part of it."""
        if line := find_outdented_line(self._marks.text, begin, end, self._indent):
            spaces = "1 space" if self._indent == 0 else f"{self._indent + 1} spaces"
            place = self._file.between(*line)
            fix = indent_line(place, self._indent + 1)
            self._sink.report(codes.OUTDENTED_LINE.at(place, spaces=spaces).with_fix(fix))
