"""Says a schema so that editors read it well: what may be left empty, what is offered, and what is put in whole.

The validator passes over a field without a value and knows no completions; an editor knows only what the schema says.
Tried on yaml-language-server, whose completions tests/editor holds.
"""

from __future__ import annotations

from collections.abc import Mapping

from linkforge_compile.schema.json_types import Json, Schema, branches, mapping, reference
from linkforge_compile.schema.repetition import LONG_FORM, is_list


class EditorForm:
    """The definitions of the language as an editor gets them; `definitions` are those that it refers to."""

    def __init__(self, definitions: Mapping[str, Schema]) -> None:
        self._definitions = definitions

    def of(self, schema: Schema, *, is_item: bool = False, is_patch: bool = False) -> Schema:
        """Return a schema as an editor gets it.

        Every map and list of things, but for an item of a list, may be left empty. In a patch `null` deletes, and
        is offered; elsewhere it says nothing.
        """
        whole = {key: self._parts(key, part, is_patch) for key, part in schema.items()}
        listed = _kinds(schema)
        is_section = "object" in listed or ("array" in listed and is_list(schema))
        if is_section and not is_item and "null" not in listed and schema.get("title") != LONG_FORM:
            whole["type"] = [*listed, "null"]
        if isinstance(entry := whole.get("additionalProperties"), dict) and (snippets := _of_entries(schema)):
            whole["additionalProperties"] = _put_in_with(snippets, entry)
        return _with_silent_kinds(whole, ("boolean",) if is_patch else ("boolean", "null"))

    def _parts(self, key: str, part: Json, is_patch: bool) -> Json:
        match key, part:
            case "properties" | "patternProperties", dict():
                return {name: self._property(mapping(inner), is_patch) for name, inner in part.items()}
            case "anyOf", list():
                return [self.of(mapping(branch), is_patch=is_patch) for branch in part]
            case "items", dict():
                return self.of(self._flat_item(part), is_item=True, is_patch=is_patch)
            case "additionalProperties", dict():
                return self.of(part, is_patch=is_patch)
        return part

    def _property(self, schema: Schema, is_patch: bool) -> Schema:
        """Return the schema of a property, which is put in with the one snippet of the object that it refers to.

        The server asks the property itself for one, and only where it has no keys; what it refers to lends it keys.
        """
        whole = self.of(schema, is_patch=is_patch)
        target = self._target(schema)
        if reference(schema) is None or not {"properties", "defaultSnippets"} <= target.keys():
            return whole
        said = {key: part for key, part in target.items() if key in ("description", "markdownDescription")}
        return _put_in_with(target["defaultSnippets"], {**said, **whole})

    def _flat_item(self, schema: Schema) -> Schema:
        """Return the schema of an item that is a scalar or the long form as one without a union.

        Of a union in a list the server offers each branch as a new item, `- ` before it, wherever the caret is.
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
        """Return a schema with what it refers to; its own words come first."""
        name = reference(schema)
        own = {key: part for key, part in schema.items() if key != "$ref"}
        return own if name is None else {**self._target(self._definitions[name]), **own}


def _kinds(schema: Schema) -> list[Json]:
    kinds = schema.get("type")
    return kinds if isinstance(kinds, list) else [kinds]


def _put_in_with(snippets: Json, schema: Schema) -> Schema:
    """Return a schema with snippets of its own; beside a `$ref` the server passes over them."""
    own = {key: part for key, part in schema.items() if key != "$ref"}
    referred: Schema = {"allOf": [{"$ref": schema["$ref"]}]} if "$ref" in schema else {}
    return {**own, "defaultSnippets": snippets, **referred}


def _of_entries(schema: Schema) -> list[Json]:
    """Return the snippets of a map of names without the name: those of an entry whose name stands there already."""
    snippets = schema.get("defaultSnippets")
    listed = [mapping(snippet) for snippet in snippets] if isinstance(snippets, list) else []
    return [
        {**snippet, "body": body}
        for snippet in listed
        for name, body in mapping(snippet["body"]).items()
        if name.startswith("$") and isinstance(body, dict)
    ]


def _with_silent_kinds(schema: Schema, silent: tuple[str, ...]) -> Schema:
    """Return a schema that takes the same and does not offer `true`, `false` and `null` where they are hardly meant.

    The server offers them for what stands under `type`, not for what stands under `if`. A map about which nothing
    else is said keeps its type: by that the server knows to put in a key with its colon.
    """
    listed = _kinds(schema)
    hidden: list[Json] = [kind for kind in listed if kind in silent]
    is_bare_map = "object" in listed and not {"properties", "defaultSnippets"} & schema.keys()
    if not hidden or len(listed) == 1 or listed[0] == "boolean" or is_bare_map:
        return schema
    shown: list[Json] = [kind for kind in listed if kind not in silent]
    told = schema.get("patternErrorMessage", f"expected {schema['title']}")
    kept = {key: part for key, part in schema.items() if key != "type"}
    return {**kept, "if": {"type": hidden}, "else": {"type": shown, "errorMessage": told}}
