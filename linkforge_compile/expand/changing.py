"""Which parts of a tree computing may change: those that hold an expression or a word of repetition."""

from __future__ import annotations

import re

from linkforge_compile.schema.repetition import WORDS
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression

# Nearly every robot has an effort.
_FOR = re.compile(r"for\b")
_SIGNS = ("$(", "\\", *(word for word in WORDS if word != "for"))


def may_change(text: str) -> bool:
    """Whether computing may change anything in the tree of a YAML text: most texts have none of the signs of it.

    They are an expression, the words of repetition, and a backslash, which may spell each of these otherwise.
    """
    return any(sign in text for sign in _SIGNS) or _FOR.search(text) is not None


class Changing:
    """Looks into each node once, however often its parts are asked for."""

    def __init__(self) -> None:
        self._changing: dict[YamlList | YamlMap, bool] = {}

    def change(self, node: YamlNode) -> bool:
        """Whether a node or anything in it, keys too, holds an expression or a word of repetition."""
        if isinstance(node, YamlScalar):
            return has_expression(node.text)
        if isinstance(node, YamlFault):
            return False
        changing = self._changing.get(node)
        if changing is None:
            changing = any(map(self.change, node.items)) if isinstance(node, YamlList) else self._changes_in(node)
            self._changing[node] = changing
        return changing

    def _changes_in(self, node: YamlMap) -> bool:
        for name, entry in node.entries.items():
            value = entry.value
            inside = has_expression(value.text) if isinstance(value, YamlScalar) else self.change(value)
            if inside or name in WORDS or has_expression(name):
                return True
        return False
