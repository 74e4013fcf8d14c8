"""What is read quickly is read as libyaml reads it, and what specs mostly consist of is read so."""

import tracemalloc
from pathlib import Path
from random import Random

import pytest

from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.nodes import MAX_DEPTH
from linkforge_compile.syntax.quick_reader import read_quickly
from tests.conftest import ROOT
from tests.syntax.both_readers import agree_on

SPECS = sorted([*(ROOT / "examples").rglob("*.yaml"), *(ROOT / "tests" / "cases").rglob("*.yaml")])


def test_both_readers_agree_on_every_spec():
    read = [path.name for path in SPECS if agree_on(path.read_bytes().decode("utf-8", errors="replace"))]
    assert "two_link_arm.robot.yaml" in read
    assert len(read) > len(SPECS) / 2  # of the others most are no YAML on purpose


@pytest.mark.parametrize(
    "text",
    [
        "a: 1",
        "a: 1\r\nb:\r\n  c: x # why\r\n",
        "\ufeff# first\n\na: 1\n# last",
        "a:\nb: null\nc: ~\n",
        "a:\n  b:\n\n  # c\n  c: d e\n# end\nf:\n- 1\n-   - 2\n    - g\n- h: 3\n  i: 4\n",
        "- a\n- {b: c}\n- [1, 2]\n- 'd'\n",
        "word",
        "  a: 1\n  b: 2\n",
        "a: package://b/c.stl\nb: x#y:z\nc::d: -.5\n",
        "a b: 1\n2: 3\n$(x + 1): 4\n",
        "a: {b: 1,c: 2 , d: [3,4 ,  5], e f: g h, i: {}, j: [], k: { }, l: [ ]}\n",
        "a: [0, 1.5, -2e3, 0x1F, 0o17, .5, +1, .inf, -.inf, true, 90 deg, x]\n",
        "a: {b: [1, # one\n  2],\n c: d}\ne:\n  [f,\n\n  g\n  ]\n",
        "a: 'b: c'\nd: \"e # f\"\ng: ['h, i', \"[j]\"]\n",
        "a: |\n  b\n    c\n\n  <d e='1'/>\nf: |-\n   g\n\n\nh:\n- |\n i\n- j\n",
        "a: $(b * 2)\nc: [$(d), $(e(1) + 2)]\n",
        "größe: {höhe: 3 µm} # ä\nü: é\nö: [机器人, ä]\n",
        "a: {b: 1, # c\n  d: [2, # e\n    3, ], }\n",
        "k" * 999 + ": 1\na: {" + "k" * 999 + ": 1}\n" + "k" * 998 + "l:\n  b: 1\n",
        "a: |\n  b\n    \u3000c\n\n\n# d\ne: f\n",
    ],
)
def test_simple_yaml_is_read_quickly(text: str):
    assert agree_on(text)


@pytest.mark.parametrize(
    "text",
    [
        *("", "# nothing\n", "---\na: 1\n", "a: 1\n...\n", "%YAML 1.2\n---\na: 1\n"),
        *("a: &b 1\n", "a: *b\n", "a: !c 1\n", "<<: {a: 1}\n", "? a\n: b\n", "'a': 1\n", "a: {'b': 1}\n"),
        *("a: b\n  c\n", "a: >\n  b\n", "a: |2\n   b\n", "a: 'b\n  c'\n", 'a: "\\x41"\n', "a: 'it''s'\n"),
        *("a: 1\na: 2\n", "a: {b: 1, b: 2}\n", "a: 1e999\n", "a: [f(1, 2), $(f(1, 2))]\n", "a:\tb\n"),
        *("a: b: c\n", "a: 1\n  b: 2\n", "a:\n  b: 1\n c: 2\n", "a: - b\n", "a: @b\n", "a: -\n", "- a\nb: c\n"),
        *("a: {b: 1]\n", "a: {b, c: 1}\n", "a: {b:1}\n", "a: [1, , 2]\n", "a: [b: c]\n", "a: [-]\n", "a: [b] c\n"),
        *(
            "a\rb: c",
            "a: |\n    <b/>\n  \n    # c\nd: e\n",
            "a: |\n    b\n  \n      \nd: e\n",
            "a: |\n  b\u00a0\nc: d\n",
        ),
        *("k" * 1025 + ": 1\n", "a: 1\n" + "k" * 1025 + ":\n  b: 1\n", "a: {" + "k" * 1025 + ": 1}\n"),
    ],
)
def test_what_is_not_simple_or_at_fault_is_left_to_the_other(text: str):
    assert read_quickly(SourceFile("r", text), 1000) is None


@pytest.mark.parametrize(
    "text",
    [
        *(
            "a: [1, 2]\n",
            "a: {b: 1}\n",
            "a: {b: c, d: [e], f: g}\n",
            "a: [x y, 'z']\n",
            "a:\n- 1\n- 2\n",
            "[]\n",
            "a\n",
        ),
        *("a: <b><c/>\n", "a: '<<'\n", "'<'\n", "a: |\n  <b/>\n"),
    ],
)
def test_no_more_is_read_than_is_left(text: str):
    file = SourceFile("r", text)
    read = read_quickly(file, 1000)
    assert read is not None
    assert read_quickly(file, read[1]) is not None
    assert read_quickly(file, read[1] - 1) is None


