"""The writer: tidy text that reads back to the same tree."""

from collections.abc import Mapping
from textwrap import dedent

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.source import SourceFile
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar, read, scalar_value
from linkforge_compile.syntax.writer import write
from linkforge_compile.units import Dimension, Quantity, number_text

NOWHERE = SourceFile("<test>", "").whole


def scalar(value: object) -> YamlScalar:
    """Return text for text, and all else as it is spelled where it is computed."""
    spelled = number_text(value) if isinstance(value, float) else str(value)
    return YamlScalar(spelled, value, NOWHERE)


def node(value: object) -> YamlNode:
    if isinstance(value, YamlScalar):
        return value
    if isinstance(value, Mapping):
        return YamlMap({key: YamlEntry(scalar(key), node(item)) for key, item in value.items()}, NOWHERE)
    return YamlList(tuple(map(node, value)), NOWHERE) if isinstance(value, list) else scalar(value)


def plain(text: str) -> YamlScalar:
    """Return what plain text means."""
    return YamlScalar(text, scalar_value(text), NOWHERE)


def same(one: YamlNode, other: YamlNode) -> bool:
    """Whether two trees say the same in the same order; numbers may be spelled in two ways."""
    match one, other:
        case YamlScalar(), YamlScalar():
            if isinstance(one.value, bool | str | None):
                return (one.text, repr(one.value)) == (other.text, repr(other.value))
            return one.value == other.value or repr(one.value) == repr(other.value) == "nan"
        case YamlList(), YamlList():
            return len(one) == len(other) and all(map(same, one, other))
        case YamlMap(), YamlMap():
            return list(one.entries) == list(other.entries) and all(
                same(entry.value, other.entries[entry.name].value) for entry in one
            )
    return False


def read_back(text: str) -> YamlMap:
    sink = Diagnostics()
    tree = read(SourceFile("<test>", text), sink)
    assert not list(sink), text
    assert tree is not None
    return tree


def written(value: Mapping[str, object]) -> str:
    tree = node(value)
    assert isinstance(tree, YamlMap)
    return write(tree)


texts = st.one_of(
    st.text(st.characters(exclude_categories=("Cs",)), max_size=12),
    st.text("ab:#- ,[]{}&*!|>'\"%@`?\n\t\\=~.0_", max_size=8),
    st.text("ab \n", max_size=10),
    st.sampled_from(["yes", "null", "1:30", "0o7", "1_000", "2026-01-01", "<<", "---", "...", "-x", "1e-3", "$(a, b)"]),
).filter(lambda text: not FORBIDDEN_CHARACTER.search(text))
scalars = st.one_of(
    texts,
    st.sampled_from(["", "~", "1.10", "007", "1e6", "true", "TRUE", ".inf", "-.inf", ".nan"]).map(plain),
    st.booleans(),
    st.integers(),
    st.floats(allow_nan=False, allow_infinity=False),
)
trees = st.dictionaries(
    texts,
    st.recursive(scalars, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(texts, inner, max_size=4)),
    max_size=4,
).filter(bool)


@given(trees)
def test_what_is_written_reads_back_to_the_same_tree(tree: Mapping[str, object]):
    assert same(read_back(written(tree)), node(tree))


@given(trees)
def test_what_is_read_and_written_again_is_the_same_text(tree: Mapping[str, object]):
    once = written(tree)
    assert write(read_back(once)) == once


@given(st.dictionaries(st.text("abyno", min_size=2, max_size=4), texts, min_size=1))
def test_readers_of_yaml_1_1_see_the_same_text(values: Mapping[str, str]):
    assert yaml.safe_load(written(values)) == values


def lines(text: str) -> str:
    return dedent(text).lstrip("\n")


def test_short_objects_stand_in_brackets_and_sections_do_not():
    spec = {"linkforge": 1, "name": "arm", "links": {"base": {}, "arm": {"visual": {"box": [0.1, 1.0, 1e-7]}}}}
    assert written(spec) == lines("""
        linkforge: 1
        name: arm

        links:
          base: {}
          arm: {visual: {box: [0.1, 1, 1e-7]}}
    """)


def test_values_too_wide_or_too_deep_are_written_in_lines():
    wide = {f"field_{number}": number for number in range(12)}
    deep = {"a": {"b": {"c": {"d": 1}}}}
    assert written({"joints": {"elbow": wide, "wrist": deep}, "shapes": [wide, [1, 2]]}) == lines("""
        joints:
          elbow:
            field_0: 0
            field_1: 1
            field_2: 2
            field_3: 3
            field_4: 4
            field_5: 5
            field_6: 6
            field_7: 7
            field_8: 8
            field_9: 9
            field_10: 10
            field_11: 11
          wrist:
            a: {b: {c: {d: 1}}}

        shapes:
          - field_0: 0
            field_1: 1
            field_2: 2
            field_3: 3
            field_4: 4
            field_5: 5
            field_6: 6
            field_7: 7
            field_8: 8
            field_9: 9
            field_10: 10
            field_11: 11
          - [1, 2]
    """)


def test_text_of_several_lines_is_kept_unchanged():
    assert written({"extra": "<a>\n  <b/>\n</a>\n", "doc": ["one\n\ntwo"], "odd": " a\nb"}) == lines("""
        extra: |
          <a>
            <b/>
          </a>
        doc:
          - |-
            one

            two
        odd: " a\\nb"
    """)


@pytest.mark.parametrize(
    ("text", "written_found"),
    [
        ("90 deg", "90 deg"),
        ("package://arm/a.stl", "package://arm/a.stl"),
        ("-x", "-x"),
        ("y", "y"),
        ("$(reach / 2)", "$(reach / 2)"),
        ("on", '"on"'),
        ("1:30", '"1:30"'),
        ("1e-3", '"1e-3"'),
        ("", '""'),
        ("~", '"~"'),
        ('say "a\\b"', 'say "a\\b"'),
        ('"a"', '"\\"a\\""'),
        ("a: b", '"a: b"'),
        ("a # b", '"a # b"'),
    ],
)
def test_text_is_quoted_only_where_it_must_be(text: str, written_found: str):
    assert written({"key": text}) == f"key: {written_found}\n"


def test_numbers_stay_as_they_were_spelled_and_computed_ones_are_spelled_shortest():
    spec = {"a": plain("1.10"), "b": YamlScalar("", 0.5, NOWHERE), "c": scalar(Quantity(1.5, Dimension.ANGLE))}
    assert written(spec) == "a: 1.10\nb: 0.5\nc: 1.5 rad\n"


def test_comments_stand_above_their_entry_or_item_which_keeps_it_out_of_brackets():
    tree = read_back("links: {base: {}, arm: {}}\nshapes: [a, b]\n")
    links, shapes = tree.entries["links"].value, tree.entries["shapes"].value
    assert isinstance(links, YamlMap)
    assert isinstance(shapes, YamlList)
    comments = {tree.entries["links"].key: "one\ntwo", links.entries["arm"].key: "arm", shapes.items[1]: "b"}
    assert write(tree, comments) == lines("""
        # one
        # two
        links:
          base: {}
          # arm
          arm: {}

        shapes:
          - a
          # b
          - b
    """)
