"""Read YAML into a tree of nodes with their spans in the file; `writer` writes such a tree."""

from linkforge_compile.syntax.nodes import (
    ScalarValue,
    Tags,
    YamlEntry,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    has_expression,
    is_null,
    leaves_in,
    scalar_value,
    word_value,
)
from linkforge_compile.syntax.reader import read, read_data
