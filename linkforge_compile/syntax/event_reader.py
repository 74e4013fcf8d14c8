"""Reads any YAML into the positioned tree: libyaml's events straight into our own nodes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
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
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point
from linkforge_compile.syntax.entries import entries_of, plain_entries
from linkforge_compile.syntax.marks import Marks
from linkforge_compile.syntax.nodes import (
    MAX_DEPTH,
    ScalarValue,
    Tags,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
)
from linkforge_compile.syntax.scalars import is_cut_expression, is_overflow, scalar_value

MAX_READ_TWICE = 250_000
"""How many characters a file may have that PyYAML's own parser, which is slow, reads where libyaml cannot."""

# PyYAML may have been built without libyaml; its own parser gives the same events, only slower.
Parser: TypeAlias = type["yaml.BaseLoader | yaml.CBaseLoader"]
PARSER: Parser = getattr(yaml, "CBaseLoader", yaml.BaseLoader)

_Beginning: TypeAlias = ScalarEvent | SequenceStartEvent | MappingStartEvent
"""What a node that is no alias begins with."""

_BEGINNINGS = (ScalarEvent, SequenceStartEvent, MappingStartEvent)


def read_events(marks: Marks, sink: Diagnostics, budget: Budget, tags: Tags | None) -> YamlNode | None:
    """Return the top of the one document of a text without forbidden characters; None where it cannot be read.

    `tags` is None for a spec.
    """
    return _document(marks, sink, budget, tags, PARSER)


def _document(marks: Marks, sink: Diagnostics, budget: Budget, tags: Tags | None, parser: Parser) -> YamlNode | None:
    reader = _Reader(marks, sink, budget, tags, parser)
    root = None
    try:
        root = reader.document()
    except _UnreadableError as unreadable:
        sink.report(unreadable.diagnostic)
    except yaml.MarkedYAMLError as error:
        # `{mass:}` is YAML 1.2, but none to libyaml; what was reported before it is reported again, and kept once.
        is_empty_field = parser is not yaml.BaseLoader and error.problem == "found unexpected ':'"
        if is_empty_field and len(marks.text) <= MAX_READ_TWICE:
            return _document(marks, sink, budget, tags, yaml.BaseLoader)
        from linkforge_compile.syntax.malformed import explain_every

        sink.report_all(explain_every(error, marks, reader.last_scalar, reader.brackets))
    # What stands before a fault was read as well.
    budget.spend(Limit.VALUES, reader.size, marks.file.whole)
    return root


