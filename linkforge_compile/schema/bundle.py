"""The one self-contained schema file that editors want."""

from __future__ import annotations

from linkforge_compile.schema.json_types import Json, Schema, mapping
from linkforge_compile.schema.registry import ROOT, definitions_with_patches
from linkforge_compile.schema.repetition import LONG_FORM, is_list

IDENTIFIER = "https://linkforge.dev/schema/v1/robot.schema.json"
"""Names version 1 of the language's schema; an identifier, never fetched."""


def bundle() -> Schema:
    """Return the schema of a whole file, with all that it refers to under `definitions`."""
    parts = {name: _with_empty(part) for name, part in definitions_with_patches().items()}
    root = {**parts.pop(ROOT), "type": "object"}
    return {"$schema": "http://json-schema.org/draft-07/schema#", "$id": IDENTIFIER, **root, "definitions": {**parts}}


def bundle_text() -> str:
    """Return the bundle as JSON text, the same bytes on every run and machine."""
    import json

    return json.dumps(bundle(), ensure_ascii=False, indent=2) + "\n"


def _with_empty(schema: Schema, *, is_item: bool = False) -> Schema:
    """Return a schema in which every map and list of things, but for an item of a list, may be left empty.

    The validator passes over a field without a value; an editor knows only what the schema says.
    """
    whole = {key: _parts_with_empty(key, part) for key, part in schema.items()}
    kinds = schema.get("type")
    listed = kinds if isinstance(kinds, list) else [kinds]
    is_section = "object" in listed or ("array" in listed and is_list(schema))
    if is_section and not is_item and "null" not in listed and schema.get("title") != LONG_FORM:
        whole["type"] = [*listed, "null"]
    return whole


def _parts_with_empty(key: str, part: Json) -> Json:
    match key, part:
        case "properties" | "patternProperties", dict():
            return {name: _with_empty(mapping(inner)) for name, inner in part.items()}
        case "anyOf", list():
            return [_with_empty(mapping(branch)) for branch in part]
        case "additionalProperties" | "items", dict():
            return _with_empty(part, is_item=key == "items")
    return part
