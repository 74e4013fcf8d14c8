"""Fixes that leave out, add, move or exchange entries and items of YAML, in both styles."""

from collections.abc import Sequence

import pytest

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.entry_fixes import (
    add_entry,
    add_to_short_form,
    as_items,
    exchange,
    leave_out,
    leave_out_all,
    leave_out_item,
    move_entry,
)
from linkforge_compile.diagnostics.fix import Fix, apply_edits
from linkforge_compile.source import SourceFile, SourceRef
from linkforge_compile.syntax import YamlMap
from linkforge_compile.syntax.reader import read


def read_text(text: str) -> SourceRef:
    tree = read(SourceFile("case.robot.yaml", text), Diagnostics())
    assert isinstance(tree, YamlMap)
    return SourceRef(tree)


def applied(ref: SourceRef, fix: Fix | None) -> str | None:
    return apply_edits(ref.span.file, fix.edits) if fix else None


@pytest.mark.parametrize(
    ("text", "path", "after"),
    [
        ("{a: 1, b: 2, c: 3}", "a", "{b: 2, c: 3}"),
        ("{a: 1, b: 2, c: 3}", "b", "{a: 1, c: 3}"),
        ("{a: 1, b: 2, c: 3}", "c", "{a: 1, b: 2}"),
        ("{a: {b: 1}}", "a.b", "{a: {}}"),
        ("{a: 1,\n b: [1, 2] # why\n, c: 3}", "b", "{a: 1 # why\n, c: 3}"),
        ("a: 1\nb: 2\n", "a", "b: 2\n"),
        ("a: 1\nb: 2", "b", "a: 1\n"),
        ("a: 1\r\nb: 2   # two\r\nc: 3\r\n", "b", "a: 1\r\nc: 3\r\n"),
        ("a:\n  b:\n    - 1\n    - 2\n  # about c\n  c: 3\n", "a.b", "a:\n  # about c\n  c: 3\n"),
        ("a:\n  - b: 1\n    c: 2\n  - b: 3\n", "a.0.b", "a:\n  - c: 2\n  - b: 3\n"),
        ("a:\n  - b: 1\n    c: 2\n  - b: 3\n", "a.0.c", "a:\n  - b: 1\n  - b: 3\n"),
    ],
)
def test_an_entry_is_left_out_with_what_separates_it(text: str, path: str, after: str):
    ref = read_text(text)
    steps: list[str | int] = [int(step) if step.isdigit() else step for step in path.split(".")]
    assert applied(ref, leave_out(ref, *steps)) == after


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("a:\n  - b: 1\n  - b: 3\n", ("a", 0, "b")),  # nothing of the item would be left
        ("a: &x {b: 1}\nc: *x\n", ("c",)),  # the value is written at the anchor
        ("a: 1\n", ("b",)),
        ("{a: 1, b: 2 # two,\n  , # three,\n c: 3}", ("c",)),  # the comma before it is in a comment
    ],
)
def test_an_entry_that_is_not_alone_in_its_place_stays(text: str, path: Sequence[str | int]):
    assert leave_out(read_text(text), *path) is None


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("{a: 1, b: 2, c: 3}", "{c: 3}"),
        ("{c: 3, a: 1, b: 2}", "{c: 3}"),
        ("{a: 1, c: 3, b: 2}", "{c: 3}"),
        ("{a: 1, b: 2}", "{}"),
        ("a: 1\nb: 2\nc: 3\n", "c: 3\n"),
        ("a: 1\nc: 3\nb: 2\n", "c: 3\n"),
    ],
)
def test_several_entries_are_left_out_together(text: str, after: str):
    ref = read_text(text)
    assert applied(ref, leave_out_all(ref, [["a"], ["b"]], "leave out both")) == after


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("a: [x, y, x]\n", "a: [x, y]\n"),
        ("a: [x, y,\n    x]\n", "a: [x, y]\n"),
        ("a:\n  - x\n  - y\n  - x   # again\nb: 1\n", "a:\n  - x\n  - y\nb: 1\n"),
    ],
)
def test_an_item_is_left_out(text: str, after: str):
    ref = read_text(text)
    item = ref.at("a", 2)
    assert applied(ref, leave_out_item(item, "remove it")) == after


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("a: {type: ray, link: base}\n", "a: {type: ray, lidar: {}, link: base}\n"),
        ("a: {link: base, type: ray}\n", "a: {link: base, type: ray, lidar: {}}\n"),
        ("a:\n  type: ray   # old\n  link: base\n", "a:\n  type: ray   # old\n  lidar: {}\n  link: base\n"),
        ("a:\r\n  type: ray", "a:\r\n  type: ray\r\n  lidar: {}"),
        ("a: {link: base}\n", "a: {lidar: {}, link: base}\n"),
        ("a:\n  link: base\n", "a:\n  lidar: {}\n  link: base\n"),
        ("a: {}\n", "a: {lidar: {}}\n"),
        ("a: {lidar: {samples: 3}}\n", None),
        ("a:\n", None),
    ],
)
def test_an_entry_is_added_after_another_one_or_first(text: str, after: str | None):
    ref = read_text(text)
    assert applied(ref, add_entry(ref, "a", entry="lidar: {}", after="type")) == after


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("a: base.stl\n", "a: {file: base.stl, scale: 0.001}\n"),
        ("a: {file: base.stl}\n", "a: {file: base.stl, scale: 0.001}\n"),
        ("a:\n  file: base.stl\n", "a:\n  file: base.stl\n  scale: 0.001\n"),
        ("a: {file: base.stl, scale: 2}\n", None),
    ],
)
def test_a_short_form_gets_a_second_entry(text: str, after: str | None):
    whole = read_text(text)
    node = whole.node.child("a")
    assert node is not None
    assert applied(whole, add_to_short_form(SourceRef(node), "file", "scale: 0.001")) == after


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("mount: {x: 1}\n", "joints: {x: 1}\n"),
        ("mount: {x: 1, y: 2}\n", "mount: {y: 2}\njoints: {x: 1}\n"),
        ("mount:\n  x: 1\n  y: 2\njoints:\n  z: 3\n", "mount:\n  y: 2\njoints:\n  x: 1\n  z: 3\n"),
    ],
)
def test_an_entry_moves_to_another_section(text: str, after: str):
    ref = read_text(text)
    is_only = "y:" not in text.partition("joints")[0]
    assert applied(ref, move_entry(ref, "mount", "x", "joints", is_only=is_only)) == after


