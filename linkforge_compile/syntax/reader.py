"""Reads a spec's text into the positioned tree: libyaml's events straight into our own nodes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

import yaml
from yaml import events

from linkforge_compile.bounds import Budget, Limit
from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes import syntax as codes
from linkforge_compile.frozen import dataclass
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point
from linkforge_compile.syntax.entries import STUCK, entries_of, kind_of
from linkforge_compile.syntax.marks import Marks
from linkforge_compile.syntax.nodes import ScalarValue, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.scalars import is_cut_expression, is_overflow, scalar_value

MAX_DEPTH = 100
"""How deep lists and maps may nest: every later stage walks the tree by recursion."""

MAX_READ_TWICE = 250_000
"""How many characters a file may have that PyYAML's own parser, which is slow, reads where libyaml cannot."""

# PyYAML may have been built without libyaml; its own parser gives the same events, only slower.
Parser: TypeAlias = type["yaml.BaseLoader | yaml.CBaseLoader"]
PARSER: Parser = getattr(yaml, "CBaseLoader", yaml.BaseLoader)

Tags: TypeAlias = Mapping[str, Callable[[YamlScalar], YamlNode]]
"""What a scalar with a tag becomes, by the tag; a fault of it is for the function to report."""


def read(file: SourceFile, sink: Diagnostics, budget: Budget | None = None) -> YamlMap | None:
    """Read the one YAML document of a file; None where its text or its top level is at fault, which is reported.

    A node at fault becomes a YamlFault, as does what a repeated key says, and reading goes on; only malformed YAML ends
    it.
    What it holds is counted in the budget, each alias as a copy of its own; without one it is a compile by itself.
    """
    root = _root(file, sink, budget or Budget(), None)
    if root is None or isinstance(root, YamlMap):
        return root
    _report_top_level(root, sink)
    return None


def read_data(file: SourceFile, sink: Diagnostics, tags: Tags, budget: Budget | None = None) -> YamlNode | None:
    """Read a file of data, which may be of any shape and hold `tags`, but no others; None as for `read`."""
    root = _root(file, sink, budget or Budget(), tags)
    if isinstance(root, YamlScalar) and root.value is None:
        sink.report(codes.EMPTY_DATA.at(file.whole))
        return None
    return root


def _root(file: SourceFile, sink: Diagnostics, budget: Budget, tags: Tags | None) -> YamlNode | None:
    """Return the top of the one document, None where the text cannot be read; `tags` is None for a spec."""
    marks = Marks(file, file.text.removeprefix("\ufeff"))
    if forbidden := FORBIDDEN_CHARACTER.search(marks.text):
        span = marks.part(forbidden.start(), 1)
        sink.report(codes.FORBIDDEN_CHARACTER.at(span, character=code_point(forbidden[0])))
        return None
    return _document(marks, sink, budget, tags, PARSER)


def _document(marks: Marks, sink: Diagnostics, budget: Budget, tags: Tags | None, parser: Parser) -> YamlNode | None:
    reader = _Reader(marks, sink, budget, tags, parser)
    try:
        root = reader.document()
        budget.spend(Limit.VALUES, reader.size, marks.file.whole)
        return root
    except _UnreadableError as unreadable:
        sink.report(unreadable.diagnostic)
    except yaml.MarkedYAMLError as error:
        # `{mass:}` is YAML 1.2, but none to libyaml; what was reported before it is reported again, and kept once.
        is_empty_field = parser is not yaml.BaseLoader and error.problem == "found unexpected ':'"
        if is_empty_field and len(marks.text) <= MAX_READ_TWICE:
            return _document(marks, sink, budget, tags, yaml.BaseLoader)
        from linkforge_compile.syntax.malformed import explain_every

        sink.report_all(explain_every(error, marks, reader.last_scalar))
    return None


def _report_top_level(root: YamlNode, sink: Diagnostics) -> None:
    if isinstance(root, YamlScalar) and root.value is None:
        sink.report(codes.EMPTY_DOCUMENT.at(root.span.file.whole))
    elif isinstance(root, YamlScalar) and STUCK.fullmatch(root.text):
        sink.report(codes.SPACE_AFTER_COLON.at(root.span, text=root.text))
    elif not isinstance(root, YamlFault):
        sink.report(codes.TOP_LEVEL_NOT_MAP.at(root.span, found=kind_of(root)))


