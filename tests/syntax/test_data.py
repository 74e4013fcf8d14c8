"""Files of data: any shape, the tags that the caller knows, and no others."""

import pytest

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.syntax import TOO_MUCH_DATA
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlList, YamlMap, YamlScalar, read_data
from linkforge_compile.syntax import reader as reader_module

TAGS = {"!twice": lambda scalar: YamlScalar(scalar.text, 2 * float(scalar.text), scalar.span)}


def read(text):
    sink = Diagnostics()
    return read_data(SourceFile("table.yaml", text), sink, TAGS), [str(one) for one in sink]


@pytest.mark.parametrize(("text", "kind"), [("a: 1", YamlMap), ("- 1", YamlList), ("3 mm", YamlScalar)])
def test_the_top_may_be_of_any_shape(text, kind):
    node, told = read(text)
    assert (type(node), told) == (kind, [])


def test_a_known_tag_makes_what_the_caller_says():
    node, told = read("a: !twice 3\nb: [!twice '4']\n")
    assert told == []
    assert (node.get("a").value, node.get("b").items[0].value) == (6, 8)


def test_other_tags_and_tags_on_maps_are_told_where_they_stand():
    _, told = read("a: !half 3\nb: !twice {c: 1}\n")
    known = "of YAML's tags only !twice before a number are read here"
    assert told == [
        f"table.yaml:1:4: error: {known}, found '!half' [LF1113]",
        f"table.yaml:2:4: error: {known}, found '!twice' [LF1113]",
    ]


@pytest.mark.parametrize("text", ["", "# nothing\n", "---\n", "null"])
def test_an_empty_file_is_told(text):
    assert read(text) == (None, ["table.yaml:1:1: error: the file is empty, so there is nothing to name [LF1114]"])


def test_values_are_counted(monkeypatch):
    monkeypatch.setattr(reader_module, "MAX_NODES", 10)
    assert read(f"[{'1, ' * 8}1]")[1] == []
    node, told = read(f"[{'1, ' * 9}1]")
    assert node is None
    assert TOO_MUCH_DATA.message.format(limit="10") in told[0]
