"""Make the self-contained schema for editors: which parts may be empty, what is completed, and with which snippets.

The validator ignores fields without a value and offers no completions; an editor knows only the schema.
tests/editor holds the completions of yaml-language-server.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

from linkforge_compile.editor.keys_by_type import KeysByType, keys_by_type
from linkforge_compile.schema.json_schema import LONG_FORM, Json, Schema, branches, is_list, mapping, reference
from linkforge_compile.schema.registry import IDENTIFIER, ROOT, definitions, definitions_with_patches
from linkforge_compile.units import UNITS, pattern_of


def bundle() -> Schema:
    """Return the schema of a whole file, with everything that it refers to under `definitions`."""
    whole = definitions_with_patches()
    form = _EditorForm(whole)
    parts = {name: form.of(part, is_patch=name not in definitions()) for name, part in whole.items()}
    parts |= {name: _offered_by_type(parts[name], keys) for name, keys in keys_by_type().items()}
    root = {**parts.pop(ROOT), "type": "object"}
    return {"$schema": "http://json-schema.org/draft-07/schema#", "$id": IDENTIFIER, **root, "definitions": {**parts}}


def bundle_text() -> str:
    """Return the bundle as JSON, the same bytes in every run."""
    return json.dumps(bundle(), ensure_ascii=False, indent=2) + "\n"


def _offered_by_type(schema: Schema, keys: KeysByType) -> Schema:
    """Return an equivalent schema that does not offer some keys in an object of a type that has no use for them.

    Nor does it offer snippets of whole objects in one that has its type. The server offers a key of any schema that
    applies, but for those with `doNotSuggest`.
    """
    if "anyOf" in schema:
        parts = [_offered_by_type(part, keys) if "properties" in part else part for part in branches(schema)]
        return {**schema, "anyOf": [*parts]}
    properties = {**mapping(schema["properties"])}
    conditions: list[Json] = []
    for types, names in keys.items():
        of_type: Schema = {"properties": {"type": {"enum": [*types]}}, "required": ["type"]}
        conditions.append({"if": of_type, "else": {"properties": {name: properties[name] for name in names}}})
    for name in (name for names in keys.values() for name in names):
        properties[name] = {"doNotSuggest": True, "allOf": [properties[name]]}
    if "defaultSnippets" in schema:
        conditions.append(_unless_typed(schema["defaultSnippets"]))
    kept = {key: part for key, part in schema.items() if key != "defaultSnippets"}
    return {**kept, "properties": properties, "allOf": conditions}


class _EditorForm:
    """Rewrites schemas for editors; `definitions` are those that they refer to."""

    def __init__(self, definitions: Mapping[str, Schema]) -> None:
        self._definitions = definitions

    def of(self, schema: Schema, *, is_needed: bool = False, is_patch: bool = False) -> Schema:
        """Return a schema in which everything may be empty, but no scalar or vector that is needed.

        Needed are items of lists and the fields that the language requires. `null` is offered as a completion in a
        patch only, where it deletes.
        """
        if is_needed and reference(schema) is not None and not self._is_section(self._target(schema)):
            schema = self._target(schema)  # in its own definition it may be empty
        whole = {key: self._parts(key, part, is_needed, is_patch) for key, part in schema.items()}
        if units := _UNITS_OF_A_NUMBER.search(str(schema.get("patternErrorMessage"))):
            whole["pattern"] = _pattern_with_units(str(schema["pattern"]), units[1].split(" or "))
        listed = _kinds(schema)
        is_whole = listed == [None] or "null" in listed or "enum" in schema or schema.get("title") == LONG_FORM
        if not is_whole and (self._is_section(schema) or not is_needed):
            whole["type"] = [*listed, "null"]
        if isinstance(entry := whole.get("additionalProperties"), dict) and (snippets := _snippets_of_entries(schema)):
            whole["additionalProperties"] = _with_snippets_of_entry(snippets, entry)
        return _with_silent_kinds(whole, ("boolean",) if is_patch else ("boolean", "null"))

    def _parts(self, key: str, part: Json, is_needed: bool, is_patch: bool) -> Json:
        match key, part:
            case "properties" | "patternProperties", dict():
                return {name: self._property(mapping(inner), is_patch) for name, inner in part.items()}
            case "anyOf", list():
                return [self.of(mapping(branch), is_needed=is_needed, is_patch=is_patch) for branch in part]
            case "items", dict():
                return self.of(self._flat_item(part), is_needed=True, is_patch=is_patch)
            case "additionalProperties", dict():
                return self.of(part, is_patch=is_patch)
        return part

    def _property(self, schema: Schema, is_patch: bool) -> Schema:
        """Return the schema of a property with the snippet of the object that it refers to.

        The server looks for a snippet at the property itself, and only if that has no keys of its own.
        """
        target = self._target(schema)
        is_required = str(target.get("description", "")).endswith("Required.")
        whole = self.of(schema, is_needed=is_required, is_patch=is_patch)
        if "enum" in schema and not is_required and not is_patch:
            whole = {**_descriptions(schema), "anyOf": [whole, _EMPTY]}
        if _kinds(target)[0] == "boolean":
            # The server offers both for the type, but not where that is under `else`.
            examples = target.get("examples")
            listed = examples if isinstance(examples, list) else []
            whole["examples"] = [*listed, *(flag for flag in (True, False) if flag not in listed)]
        if reference(schema) is None or not {"properties", "defaultSnippets"} <= target.keys():
            return whole
        return _with_snippets(target["defaultSnippets"], {**_descriptions(target), **whole})

    @staticmethod
    def _is_section(schema: Schema) -> bool:
        """Whether a schema describes a map or a list of any length, which may be empty anywhere."""
        listed = _kinds(schema)
        return "object" in listed or ("array" in listed and is_list(schema))

    def _flat_item(self, schema: Schema) -> Schema:
        """Return the schema of an item that is a scalar or the long form without a union.

        Of a union in a list the server offers each branch as a new item with `- `, wherever the caret is.
        """
        parts = branches(schema)
        if len(parts) != 2 or parts[1].get("title") != LONG_FORM:
            return schema
        scalar, long_form = self._target(parts[0]), parts[1]
        if "enum" in scalar or not set(_kinds(scalar)) <= {"string", "number", "boolean"}:
            return schema
        properties = mapping(long_form["properties"])
        value: Schema = {**mapping(properties["value"]), "examples": ["$(i)"]}
        return {
            **scalar,
            "type": [*_kinds(scalar), "object"],
            "properties": {**properties, "value": value},
            "additionalProperties": False,
        }

    def _target(self, schema: Schema) -> Schema:
        """Return a schema merged with what it refers to; its own entries win."""
        name = reference(schema)
        own = {key: part for key, part in schema.items() if key != "$ref"}
        return own if name is None else {**self._target(self._definitions[name]), **own}


_UNITS_OF_A_NUMBER = re.compile(r"a number \[([^]]+)\]")
"""The SI units of a bare number in the message about a quantity: "kg", or "N*m or N"."""

_ANY_UNIT = "[A-Za-zµμ°º˚]\\S*"


def _pattern_with_units(pattern: str, si_units: list[str]) -> str:
    """Return the pattern of a quantity with the units of its dimensions, where our schemas accept any word."""
    return pattern.replace(_ANY_UNIT, f"(?:{pattern_of(UNITS[unit].dimension for unit in si_units)})")


_EMPTY: Schema = {"if": {"type": ["null"]}, "else": False}
"""Accepts null without offering it as a completion."""


def _descriptions(schema: Schema) -> Schema:
    return {key: part for key, part in schema.items() if key in ("description", "markdownDescription")}


def _kinds(schema: Schema) -> list[Json]:
    kinds = schema.get("type")
    return kinds if isinstance(kinds, list) else [kinds]


def _with_snippets(snippets: Json, schema: Schema) -> Schema:
    """Return a schema with snippets; its `$ref` moves into `allOf`, because the server ignores snippets next to it."""
    own = {key: part for key, part in schema.items() if key != "$ref"}
    referred: Schema = {"allOf": [{"$ref": schema["$ref"]}]} if "$ref" in schema else {}
    return {**own, "defaultSnippets": snippets, **referred}


def _with_snippets_of_entry(snippets: list[Json], schema: Schema) -> Schema:
    """Return the schema of an entry with snippets of it; those that write a `type` are for an entry without one."""
    if not all("type" in mapping(mapping(snippet)["body"]) for snippet in snippets):
        return _with_snippets(snippets, schema)
    return {"allOf": [schema, _unless_typed(snippets)]}


def _unless_typed(snippets: Json) -> Schema:
    return {"if": {"type": "object", "required": ["type"]}, "else": {"defaultSnippets": snippets}}


def _snippets_of_entries(schema: Schema) -> list[Json]:
    """Return the snippets of a map of names without the name, for an entry that has its name already."""
    snippets = schema.get("defaultSnippets")
    listed = [mapping(snippet) for snippet in snippets] if isinstance(snippets, list) else []
    return [
        {**snippet, "body": body}
        for snippet in listed
        for name, body in mapping(snippet["body"]).items()
        if name.startswith("$") and isinstance(body, dict)
    ]


def _with_silent_kinds(schema: Schema, silent: tuple[str, ...]) -> Schema:
    """Return an equivalent schema that does not offer `true`, `false` and `null` as completions.

    The server offers the kinds under `type`, but not those under `if`. A map without known keys keeps its type, by
    which the server knows to insert a key with its colon.
    """
    listed = _kinds(schema)
    # A kind that comes first is what is meant to be written: true or false.
    hidden: list[Json] = [kind for kind in listed if kind in silent and kind != listed[0]]
    is_bare_map = "object" in listed and not {"properties", "defaultSnippets"} & schema.keys()
    if not hidden or is_bare_map:
        return schema
    shown: list[Json] = [kind for kind in listed if kind not in hidden]
    message = schema.get("patternErrorMessage", f"expected {schema['title']}")
    kept = {key: part for key, part in schema.items() if key != "type"}
    return {**kept, "if": {"type": hidden}, "else": {"type": shown, "errorMessage": message}}