class _UnreadableError(Exception):
    """The rest of the document cannot be read; `diagnostic` says why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(str(diagnostic))


@dataclass(frozen=True, slots=True)
class _Anchor:
    """An anchored node, its size with every alias in it counted as a copy, and how many levels lie below it."""

    node: YamlNode
    size: int
    height: int


class _Reader:
    """One pass over the events of one document."""

    def __init__(self, marks: Marks, sink: Diagnostics, budget: Budget, tags: Tags | None, parser: Parser) -> None:
        self.last_scalar: events.ScalarEvent | None = None
        self.size = 0
        """How many nodes there are so far, each alias counted as a copy of its own."""
        self._budget = budget
        self._most = budget.left(Limit.VALUES)
        self._marks = marks
        self._sink = sink
        self._tags = tags
        self._parser = parser(marks.text)
        self._values: dict[str, ScalarValue] = {}  # of plain texts: the same numbers come again and again
        self._anchors: dict[str, _Anchor | None] = {}  # None while the anchored node is still being read
        self._deepest, self._is_any_cut = 0, False
        self._latest = marks.file.whole  # what was read last: with it end the block lists and maps around it

    def document(self) -> YamlNode:
        """Read the document; where there is none, it is null."""
        self._next()  # the stream begins
        if isinstance(self._next(), events.StreamEndEvent):
            return YamlScalar("", None, self._marks.file.whole)
        root = self._node(self._next(), depth=1, flow=False)
        self._next()  # the document ends
        after = self._next()
        if isinstance(after, events.DocumentStartEvent):
            # A part of a robot lacks what stands in the other.
            raise _UnreadableError(codes.SEVERAL_DOCUMENTS.at(self._marks.event(after)))
        return root

    def _next(self) -> events.Event:
        event = self._parser.get_event()
        assert event is not None, "nothing is asked for behind the end of the stream"
        return event

    def _node(self, event: events.Event, depth: int, flow: bool) -> YamlNode:
        """Read the node that begins with `event`; `flow` is whether it stands inside [..] or {..}."""
        if isinstance(event, events.ScalarEvent) and event.anchor is None and event.tag is None:
            return self._scalar(event, flow)  # nine nodes of ten
        if isinstance(event, events.AliasEvent):
            return self._alias(event, depth)
        assert isinstance(event, events.ScalarEvent | events.CollectionStartEvent)
        if event.anchor is None:
            return self._untagged(event, depth, flow)
        size_before, deepest_outside = self.size, self._deepest
        self._anchors[event.anchor] = None
        self._deepest = depth
        node = self._untagged(event, depth, flow)
        self._anchors[event.anchor] = _Anchor(node, self.size - size_before, self._deepest - depth)
        self._deepest = max(deepest_outside, self._deepest)
        return node

    def _count(self, nodes: int, event: events.Event) -> None:
        self.size += nodes
        if self.size > self._most:
            raise self._budget.beyond(Limit.VALUES, self._marks.event(event))

    def _alias(self, event: events.AliasEvent, depth: int) -> YamlNode:
        name, span = event.anchor, self._marks.event(event)
        self._latest = span
        if name not in self._anchors:
            self._sink.report(codes.UNKNOWN_ANCHOR.at(span, name=name, near=self._anchors))
            return YamlFault(span)
        anchor = self._anchors[name]
        if anchor is None:
            self._sink.report(codes.RECURSIVE_ALIAS.at(span, name=name))
            return YamlFault(span)
        self._count(anchor.size, event)
        self._descend(depth + anchor.height, span)
        return anchor.node

    def _untagged(self, event: events.ScalarEvent | events.CollectionStartEvent, depth: int, flow: bool) -> YamlNode:
        """Read a node that is no alias; a tag that means nothing here makes a fault of the whole."""
        node: YamlNode
        make = self._meaning(event)
        if isinstance(event, events.ScalarEvent):
            node = self._scalar(event, flow)
        elif isinstance(event, events.SequenceStartEvent):
            node = self._list(event, depth)
        else:
            assert isinstance(event, events.MappingStartEvent)
            node = self._map(event, depth)
        if event.tag is None or isinstance(node, YamlFault):
            return node
        return make(node) if make and isinstance(node, YamlScalar) else YamlFault(node.span)

    def _meaning(
        self, event: events.ScalarEvent | events.CollectionStartEvent
    ) -> Callable[[YamlScalar], YamlNode] | None:
        """Return what makes something of a scalar's tag, None for no tag and for one that is reported."""
        if event.tag is None:
            return None
        if self._tags and isinstance(event, events.ScalarEvent) and event.tag in self._tags:
            return self._tags[event.tag]
        span = self._marks.tag(event)
        if self._tags is None:
            self._sink.report(codes.TAG.at(span, tag=span.text))
        else:
            self._sink.report(codes.OTHER_TAG.at(span, tag=span.text, known=" and ".join(self._tags)))
        return None

    def _descend(self, depth: int, span: Span) -> None:
        if depth > MAX_DEPTH:
            raise _UnreadableError(codes.TOO_DEEP.at(span, limit=MAX_DEPTH))
        self._deepest = max(self._deepest, depth)

    def _scalar(self, event: events.ScalarEvent, flow: bool) -> YamlScalar | YamlFault:
        text = event.value
        # Raw XML takes as much as so many nodes.
        self._count(1 + text.count("<"), event)
        if event.style:
            return self._text(event, text, flow)
        if text not in self._values:
            self._values[text] = scalar_value(text)
        value = self._values[text]
        node = self._text(event, value, flow)
        if value.__class__ is float and is_overflow(text, value):
            self._sink.report(codes.NUMBER_TOO_LARGE.at(node.span))
            return YamlFault(node.span)
        return node

    def _text(self, event: events.ScalarEvent, value: ScalarValue, flow: bool) -> YamlScalar | YamlFault:
        """Read a scalar whose text means a value; itself in quotes, and of keys."""
        self.last_scalar = event
        text, span = event.value, self._marks.scalar(event)
        self._latest = span
        # What stands in the file was looked through; escapes in double quotes can still make anything.
        if event.style == '"' and (forbidden := FORBIDDEN_CHARACTER.search(text)):
            self._sink.report(codes.FORBIDDEN_CHARACTER.at(span, character=code_point(forbidden[0])))
            return YamlFault(span)
        if flow and not event.style and is_cut_expression(text):
            from linkforge_compile.syntax.malformed import explain_cut

            self._sink.report(explain_cut(event, self._marks))
            self._is_any_cut = True
            return _CutExpression(span)
        return YamlScalar(text, value, span)

    def _list(self, start: events.SequenceStartEvent, depth: int) -> YamlNode:
        begin, flow = self._marks.event(start), bool(start.flow_style)
        self._count(1, start)
        self._descend(depth, begin)
        items: list[YamlNode] = []
        while not isinstance(event := self._next(), events.SequenceEndEvent):
            items.append(self._node(event, depth + 1, flow))
        span = self._until(event, begin, flow)
        if self._is_any_cut and any(isinstance(item, _CutExpression) for item in items):
            return YamlFault(span)
        return YamlList(tuple(items), span)

    def _map(self, start: events.MappingStartEvent, depth: int) -> YamlNode:
        begin, flow = self._marks.event(start), bool(start.flow_style)
        self._count(1, start)
        self._descend(depth, begin)
        entries: list[tuple[YamlNode, YamlNode]] = []
        while not isinstance(event := self._next(), events.MappingEndEvent):
            key = self._key(event, depth + 1, flow)
            entries.append((key, self._node(self._next(), depth + 1, flow)))
        span = self._until(event, begin, flow)
        if self._is_any_cut and any(isinstance(node, _CutExpression) for entry in entries for node in entry):
            return YamlFault(span)
        return YamlMap(entries_of(entries, self._sink, flow=flow, is_top=depth == 1), span)

    def _key(self, event: events.Event, depth: int, flow: bool) -> YamlNode:
        if isinstance(event, events.ScalarEvent) and event.anchor is None and event.tag is None:
            self._count(1, event)
            return self._text(event, event.value, flow)
        return self._node(event, depth, flow)

    def _until(self, end: events.Event, begin: Span, flow: bool) -> Span:
        """Return the span of a collection: up to its bracket, or in block style up to the last thing in it."""
        if flow:
            self._latest = self._marks.event(end)
        return Span(begin.file, begin.line, begin.column, self._latest.end_line, self._latest.end_column)


class _CutExpression(YamlFault):
    """An expression that a comma cut in pieces: they are no items, the flow list or map around them is at fault."""

    __slots__ = ()
