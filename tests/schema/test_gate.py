"""What the gate accepts is valid to jsonschema: every spec of the repository, what is near them, and drawn specs."""

import json
import math
import random
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import jsonschema_rs
import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft7Validator

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.schema import registry, validate
from linkforge_compile.schema.registry import accepts, linked, linked_schema_text, plain, whole_schema
from linkforge_compile.schema.shapes import shapes
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER
from linkforge_compile.syntax import YamlList, YamlMap, YamlScalar, read
from linkforge_compile.syntax.nodes import MAX_DEPTH, YamlEntry, YamlFault, YamlNode
from tests.specs import specs

ROOT = Path(__file__).parents[2]
SPECS = sorted(path for folder in ("tests/cases", "examples") for path in (ROOT / folder).rglob("*.yaml"))


def tree_of(text: str) -> YamlMap | None:
    """Return the tree of a text; None for one that is no map, or too long."""
    try:
        return read(SourceFile("arm.robot.yaml", text), Diagnostics())
    except BeyondLimitError:
        return None


@cache
def trees() -> dict[str, YamlMap]:
    """Return the tree of each spec of the repository, by its path."""
    texts = {path.relative_to(ROOT).as_posix(): path.read_text("utf-8", "replace") for path in SPECS}
    return {name: tree for name, text in texts.items() if (tree := tree_of(text))}


FILE = SourceFile("arm.robot.yaml", "linkforge: 1\n")
SPAN = Span(FILE, 1, 1, 1, 2)


def scalar(value: object) -> YamlScalar:
    return YamlScalar(str(value), value, SPAN)


ODD = [scalar(value) for value in (None, True, 0, 1, 2.0, 1.5, math.inf, math.nan, 10**308, 10**40, -(10**40))]
ODD += [
    scalar(text) for text in ("", "$(x)", "${x}", "3 mm", "3\N{NO-BREAK SPACE}mm", "٣ mm", "3 mm\n", "box", "visual")
]
ODD += [YamlMap({}, SPAN), YamlList((), SPAN), YamlFault(SPAN)]


def nodes_in(node: YamlNode) -> Iterator[YamlNode]:
    yield node
    for inner in node if isinstance(node, YamlList) else ():
        yield from nodes_in(inner)
    for entry in node if isinstance(node, YamlMap) else ():
        yield from nodes_in(entry.value)


def neighbour(tree: YamlMap, chance: random.Random) -> YamlMap:
    """Return the tree with one of its nodes replaced by another of it, or an odd one, and at times a key renamed."""
    strangers = [*ODD, *nodes_in(tree)]
    left = chance.randrange(max(1, len(strangers) - len(ODD) - 1))

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
            entries[0] = YamlEntry(scalar(chance.choice(["vsual", "for", "value", "0", "0\n"])), entries[0].value)
        return YamlMap({entry.name: entry for entry in entries}, node.span)

    return in_map(tree)


def is_sound(tree: YamlMap) -> bool:
    """Whether jsonschema finds no error in a tree, and in any section of it, that the gate accepts."""
    parts = [(linked(), tree)]
    parts += [(shapes().under(entry.name).schema, entry.value) for entry in tree if entry.name in shapes().keys]
    return all(Draft7Validator(schema).is_valid(plain(node)) for schema, node in parts if accepts(schema, node))


def test_what_the_gate_accepts_of_a_spec_is_valid():
    assert [name for name, tree in trees().items() if not is_sound(tree)] == []


@given(st.deferred(lambda: st.sampled_from(sorted(trees()))), st.randoms(use_true_random=False))
def test_what_the_gate_accepts_of_a_spec_that_was_changed_is_valid(name: str, chance: random.Random):
    assert is_sound(neighbour(trees()[name], chance))


@given(specs(), st.randoms(use_true_random=False))
def test_what_the_gate_accepts_of_a_drawn_spec_is_valid(spec: dict[str, object], chance: random.Random):
    tree = tree_of(json.dumps(spec))
    assert tree is not None
    assert is_sound(tree)
    assert is_sound(neighbour(tree, chance))


def test_the_gate_accepts_every_example():
    """Those that it does not accept are compiled as well, but wait for jsonschema."""
    examples = {name: tree for name, tree in trees().items() if name.startswith("examples/")}
    robots = {name: tree for name, tree in examples.items() if "linkforge" in tree.entries}
    assert robots
    assert [name for name, tree in robots.items() if not accepts(linked(), tree)] == []


def test_the_gate_accepts_as_deep_a_spec_as_is_read():
    depth = MAX_DEPTH - 1
    tree = tree_of(f"linkforge: 1\nname: arm\nx-deep: {'[' * depth}{']' * depth}\n")
    assert tree is not None
    assert accepts(linked(), tree)


