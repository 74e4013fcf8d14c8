"""Text to positioned tree: YAML as the language reads it, every key and value with its place."""

from linkforge_compile.syntax.nodes import (
    ScalarValue,
    YamlEntry,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
)
from linkforge_compile.syntax.reader import read
from linkforge_compile.syntax.scalars import scalar_value

__all__ = [
    "ScalarValue",
    "YamlEntry",
    "YamlFault",
    "YamlList",
    "YamlMap",
    "YamlNode",
    "YamlScalar",
    "read",
    "scalar_value",
]
