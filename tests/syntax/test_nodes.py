"""Nodes of the tree are compared by identity."""

import pytest

from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar

FILE = SourceFile("a.yaml", "a")


def scalar() -> YamlScalar:
    return YamlScalar("a", "a", FILE.whole)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (scalar(), scalar()),
        (YamlList((), FILE.whole), YamlList((), FILE.whole)),
        (YamlMap({}, FILE.whole), YamlMap({}, FILE.whole)),
        (YamlEntry(key := scalar(), key), YamlEntry(key, key)),
    ],
)
def test_a_node_is_equal_to_itself_alone(one: YamlNode, other: YamlNode):
    assert (one == other, one != other) == (False, True)
    assert {one: 1, other: 2}[one] == 1
    assert one == one  # noqa: PLR0124 that is what is asked