class _UnreadableError(Exception):
    """The rest of the document cannot be read; `diagnostic` says why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(str(diagnostic))


@dataclass(frozen=True)
class _Anchor:
    """An anchored node, its size with every alias in it counted as a copy, and how many levels lie below it."""

    node: YamlNode
    size: int
    height: int


class _Reader:
    """One pass over the events of one document."""

    def __init__(self, marks: Marks, sink: Diagnostics, budget: Budget, tags: Tags | None, parser: Parser) -> None:
        self.size = 0
        """How many nodes there are so far, each alias counted as a copy of its own."""
        self.last_scalar: ScalarEvent | None = None
        self.brackets: list[events.CollectionStartEvent] = []
        """The flow lists and maps that are open."""
        self._budget = budget
        self._most = budget.left(Limit.VALUES)
        self._marks, self._file = marks, marks.file
        self._sink = sink
        self._tags = tags
        self._next: Callable[[], events.Event | None] = parser(marks.text).get_event
        # What words and numbers mean that stand in the file as keys and as values: the same come again and again. There
        # is no blank in any of them, so that it stands on one line and ends with its text.
        self._names: dict[str, ScalarValue] = {}
        self._values: dict[str, ScalarValue] = {}
        self._anchors: dict[str, _Anchor | None] = {}  # None while the anchored node is still being read
        self._deepest = 0
        self._closed = 0  # the index behind the last alias, bracket, or scalar that `_known` did not read
        self._is_any_odd = False  # whether there was an expression in pieces, or a key in braces with nothing behind it

    def document(self) -> YamlNode:
        """Read the document; where there is none, it is null."""
        self._next()  # the stream begins
        if isinstance(self._next(), events.StreamEndEvent):
            return YamlScalar("", None, self._file.whole)
        root = self._node(self._next(), depth=1, flow=False)
        self._next()  # the document ends
        after = self._next()
        if isinstance(after, events.DocumentStartEvent):
            # A part of a robot lacks what stands in the other.
            raise _UnreadableError(codes.SEVERAL_DOCUMENTS.at(self._marks.event(after)))
        return root

    def _known(self, event: events.Event | None, meanings: Mapping[str, ScalarValue]) -> YamlScalar | None:
        """Read a word or a number that stood in the file before, nine nodes of ten; None where it is something else.

        All that is done for each of them is done here: a call takes a tenth of the time of reading it.
        """
        if type(event) is not ScalarEvent:
            return None
        text = event.value
        if text not in meanings or event.style or event.anchor is not None or event.tag is not None:
            return None
        self.size += 1
        if self.size > self._most:
            self._budget.spend(Limit.VALUES, self.size, self._marks.event(event))  # which raises
        self.last_scalar = event
        begin = event.start_mark
        assert begin is not None, "the parser marks every event"
        return YamlScalar(text, meanings[text], self._file, begin.index)

    def _node(self, event: events.Event | None, depth: int, flow: bool) -> YamlNode:
        """Read the node that begins with `event`; `flow` is whether it stands inside [..] or {..}."""
        if type(event) is AliasEvent:
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
        self._closed = self._marks.end(event)
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
        """Read a node that is no alias; a tag that means nothing here makes a fault of the whole."""
        node: YamlNode
        make = None if event.tag is None else self._meaning(event)
        if isinstance(event, MappingStartEvent):
            node = self._map(event, depth)
        elif isinstance(event, SequenceStartEvent):
            node = self._list(event, depth)
        else:
            node = self._scalar(event, flow)
        if event.tag is None or isinstance(node, YamlFault):
            return node
        return make(node) if make and isinstance(node, YamlScalar) else YamlFault(node.span)

    def _meaning(self, event: _Beginning) -> Callable[[YamlScalar], YamlNode] | None:
        """Return what makes something of a scalar's tag; None for one that is reported."""
        if self._tags and isinstance(event, ScalarEvent) and event.tag is not None and event.tag in self._tags:
            return self._tags[event.tag]
        span = self._marks.tag(event)
        if self._tags is None:
            self._sink.report(codes.TAG.at(span, tag=span.text))
        else:
            self._sink.report(codes.OTHER_TAG.at(span, tag=span.text, known=" and ".join(self._tags)))
        return None

    def _descend(self, depth: int, event: events.Event) -> None:
        if depth > MAX_DEPTH:
            raise _UnreadableError(codes.TOO_DEEP.at(self._marks.event(event), limit=MAX_DEPTH))
        self._deepest = max(self._deepest, depth)

    def _scalar(self, event: ScalarEvent, flow: bool) -> YamlScalar | YamlFault:
        text = event.value
        # Raw XML takes as much as so many nodes.
        self._count(1 + text.count("<"), event)
        if event.style:
            return self._text(event, text, flow)
        value = scalar_value(text)
        node = self._text(event, value, flow)
        if value.__class__ is float and is_overflow(text, value):
            self._sink.report(codes.NUMBER_TOO_LARGE.at(node.span))
            return YamlFault(node.span)
        if not text:
            self._is_any_odd |= flow
        elif value.__class__ is not str or text.isidentifier():
            self._values[text] = value
        return node

    def _text(self, event: ScalarEvent, value: ScalarValue, flow: bool) -> YamlScalar | YamlFault:
        """Read a scalar whose text means a value; itself in quotes, and of keys."""
        self.last_scalar = event
        text, (begin, end) = event.value, self._marks.ends(event)
        self._closed = end
        # What stands in the file was looked through; escapes in double quotes can still make anything.
        if event.style == '"' and (forbidden := FORBIDDEN_CHARACTER.search(text)):
            span = self._file.between(begin, end)
            self._sink.report(codes.FORBIDDEN_CHARACTER.at(span, character=code_point(forbidden[0])))
            return YamlFault(span)
        if flow and not event.style and is_cut_expression(text):
            from linkforge_compile.syntax.malformed import explain_cut

            self._sink.report(explain_cut(event, self._marks))
            self._is_any_odd = True
            return _CutExpression(self._file.between(begin, end))
        return YamlScalar(text, value, self._file, begin, end)

    def _list(self, start: SequenceStartEvent, depth: int) -> YamlNode:
        flow = bool(start.flow_style)
        self._count(1, start)
        self._descend(depth, start)
        if flow:
            self.brackets.append(start)
        items: list[YamlNode] = []
        next_event, known, values = self._next, self._known, self._values
        while type(event := next_event()) is not SequenceEndEvent:
            items.append(known(event, values) or self._node(event, depth + 1, flow))
        begin, end = self._ends(start, event, flow)
        if self._is_any_odd and any(isinstance(item, _CutExpression) for item in items):
            return YamlFault(self._file.between(begin, end))
        return YamlList(tuple(items), self._file, begin, end)

    def _map(self, start: MappingStartEvent, depth: int) -> YamlNode:
        flow = bool(start.flow_style)
        self._count(1, start)
        self._descend(depth, start)
        if flow:
            self.brackets.append(start)
        pairs: list[tuple[YamlNode, YamlNode]] = []
        next_event, known, names, values = self._next, self._known, self._names, self._values
        while type(event := next_event()) is not MappingEndEvent:
            key = known(event, names) or self._key(event, depth + 1, flow)
            event = next_event()
            pairs.append((key, known(event, values) or self._node(event, depth + 1, flow)))
        begin, end = self._ends(start, event, flow)
        entries = None if self._is_any_odd else plain_entries(pairs)
        if entries is None:
            if any(isinstance(node, _CutExpression) for pair in pairs for node in pair):
                return YamlFault(self._file.between(begin, end))
            entries = entries_of(pairs, self._sink, flow=flow, is_top=depth == 1)
        return YamlMap(entries, self._file, begin, end)

    def _key(self, event: events.Event | None, depth: int, flow: bool) -> YamlNode:
        if type(event) is not ScalarEvent or event.anchor is not None or event.tag is not None:
            return self._node(event, depth, flow)
        self._count(1, event)
        text = event.value
        if not event.style and text.isidentifier():
            self._names[text] = text
        return self._text(event, text, flow)

    def _ends(self, start: events.Event, end: events.Event, flow: bool) -> tuple[int, int]:
        """Return where a collection begins and ends: with its bracket, or in block style with the last thing in it."""
        begin, closing = start.start_mark, end.end_mark
        assert begin is not None, "the parser marks every event"
        assert closing is not None, "the parser marks every event"
        if flow:
            self.brackets.pop()
            self._closed = closing.index
        elif self.last_scalar is not None and self._marks.are_its_ends(self.last_scalar):
            self._closed = max(self._closed, self._marks.end(self.last_scalar))
        return begin.index, self._closed


class _CutExpression(YamlFault):
    """An expression that a comma cut in pieces: they are no items, the flow list or map around them is at fault."""

    __slots__ = ()
