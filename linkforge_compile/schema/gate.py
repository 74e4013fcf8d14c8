"""Accept what jsonschema-rs finds valid; jsonschema, which takes longer, gives the errors in the rest."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from linkforge_compile.schema.json_types import Schema
from linkforge_compile.schema.registry import IDENTIFIER, unlinked, whole_schema
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar

if TYPE_CHECKING:
    from jsonschema_rs import Draft7Validator, Registry

FAULTY = object()
"""Stands for a YamlFault in plain data: no kind of value, so every schema with a type errs on it."""


def accepts(schema: Schema, node: YamlNode) -> bool:
    """Whether a node is valid by a part of the linked schema, or by FREE's; then jsonschema finds no error in it.

    False does not mean that an error is reported: `explain` ignores faults and fields without a value, and infinity
    is a number to jsonschema alone.
    """
    try:
        return _validator(schema).is_valid(plain(node))
    except ValueError:
        return False  # FAULTY is in it


def plain(node: YamlNode) -> object:
    """Return a node as dicts, lists and scalars."""
    if isinstance(node, YamlScalar):
        return node.value
    if isinstance(node, YamlMap):
        return {name: plain(entry.value) for name, entry in node.entries.items()}
    if isinstance(node, YamlList):
        return [plain(item) for item in node.items]
    return FAULTY


def _validator(schema: Schema) -> Draft7Validator:
    import jsonschema_rs

    # The schemas are made once and stay, so their identity is theirs for ever.
    if id(schema) not in _VALIDATORS:
        _VALIDATORS[id(schema)] = jsonschema_rs.Draft7Validator(
            unlinked(schema),
            registry=_registry(),
            offline=True,
            # Of its two engines the one that takes linear time.
            pattern_options=jsonschema_rs.RegexOptions(),
        )
    return _VALIDATORS[id(schema)]


_VALIDATORS: dict[int, Draft7Validator] = {}


@cache
def _registry() -> Registry:
    import jsonschema_rs

    return jsonschema_rs.Registry([(IDENTIFIER, whole_schema())], draft=jsonschema_rs.Draft7)
