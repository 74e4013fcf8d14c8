"""Accept valid nodes with jsonschema-rs; only the rest needs jsonschema, which is slower but explains its errors."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from linkforge_compile.schema.json_types import LinkedSchema
from linkforge_compile.schema.registry import IDENTIFIER, whole_schema
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar

if TYPE_CHECKING:
    from jsonschema_rs import Draft7Validator, Registry

HEADER = ("linkforge", "name")
"""The keys that every file needs; an included file needs the first only."""

FAULTY = object()
"""Takes the place of a YamlFault in plain data; it has no JSON type, so every schema with a type rejects it."""


def accepts(schema: LinkedSchema, node: YamlNode) -> bool:
    """Whether a node is valid by a part of the linked schema; jsonschema then finds no error in it either.

    False does not imply that an error is reported: faults and fields without a value are skipped, and only
    jsonschema takes infinity for a number.
    """
    try:
        return _validator(schema).is_valid(plain(node))
    except ValueError:
        return False  # it contains FAULTY


def plain(node: YamlNode) -> object:
    """Return a node as dicts, lists and scalars."""
    if isinstance(node, YamlScalar):
        return node.value
    if isinstance(node, YamlMap):
        return {name: plain(entry.value) for name, entry in node.entries.items()}
    if isinstance(node, YamlList):
        return [plain(item) for item in node.items]
    return FAULTY


@cache
def _validator(schema: LinkedSchema) -> Draft7Validator:
    import jsonschema_rs

    return jsonschema_rs.Draft7Validator(
        schema.source,
        registry=_registry(),
        offline=True,
        # The regex engine that runs in linear time.
        pattern_options=jsonschema_rs.RegexOptions(),
    )


@cache
def _registry() -> Registry:
    import jsonschema_rs

    return jsonschema_rs.Registry([(IDENTIFIER, whole_schema())], draft=jsonschema_rs.Draft7)