def test_two_values_are_exchanged():
    ref = read_text("base_link: tip\ntip_link: 'my base'\n")
    fix = exchange("swap them", ref.at("base_link"), ref.at("tip_link"))
    assert applied(ref, fix) == "base_link: 'my base'\ntip_link: tip\n"
    assert exchange("swap them", ref.at("base_link"), ref.at("base_link")) is None


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("a: {b: 1, c: [2, 3]}\n", "a: [{b: 1}, {c: [2, 3]}]\n"),
        ("a: { b: 1,\n  c: 2 }\n", "a: [{b: 1}, {c: 2}]\n"),
        ("a:\n  b:\n    d: 1\n\n  c: 2   # two\n", "a:\n  - b:\n      d: 1\n\n  - c: 2   # two\n"),
    ],
)
def test_a_map_becomes_a_list(text: str, after: str):
    ref = read_text(text)
    node = ref.node.child("a")
    assert isinstance(node, YamlMap)
    entries = [(entry.key.span, entry.value.span) for entry in node]
    assert applied(ref, as_items(entries, "write a list")) == after


@pytest.mark.parametrize("text", ["a: [{b: 1, c: 2}]\n", "a:\n  - {b: 1, c: 2}\n", "a:\n  - b: 1\n    c: 2\n"])
def test_an_item_does_not_become_a_list(text: str):
    items = read_text(text).node.child("a")
    node = items.child(0) if items is not None else None
    assert isinstance(node, YamlMap)
    assert as_items([(entry.key.span, entry.value.span) for entry in node], "write a list") is None