@pytest.mark.parametrize("odd", [YamlFault(SPAN), scalar(math.inf), scalar("3"), scalar(None)], ids=str)
def test_the_gate_does_not_accept(odd: YamlNode):
    mass = YamlMap({"mass": YamlEntry(scalar("mass"), odd)}, SPAN)
    assert not accepts(shapes().under("links").under("arm").under("inertial").schema, mass)


@pytest.mark.parametrize("value", ["", "~", ".inf", "-.inf", ".nan", "1e400"])
def test_what_the_gate_does_not_accept_may_be_right(value: str):
    sink = Diagnostics()
    tree = tree_of(f"linkforge: 1\nname: arm\nlinks: {{base: {{inertial: {{mass: {value}}}}}}}\n")
    assert tree is not None
    assert validate(tree, sink) is tree
    assert not list(sink)


# jsonschema searches with Python's engine. To that of jsonschema-rs, U+FEFF is a space, U+001C to U+001F and U+0085 are
# none, and only 0 to 9 are digits; no text holds a FORBIDDEN_CHARACTER, and that it does not take a digit is sound.


def patterns_in(node: object) -> Iterator[str]:
    if isinstance(node, list):
        for item in node:
            yield from patterns_in(item)
    if isinstance(node, dict):
        if isinstance(node.get("pattern"), str):
            yield node["pattern"]
        for key, value in node.items():
            if key == "patternProperties":
                yield from value
            yield from patterns_in(value)


PATTERNS = sorted(set(patterns_in(whole_schema())))


@cache
def characters() -> list[str]:
    """Return all that may be a space or a digit to one of the engines, and some others."""
    odd = "µμ°º˚é\N{ZERO WIDTH SPACE}"
    every = map(chr, range(sys.maxunicode + 1))
    looked_at = (one for one in every if one.isascii() or one.isspace() or one.isdecimal() or one in odd)
    return [one for one in looked_at if not FORBIDDEN_CHARACTER.match(one)]


NEAR = ["3 mm", "-.5e3mm", "$(x)", "${x}", "$$", "x-a", "12", ""]


def is_sound_pattern(pattern: str, text: str) -> bool:
    gate = jsonschema_rs.Draft7Validator({"pattern": pattern}, pattern_options=jsonschema_rs.RegexOptions())
    return bool(re.search(pattern, text)) or not gate.is_valid(text)


def test_the_language_has_patterns():
    assert len(PATTERNS) > 3


@pytest.mark.parametrize("pattern", PATTERNS)
def test_a_text_that_the_gate_finds_a_pattern_in_has_it(pattern: str):
    gate = jsonschema_rs.Draft7Validator({"pattern": pattern}, pattern_options=jsonschema_rs.RegexOptions())
    for text in NEAR:
        for at in range(len(text) + 1):
            texts = [f"{text[:at]}{character}{text[at:]}" for character in characters()]
            assert [each for each in texts if gate.is_valid(each) and not re.search(pattern, each)] == []


@pytest.mark.parametrize("pattern", PATTERNS)
@given(st.text(st.sampled_from("0٣.eE+-kgµ°${(}) \n\t\N{NO-BREAK SPACE}x"), max_size=12))
def test_any_text_that_the_gate_finds_a_pattern_in_has_it(pattern: str, text: str):
    assert is_sound_pattern(pattern, text)


@pytest.mark.parametrize(
    ("text", "fits"),
    [("a", True), ("", True), ("$", True), ("a$b$$", True), ("$(a){", True), ("${a}", False), ("a$${b", False)],
)
def test_a_name_holds_no_expression_of_xacro(text: str, *, fits: bool):
    links = tree_of(f"linkforge: 1\nname: arm\njoints: {{a: {{parent: '{text}'}}}}\n")
    assert links is not None
    assert accepts(linked(), links) is fits


# The schema that a wheel holds ready


def test_what_is_read_from_an_installed_package_is_what_is_made_of_the_schemas(tmp_path, monkeypatch):
    file = tmp_path / "linked_schema.json"
    file.write_text(linked_schema_text(), "utf-8")
    monkeypatch.setattr(registry, "linked_schema_file", lambda: file)
    monkeypatch.setattr(registry, "schemas_folder", lambda: tmp_path / "nowhere")
    assert registry.whole_schema.__wrapped__() == whole_schema()


def test_the_whole_schema_refers_to_nothing_outside():
    references = set(re.findall(r'"\$ref": "([^"]*)"', linked_schema_text()))
    names = {reference.removeprefix(f"{registry.IDENTIFIER}#/definitions/") for reference in references}
    assert names <= set(whole_schema()["definitions"])
    assert not any("$ref" in part for part in whole_schema()["definitions"].values())
