"""Files of data: any shape, the tags that the caller knows, and no others."""

import pytest

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlList, YamlMap, YamlScalar, read_data

TAGS = {"!twice": lambda scalar: YamlScalar(scalar.text, 2 * float(scalar.text), scalar.span)}


def read(text):
    sink = Diagnostics()
    return read_data(SourceFile("table.yaml", text), sink, TAGS), [str(one) for one in sink]


@pytest.mark.parametrize(("text", "kind"), [("a: 1", YamlMap), ("- 1", YamlList), ("3 mm", YamlScalar)])
def test_the_top_may_be_of_any_shape(text, kind):
    node, reported = read(text)
    assert (type(node), reported) == (kind, [])


def test_a_known_tag_makes_the_value_of_the_caller():
    node, reported = read("a: !twice 3\nb: [!twice '4']\n")
    assert reported == []
    assert (node.get("a").value, node.get("b").items[0].value) == (6, 8)


def test_other_tags_and_tags_on_maps_are_reported_where_they_stand():
    _, reported = read("a: !half 3\nb: !twice {c: 1}\n")
    known = "the only YAML tags allowed here are !twice before a number"
    assert reported == [
        f"table.yaml:1:4: error: {known}, found '!half' [LF1113]",
        f"table.yaml:2:4: error: {known}, found '!twice' [LF1113]",
    ]


@pytest.mark.parametrize("text", ["", "# nothing\n", "---\n", "null"])
def test_an_empty_file_is_reported(text):
    assert read(text) == (
        None,
        ["table.yaml:1:1: error: the data file is empty; write its values [LF1114]"],
    )


def test_values_are_counted():
    budget = Budget()
    read_data(SourceFile("table.yaml", f"[{'1, ' * 9}1]"), Diagnostics(), TAGS, budget)
    assert budget.left(Limit.VALUES) == Limit.VALUES.most - 11
    with pytest.raises(BeyondLimitError) as beyond:
        read(f"[{'1, ' * Limit.VALUES.most}1]")
    assert str(beyond.value.diagnostic.span) == f"table.yaml:1:{1 + (Limit.VALUES.most - 1) * 3 + 1}"
