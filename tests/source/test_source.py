"""Spans, files, and the way back from a value to its text."""

import copy
import pickle
from dataclasses import dataclass, replace

from linkforge_compile.source import Key, Position, Sourced, SourceFile, SourceRef, Span


@dataclass(frozen=True)
class Leaf:
    """The smallest tree that a reference can point into."""

    span: Span
    children: tuple[tuple[str | int, "Leaf"], ...] = ()

    def child(self, key: str | int) -> "Leaf | None":
        return dict(self.children).get(key)

    def key_span(self, key: str) -> Span | None:
        return span(7, 7, len(key)) if key in dict(self.children) else None


FILE = SourceFile("arm.robot.yaml", "links:\r\n  base: {mass: 3}\n")


def span(line: int, column: int, length: int) -> Span:
    return Span(FILE, line, column, line, column + length)


def test_lines_are_counted_from_one_and_end_at_any_line_end():
    assert FILE.line(1) == "links:"
    assert FILE.line(2) == "  base: {mass: 3}"
    assert FILE.line(99) == ""


def test_a_span_reads_as_editors_and_compilers_write_it():
    assert str(span(2, 9, 4)) == "arm.robot.yaml:2:9"
    assert span(2, 9, 4).start == Position(2, 9)
    assert span(2, 9, 4).end == Position(2, 13)


def test_a_part_of_a_span_keeps_its_line():
    assert span(2, 9, 20).within(4, 3) == span(2, 13, 3)


def test_a_stretch_of_text_has_its_lines_whatever_they_end_with_and_ends_with_the_text():
    file = SourceFile("ends", "\ufeffa\rbc\r\n\nd")
    places = [file.between(index, index + 1) for index in range(8)]
    assert [(at.line, at.column) for at in places] == [(1, 1), (1, 2), (2, 1), (2, 2), (2, 3), (2, 4), (3, 1), (4, 1)]
    assert file.between(2, 99) == Span(file, 2, 1, 4, 2)


def test_spans_sort_by_reading_order_of_their_files():
    module = SourceFile("a_module.robot.yaml", "", order=1)
    spans = [Span(module, 1, 1, 1, 1), span(2, 1, 1), span(1, 5, 1)]
    assert sorted(spans, key=lambda one: one.order) == [spans[2], spans[1], spans[0]]


LIMITS = Leaf(span(2, 20, 10), (("upper", Leaf(span(2, 25, 3))),))
JOINT = Leaf(span(2, 9, 30), (("limits", LIMITS),))


def test_a_reference_finds_the_deepest_node_that_exists():
    elbow = SourceRef(JOINT, key=Leaf(span(2, 3, 4)))
    assert elbow.span == span(2, 3, 4)
    assert elbow.at("limits", "upper") == span(2, 25, 3)
    assert elbow.at("limits", "lower") == LIMITS.span
    assert elbow.at("mimic", "joint") == elbow.span


def test_a_path_may_end_at_a_key_itself():
    elbow = SourceRef(JOINT, key=Leaf(span(2, 3, 4)))
    assert elbow.at("limits", Key("upper")) == span(7, 7, 5)
    assert elbow.at("limits", Key("lower")) == LIMITS.span


def test_a_thing_without_a_name_is_placed_at_its_node():
    assert SourceRef(JOINT).at("axis") == JOINT.span


@dataclass(frozen=True)
class Thing(Sourced):
    """A value of the IR in small."""

    size: float


def test_a_source_is_carried_along_and_never_compared():
    written = Thing(1.0).with_source(SourceRef(JOINT))
    assert written == Thing(1.0)
    assert hash(written) == hash(Thing(1.0))
    assert replace(written, size=2.0).source is None  # nobody wrote that
    assert "source" not in repr(written)


def test_copies_share_the_text_and_pickles_keep_the_place():
    written = Thing(1.0).with_source(SourceRef(JOINT))
    assert copy.deepcopy(written).source is written.source
    back = pickle.loads(pickle.dumps(written))
    assert str(back.source.at("limits", "upper")) == "arm.robot.yaml:2:25"
