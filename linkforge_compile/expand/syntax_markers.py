"""Find out cheaply whether a text or a tree has anything in it to compute, or to check by its place."""

from __future__ import annotations

import re

from linkforge_compile.schema.json_schema import WORDS
from linkforge_compile.syntax import YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, has_expression

CONTEXT_PATTERN = re.compile(r"\bprefix\b(?!['\"]?\s*:)|\b(?:path|link|joint)[\s)]*\(|\$\{|[“„‘]")
"""Matches every text that `expression_context` has to check; few specs have one."""

_CONTEXT_MARKERS = ("$", "\\", "“", "„", "‘")
"""Substrings, one of which is in every such text; searched first because the pattern is slow on long texts."""

_FOR = re.compile(r"for\b")  # a word, because "effort" is in nearly every robot
_COMPUTED_MARKERS = ("$(", "\\", *(word for word in WORDS if word != "for"))  # a backslash may escape any of them


def may_need_context_check(text: str) -> bool:
    """Return False if `expression_context` cannot find a fault in a spec with this text."""
    return any(marker in text for marker in _CONTEXT_MARKERS) and CONTEXT_PATTERN.search(text) is not None


def may_compute(text: str) -> bool:
    """Return False if a spec with this YAML text has neither expressions nor `for`, `when` or `value`."""
    return any(marker in text for marker in _COMPUTED_MARKERS) or _FOR.search(text) is not None


class ExpressionScan:
    """Tell which parts of a tree hold expressions or repetition; visits each node once."""

    def __init__(self) -> None:
        self._computed: dict[YamlList | YamlMap, bool] = {}

    def is_computed(self, node: YamlNode) -> bool:
        """Whether a node or anything in it, keys included, holds an expression or a word of repetition."""
        if isinstance(node, YamlScalar):
            return has_expression(node.text)
        if isinstance(node, YamlFault):
            return False
        found = self._computed.get(node)
        if found is None:
            found = any(map(self.is_computed, node.items)) if isinstance(node, YamlList) else self._in_map(node)
            self._computed[node] = found
        return found

    def _in_map(self, node: YamlMap) -> bool:
        return any(
            name in WORDS or has_expression(name) or self.is_computed(entry.value)
            for name, entry in node.entries.items()
        )