@pytest.mark.parametrize(
    "text",
    [
        "- a\n" * 50_000,
        "a: [" + "1, " * 50_000 + "1]\n",
        "a: [" + "'1', " * 50_000 + "1]\n",
        "".join(f"a{number}: b\n" for number in range(20_000)),
        "a: {" + ", ".join(f"b{number}: 1" for number in range(20_000)) + "}\n",
        "".join(" " * deep + f"a{number}:\n" for deep in range(40) for number in range(400)),
    ],
    ids=["dashes", "words", "quotes", "lines", "braces", "open maps"],
)
def test_what_is_too_much_is_refused_before_it_is_read(text: str):
    file = SourceFile("r", text)
    tracemalloc.start()
    try:
        assert read_quickly(file, 2000) is None
        assert tracemalloc.get_traced_memory()[1] < 4 * len(text) + 1_500_000
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(
    "nested",
    [
        lambda depth: "a: " + "[" * depth + "]" * depth,
        lambda depth: "a: " + "{b: " * depth + "c" + "}" * depth,
        lambda depth: "".join(" " * level + "a:\n" for level in range(depth)) + " " * depth + "- b\n",
        lambda depth: "- " * (depth + 1) + "a\n",
    ],
)
def test_nesting_is_read_as_deep_as_elsewhere(nested):
    assert agree_on(nested(MAX_DEPTH - 1))
    assert not agree_on(nested(MAX_DEPTH))


@pytest.mark.parametrize(
    ("text", "is_simple"),
    [
        ("\n" * 100_000 + "a: 1\n", True),
        ("# b\n" * 5_000 + "a: 1\n", True),
        ("a: [1,\n" + "# b\n" * 5_000 + "2]\n", True),
        ("a: " + "b " * 5_000, False),
        ("a: " + "b:" * 5_000 + "c", False),
        ("a: [" + "1, " * 5_000 + "1]\n", True),
        ("a: {" + ", ".join(f"b{number}: 1" for number in range(5_000)) + "}\n", True),
        ("a: |\n" + "  <b/>\n" * 5_000 + "c: d\n", True),
        ("a: |\n" + " " * 100_000 + "b\nc: d\n", True),
        ("".join(f"- |\n{' ' * number}b\n" for number in range(1, 600)) + "- c\n", True),
    ],
    ids=["empty", "comments", "in brackets", "words", "colons", "items", "entries", "raw", "blanks", "indents"],
)
def test_much_of_one_kind_is_read_alike(text: str, is_simple: bool):
    assert agree_on(text) == is_simple


def test_raw_text_takes_no_more_room_than_it_has_characters():
    text = "a: |\n" + " bc\n" * 100_000 + "d: e\n"
    file = SourceFile("r", text)
    tracemalloc.start()
    try:
        assert read_quickly(file, 100) is not None
        assert tracemalloc.get_traced_memory()[1] < 6 * len(text)
    finally:
        tracemalloc.stop()


PIECES = [
    *(
        "\n",
        "\n  ",
        "\n    ",
        "\n- ",
        "- ",
        ": ",
        ":",
        ", ",
        ",",
        "[",
        "]",
        "{",
        "}",
        "[]",
        "{}",
        " ",
        "  ",
        "\r\n",
        "\t",
    ),
    *("'", '"', "|", "|-", "|\n    ", ">", "#", " #", " # x\n", "&a ", "*a", "!t ", "<<: ", "? ", "?", "@", "%", "`"),
    *(
        "---",
        "...",
        "-",
        "\u00a0",
        "\u3000",
        "\n ",
        "\n      ",
        "a",
        "a b",
        "k: v",
        "1",
        "-1",
        ".5",
        "~",
        "null",
        "0x",
        "1e999",
        "//",
        "::",
        "=",
        "<b>",
        "\\",
    ),
    *("$(", "$(x)", "$(f(1, 2))", ")", "é", "😀"),
]


def _changed(text: str, dice: Random) -> str:
    """Return some lines of a text with a piece more, some characters fewer, or others from elsewhere in it."""
    lines = text.split("\n")
    first = dice.randrange(len(lines))
    text = "\n".join(lines[first : first + dice.randrange(1, 30)])
    for _ in range(dice.randrange(1, 4)):
        at, other = dice.randrange(len(text) + 1), dice.randrange(len(text) + 1)
        piece = dice.choice((dice.choice(PIECES), "", text[other : other + dice.randrange(20)]))
        text = text[:at] + piece + text[at + dice.choice((0, 0, 1, 3)) :]
    return text


def test_both_readers_agree_on_what_is_almost_a_spec():
    dice = Random(1)
    texts = [path.read_text("utf-8") for path in SPECS if "bad" not in path.parts]
    changed = [_changed(dice.choice(texts), dice) for _ in range(1500)]
    pieces = ["".join(dice.choices(PIECES, k=dice.randrange(1, 20))) for _ in range(1500)]
    assert sum(map(agree_on, changed)) > 300
    assert sum(map(agree_on, pieces)) > 50


def test_what_was_written_by_a_person_and_by_import_is_simple():
    for name in ("01_two_link_arm/two_link_arm", "07_quadruped/leg", "10_vendor_robots/vendor_robots"):
        text = Path(ROOT, "examples", f"{name}.robot.yaml").read_text("utf-8")
        assert read_quickly(SourceFile(name, text), 10_000) is not None
