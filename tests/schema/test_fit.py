"""The quick yes and the silence of jsonschema are the same, for every spec of the repository and what is near them."""

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.schema import faults, validate, validator
from linkforge_compile.schema.fit import Fit, fit_of
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlList, YamlMap, YamlScalar, read
from linkforge_compile.syntax.nodes import YamlEntry, YamlNode

ROOT = Path(__file__).parents[2]
SPECS = sorted(path for folder in ("tests/cases", "examples") for path in (ROOT / folder).rglob("*.yaml"))
NEIGHBOURS = 8


def tree_of(path: Path) -> YamlMap | None:
    """Return the tree of a file; None where its text is at fault already."""
    sink = Diagnostics()
    try:
        tree = read(SourceFile(path.name, path.read_text("utf-8", "replace")), sink)
    except BeyondLimitError:
        return None
    return None if sink.has_errors else tree


TREES = {path.relative_to(ROOT).as_posix(): tree for path in SPECS if (tree := tree_of(path))}


def told_by_jsonschema(tree: YamlMap, monkeypatch: pytest.MonkeyPatch, *, is_included: bool) -> list[str]:
    sink = Diagnostics()
    with monkeypatch.context() as patched:
        patched.setattr(validator, "_is_right", lambda *_: False)
        patched.setattr(faults, "_is_in_reserved_name", lambda _: False)  # told by a later stage
        validate(tree, sink, is_included=is_included)
    return [str(diagnostic) for diagnostic in sink]


@pytest.mark.parametrize("is_included", [False, True])
@pytest.mark.parametrize("name", TREES)
def test_a_file_is_right_where_jsonschema_tells_nothing(name, is_included, monkeypatch):
    tree = TREES[name]
    assert validator._is_right(tree, is_included) == (
        not told_by_jsonschema(tree, monkeypatch, is_included=is_included)
    )


def nodes_in(node: YamlNode) -> Iterator[YamlNode]:
    yield node
    for inner in node if isinstance(node, YamlList) else ():
        yield from nodes_in(inner)
    for entry in node if isinstance(node, YamlMap) else ():
        yield from nodes_in(entry.value)


def neighbour(tree: YamlMap, strangers: list[YamlNode], chance: random.Random) -> YamlMap:
    """Return the tree with one of its nodes in another's place, or a key in another's."""
    changed = chance.randrange(sum(1 for _ in nodes_in(tree)) - 1)
    left = changed

    def with_stranger(node: YamlNode) -> YamlNode:
        nonlocal left
        if left == 0:
            left = -1
            return chance.choice(strangers)
        left -= 1
        if isinstance(node, YamlList):
            return YamlList(tuple(map(with_stranger, node)), node.span)
        return in_map(node) if isinstance(node, YamlMap) else node

    def in_map(node: YamlMap) -> YamlMap:
        entries = [YamlEntry(entry.key, with_stranger(entry.value)) for entry in node]
        if entries and chance.random() < 0.02:
            other = YamlScalar("vsual", "vsual", node.span)
            entries[0] = YamlEntry(other, entries[0].value)
        return YamlMap({entry.name: entry for entry in entries}, node.span)

    return in_map(tree)


@pytest.mark.parametrize("name", [name for name, tree in TREES.items() if validator._is_right(tree, False)])
def test_what_the_quick_judge_lets_through_jsonschema_lets_through(name, monkeypatch):
    chance = random.Random(name)
    odd = [YamlScalar(str(value), value, TREES[name].span) for value in (None, True, 1, 1.5, "", "$(x)", "3 mm", "box")]
    strangers = odd + list(nodes_in(TREES[name]))
    disagreed = []
    for _ in range(NEIGHBOURS):
        tree = neighbour(TREES[name], strangers, chance)
        if validator._is_right(tree, False):
            disagreed += told_by_jsonschema(tree, monkeypatch, is_included=False)
    assert not disagreed


def test_a_keyword_that_nobody_judges_is_no_yes():
    with pytest.raises(ValueError, match="multipleOf"):
        Fit({"type": "number", "multipleOf": 2})


def test_a_choice_that_says_more_itself_is_no_yes():
    with pytest.raises(ValueError, match="minItems"):
        fit_of({"anyOf": [{"type": "array"}, {"type": "string"}], "minItems": 2})
