"""Reading: every key and value has its place, and invalid YAML is reported in plain words."""

import json
import time
from collections.abc import Iterator
from textwrap import dedent

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.diagnostics.codes.expressions import UNCLOSED_EXPRESSION
from linkforge_compile.diagnostics.codes.syntax import UNQUOTED_EXPRESSION
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, read, reader

PARSERS = [yaml.BaseLoader, *([yaml.CBaseLoader] if yaml.__with_libyaml__ else [])]


@pytest.fixture(params=PARSERS)
def _each_parser(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each parser of PyYAML, with libyaml or without, gives the same tree and the same faults."""
    monkeypatch.setattr(reader, "PARSER", request.param)


pytestmark = pytest.mark.usefixtures("_each_parser")


UNCLOSED = UNCLOSED_EXPRESSION.message


def read_text(text: str) -> tuple[YamlMap | None, list[str]]:
    sink = Diagnostics()
    tree = read(SourceFile("r", text), sink)
    return tree, [
        f"{reported.span.line}:{reported.span.column} {reported.message}" for reported in sink.sorted() if reported.span
    ]


def tree_of(text: str) -> YamlMap:
    tree, reported = read_text(text)
    assert reported == []
    assert tree is not None
    return tree


def test_the_time_for_lines_in_brackets_grows_with_their_length():
    text = "links: {\n" + " " * 100_000 + "# base\n" + " " * 100_000 + "\n  }\n"
    started = time.process_time()
    assert plain(tree_of(text)) == {"links": {}}
    assert time.process_time() - started < 2


def plain(node: YamlNode | None) -> object:
    match node:
        case YamlMap():
            return {entry.name: plain(entry.value) for entry in node}
        case YamlList():
            return [plain(item) for item in node]
        case YamlScalar():
            return node.value
    return "FAULT"


def spans(node: YamlNode) -> Iterator[Span]:
    yield node.span
    match node:
        case YamlMap():
            for entry in node:
                yield entry.key.span
                yield from spans(entry.value)
        case YamlList():
            for item in node:
                yield from spans(item)


def covered(span: Span) -> str:
    """The text that a span covers, its lines joined."""
    lines = [span.file.line(number) for number in range(span.line, span.end_line + 1)]
    lines[-1] = lines[-1][: span.end_column - 1]
    lines[0] = lines[0][span.column - 1 :]
    return "\n".join(lines)


def test_values_have_the_types_of_yaml_1_2():
    tree = tree_of("a: on\nb: 1e-3\nc: 010\nd: '1'\ne:\nf: [true, ~, 1:30]\n")
    assert plain(tree) == {"a": "on", "b": 0.001, "c": 10, "d": "1", "e": None, "f": [True, None, "1:30"]}


def test_the_text_of_a_scalar_is_kept_as_written():
    version = tree_of("version: 1.10\n").get("version")
    assert isinstance(version, YamlScalar)
    assert (version.text, version.value) == ("1.10", 1.1)


def test_keys_are_their_text():
    assert list(tree_of("1: a\ntrue: b\nnull: c\n1e999: d\n'<<': e\n").entries) == ["1", "true", "null", "1e999", "<<"]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_spans_cover_what_was_written(end: str):
    text = end.join(
        ["ä😀: öü  # x", "b: 'q''s'", "c: {d: [1, 22]}", "e:", "  - f: 1", "  - &g  $(x)", "h: |", "  i", "", "j: 0"]
    )
    tree = tree_of(text)
    assert [covered(entry.key.span) for entry in tree] == ["ä😀", "b", "c", "e", "h", "j"]
    assert [covered(entry.value.span) for entry in tree][:3] == ["öü", "'q''s'", "{d: [1, 22]}"]
    items = tree.get("e")
    assert isinstance(items, YamlList)
    assert [covered(item.span) for item in items] == ["f: 1", "$(x)"]
    assert covered(items.span) == "- f: 1\n  - &g  $(x)"
    literal = tree.get("h")
    assert literal is not None
    assert covered(literal.span) == "|\n  i"


def test_a_word_that_comes_again_is_read_as_it_is_written_there():
    again = ["a", '"a"', "&k  a", "'1'", "a\n    a", "a a", "1", "|-\n      a", ">-\n      1", "*k", "1.0", "a"]
    tree = tree_of("a: 1\na1: a\nb: {a: 1}\nc:\n" + "".join(f"  - {word}\n" for word in again) + "'1':\n1.0: a\n")
    assert plain(tree.get("c")) == ["a", "a", "a", "1", "a a", "a a", 1, "a", "1", "a", 1.0, "a"]
    items = tree.get("c")
    assert isinstance(items, YamlList)
    written = [covered(item.span) for item in items]
    assert written == ["a" if word in ("&k  a", "*k") else word for word in again]
    assert list(tree.entries) == ["a", "a1", "b", "c", "1", "1.0"]
    assert [covered(entry.key.span) for entry in tree] == ["a", "a1", "b", "c", "'1'", "1.0"]


def test_block_collections_end_with_their_last_value_before_comments():
    tree = tree_of("a:\n  b: 1   # c\n\n# d\ne: 2")
    inner = tree.get("a")
    assert inner is not None
    assert covered(inner.span) == "b: 1"
    assert tree.span.end == (5, 5)


def test_a_byte_order_mark_is_no_column():
    tree = tree_of("\ufeffname: x\n")
    assert tree.span.start == (1, 1)
    assert covered(tree.entries["name"].key.span) == "name"


def test_an_alias_is_the_anchored_node_itself():
    tree = tree_of("a: &x {b: 1}\nc: *x\n")
    assert tree.get("c") is tree.get("a")


def test_a_map_s_own_keys_win_over_merged_ones_and_earlier_maps_over_later():
    tree = tree_of(
        dedent("""
            x-a: &a {m: 1, n: 1, o: 1}
            x-b: &b {n: 2, o: 2, p: 2}
            one: {first: 0, <<: [*a, *b], o: 3, last: 0}
            two:
              m: 9
              <<: *a
        """)
    )
    assert list(plain(tree.get("one")).items()) == [  # type: ignore[union-attr]  # a dict, as it says
        ("first", 0),
        ("m", 1),
        ("n", 1),
        ("o", 3),
        ("p", 2),
        ("last", 0),
    ]
    assert plain(tree.get("two")) == {"m": 9, "n": 1, "o": 1}


def test_merged_entries_keep_their_own_places():
    tree = tree_of("x-a: &a {effort: 5}\nlimits:\n  <<: *a\n")
    limits = tree.get("limits")
    assert isinstance(limits, YamlMap)
    assert limits.entries["effort"].key.span.start == (1, 10)


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("", "1:1 the file is empty; a spec begins with 'linkforge: 1'"),
        ("---\n# c\n", "1:1 the file is empty; a spec begins with 'linkforge: 1'"),
        ("- a\n", "1:1 expected keys such as 'name:' and 'links:', found a list"),
        ("name:x", "1:1 a space is missing after the colon in 'name:x'"),
        ("a: 1\n---\nb: 2\n", "2:1 expected one YAML document, found a second one"),
        ("a: 1\nb: 2\na: 3\n", "3:1 the key 'a' is written twice"),
        ("[a]: b\n", "1:1 a key must be text, found a list"),
        ("a: !degrees 90\n", "1:4 YAML tags are not part of the language, found '!degrees'"),
        ("a: &x !!map {b: 1}\n", "1:7 YAML tags are not part of the language, found '!!map'"),
        ("x: &left 1\na: *lfet\n", "2:4 no anchor named 'lfet' above; did you mean 'left'?"),
        ("a: &x [1, *x]\n", "1:11 the alias '*x' is inside its own anchor"),
        ("a: {<<: 1}\n", "1:9 '<<' merges a map or a list of maps, found a plain value"),
        ("a: 1e999\n", "1:4 the number is beyond what a double can hold"),
        (f"a: {'9' * 5000}\n", "1:4 the number is beyond what a double can hold"),
        ('a: "\\x07"\n', "1:4 a spec cannot contain the character U+0007"),
        ("a: b\n\x00c: d\n", "2:1 a spec cannot contain the character U+0000"),
        ("a: b\u2028c: d\n", "1:5 a spec cannot contain the character U+2028"),
        ("a: {radius:0.1}\n", "1:5 a space is missing after the colon in 'radius:0.1'"),
        ("a: [$(max(a, b)), 1]\n", "1:5 " + UNQUOTED_EXPRESSION.message),
        ("a: {b: $(max(a, c)), d: $(n)}\n", "1:8 " + UNQUOTED_EXPRESSION.message),
        ("a: [$(list[0]), 1]\n", "1:5 " + UNQUOTED_EXPRESSION.message),
        ("a:\n\tb: c\n", "2:1 YAML is indented with spaces, found a tab"),
        ("a: @x\n", "1:4 text cannot begin with '@'; put it in quotes"),
        ("a: *\n", "1:4 text cannot begin with '*'; put it in quotes"),
        ("a: > 5\n", "1:4 text cannot begin with '>'; put it in quotes"),
        ("a: ? b\n", "1:4 text cannot begin with '?'; put it in quotes"),
        ("a:\n  b:c\n  d: e\n", "2:3 a space is missing after the colon in 'b:c'"),
        ("a: 1\nb:c # d\ne: f\n", "2:1 a space is missing after the colon in 'b:c'"),
        ("a:\n- 1\n-2\n- 3\n", "3:1 a space is missing after the dash in '-2'"),
        ("links # all: of them\n  base: x\n", "1:1 a colon is missing after 'links'"),
        ("a: 1\nb\nc: 2\n", "2:1 a colon is missing after 'b'"),
        (
            "a: b: c\n",
            "1:5 a second ': ' on this line; put text that contains one in quotes, or a map in braces: 'a: {b: …}'",
        ),
        ("a: $(x ? 1 : 2)\n", "1:12 a second ': ' on this line; put text that contains one in quotes"),
        ("a: 1\n  b: 2\n", "2:3 this line is indented under an entry that already has a value"),
        ("a:\n  b: 1\n c: 2\n", "3:2 this line is not aligned with any entry above"),
        ("a: 1\n- b\n", "2:1 a list item is not allowed among the keys of a map"),
        ("a:\n  - b\n  c: d\n", "3:3 expected a list item '- ...' as above, found a key; begin all with '-', or none"),
        ("a: - b\n", "1:4 a list with dashes must begin on a new line; on one line write [a, b]"),
        ("a: 'x\nb: c\n", "1:4 no closing quote for the text that begins here"),
        ('a: "x\\qy"\n', "1:6 unknown escape '\\q' in double quotes; use single quotes"),
        ("'a' b\n", "1:5 the value ended before this; put the whole text in quotes"),
        ("{a: 1} b\n", "1:8 the value ended before this; put the whole text in quotes"),
        ("a: 'x' y\n", "1:8 the value ended before this; put the whole text in quotes"),
        ("a: [1, 2\nb: 3\n", "2:2 expected ',' or ']' before this"),
        ("a: {b: 1]\n", "1:9 expected ',' or '}' before this"),
        ("a: [1, , 2]\n", "1:8 expected a value, found ','"),
        ("a: {b: ${c / 2}}\n", "1:8 '${c / 2}' is xacro syntax; write '$(c / 2)'"),
        ("a: [0, 0, ${c}]\n", "1:11 '${c}' is xacro syntax; write '$(c)'"),
        ("a: {b: 1, c: $(d}\n", f"1:14 {UNCLOSED}"),
        ("a: {b: 1, c: $(d}\ne: (f)\n", f"1:14 {UNCLOSED}"),
        ("a: [$(b]\n", f"1:5 {UNCLOSED}"),
        ("a: [$(b, $(c)]\n", f"1:5 {UNCLOSED}"),
        ("a: {b: $(c, d: 1}\n", f"1:8 {UNCLOSED}"),
        ("a: {b: $$(c, d: $(e}\n", f"1:17 {UNCLOSED}"),
        ("a: {b:, c: 1]\n", "1:13 expected ',' or '}' before this"),
    ],
)
def test_a_fault_is_reported_once_at_its_place_in_plain_words(text: str, reported: str):
    assert read_text(text)[1] == [reported]


def test_a_field_of_a_flow_map_may_be_left_empty():
    tree, reported = read_text("a: 1\na: 2\nb: {mass:}\nc: {mass:, d: [{e:}]}\n")
    assert reported == ["2:1 the key 'a' is written twice"]
    assert tree is not None
    assert plain(tree) == {"a": "FAULT", "b": {"mass": None}, "c": {"mass": None, "d": [{"e": None}]}}


@pytest.mark.skipif(not yaml.__with_libyaml__, reason="without libyaml, its own parser reads all")
def test_only_a_file_of_common_size_is_read_by_the_slow_parser(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(reader, "PARSER", yaml.CBaseLoader)
    monkeypatch.setattr(reader, "MAX_READ_TWICE", 10)
    assert read_text("a: {b:}\n")[1] == []
    assert read_text("a: {bcdef:}\n")[1] == ["1:10 this is not YAML: found unexpected ':'"]


def test_what_libyaml_alone_can_name_is_passed_on():
    _, reported = read_text("%YAML 2.0\n---\na: 1\n")
    assert reported[0].startswith("1:1 this is not YAML: found incompatible YAML document")


def test_reading_continues_after_a_fault():
    tree, reported = read_text("a: 1\na: 2\nb: !x 3\nc: [*y, 4]\nd: {e: $(f(1, 2)), g: 5}\nh: 6\n")
    assert [line.split()[0] for line in reported] == ["2:1", "3:4", "4:5", "5:8"]
    assert plain(tree) == {"a": "FAULT", "b": "FAULT", "c": ["FAULT", 4], "d": "FAULT", "h": 6}


def test_two_sections_of_one_name_are_one_with_the_entries_of_both():
    tree, reported = read_text("a: {b: 1, c: 2}\nd: {e: {f: 1}, e: {g: 2}}\na: {c: 3, h: 4}\n")
    assert [line.split()[0] for line in reported] == ["2:16", "3:1", "3:5"]
    assert plain(tree) == {"a": {"b": 1, "c": "FAULT", "h": 4}, "d": {"e": "FAULT"}}


@pytest.mark.parametrize(
    ("text", "notes"),
    [
        ("a: 1\na: 2\n", [("first written here", "r:1:1")]),
        ("a: {\n  b: |\n", [("inside the bracket that opens here", "r:1:4")]),
        ("a: {b: &b [1,\nc:\n  - 2\n", [("inside the bracket that opens here", "r:1:8")]),
        ("a: {b: [1], c: |\n", []),
    ],
)
def test_the_other_place_is_shown_that_a_fault_is_about(text: str, notes: list[tuple[str, str]]):
    sink = Diagnostics()
    read(SourceFile("r", text), sink)
    (reported,) = sink
    assert [(note.message, str(note.span)) for note in reported.notes] == notes


def test_aliases_may_not_multiply_without_end():
    laughs = "a: &a [x, x, x, x, x, x, x, x, x]\n"
    for name, before in zip("bcdefghij", "abcdefghi", strict=True):
        laughs += f"{name}: &{name} [{', '.join(['*' + before] * 9)}]\n"
    with pytest.raises(BeyondLimitError, match="r:6:32: error: the robot takes more than 500,000 values"):
        read_text(laughs)


@pytest.mark.parametrize(
    "text",
    [
        "a: " + "[" * 5_000,
        "a: " + "[" * 200 + "]" * 200,
        "".join(" " * depth + "a:\n" for depth in range(200)),
        "a0: &a0 [x]\n" + "".join(f"a{n}: &a{n} [*a{n - 1}]\n" for n in range(1, 200)),
    ],
    ids=["open", "flow", "block", "aliases"],
)
def test_nesting_has_a_limit(text: str):
    tree, reported = read_text(text)
    assert tree is None
    assert [line.partition(" ")[2] for line in reported] == ["lists and maps are nested more than 100 deep"]


PIECES = [
    *"ab1:,'\"[]{}|>@#%?*\\()\t\r\n ä😀\ufeff",
    ": ",
    "\n- ",
    "\n  ",
    "&x ",
    "*x",
    "<<: ",
    "!t ",
    "\n---\n",
    "$(",
    "1e999",
]
YAML_LIKE = st.lists(st.sampled_from(PIECES), max_size=25).map("".join)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.one_of(YAML_LIKE, st.text()))
def test_no_text_breaks_the_reader_and_every_span_lies_in_the_file(text: str):
    file = SourceFile("r", text)
    sink = Diagnostics()
    tree = read(file, sink)
    assert tree is not None or sink.has_errors
    for span in [*(spans(tree) if tree else ()), *(reported.span for reported in sink)]:
        assert span is not None
        assert (1, 1) <= span.start <= span.end
        for place in (span.start, span.end):
            assert place.line <= len(file.lines)
            assert place.column <= len(file.line(place.line)) + 1


VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text("ab :#'\"-\n"),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text("abc", min_size=1), inner, max_size=3),
    max_leaves=12,
)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.dictionaries(st.text("abc", min_size=1), VALUES, min_size=1, max_size=3))
def test_what_is_written_is_read_back(document: dict[str, object]):
    # JSON is YAML 1.2, and its writer none of ours.
    text = "\n".join(f"{key}: {json.dumps(value)}" for key, value in document.items())
    assert plain(tree_of(text)) == document


def test_a_fault_is_a_node_with_a_place():
    tree, _ = read_text("a: !t [1,\n  2]\n")
    assert tree is not None
    fault = tree.get("a")
    assert isinstance(fault, YamlFault)
    assert covered(fault.span).endswith("2]")


def test_a_text_may_end_in_the_dash_of_a_list():
    """The event of a list at the column of its key ends after the dash, which is the end of the text here."""
    tree = read(SourceFile("spec.yaml", "a:\n-"), Diagnostics())
    assert isinstance(tree, YamlMap)
    items = tree.get("a")
    assert isinstance(items, YamlList)
    assert len(items) == 1
