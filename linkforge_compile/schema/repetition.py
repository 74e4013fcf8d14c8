"""Add `for`, `when` and the long form to the objects of all schemas, so that no schema file has to."""

from __future__ import annotations

from linkforge_compile.schema.json_types import Json, Schema, branches, mapping, reference

PLAIN = "plain"
"""The `$comment` of a schema whose keys and items are the author's own, even `for`, `when` and `value`."""

LONG_FORM = "the long form"
"""The title of the form of an entry or item that is no object: `{for: {i: 3}, value: joint_$(i)}`."""

XML = "XML"
"""The title of raw XML."""

WORDS = ("for", "when", "value")

RAW = ("extra", "extra_attributes", "extra_inside")
"""Raw parts of most objects; in a map keyed by names, these and WORDS are no names."""

_FOR: Schema = {"$ref": "#/definitions/for"}
_WHEN: Schema = {"$ref": "#/definitions/when"}
_VALUE: Schema = {
    "description": "What stands here, once or as often as 'for' says.",
    "markdownDescription": "What stands here, once or as often as `for` says."
    "\n\n```yaml\n{for: {i: 3}, value: joint_$(i)}\n```",
}


def add_repetition(definitions: dict[str, Schema], root: str) -> None:
    """Add repetition to every definition: `when` to objects, and `for` to those that are entries or items.

    Entries and items that are no objects get the long form; maps keyed by names get WORDS as keys. Lists of a fixed
    length, such as vectors, are single values and are not changed.
    """
    for name, schema in definitions.items():
        _Repetition(definitions).add_to(schema, has_when=name != root)


class _Repetition:
    def __init__(self, definitions: dict[str, Schema]) -> None:
        self._definitions = definitions

    def add_to(self, schema: Schema, *, has_when: bool = True) -> None:
        """Add repetition to a schema, but not to the definitions that it refers to."""
        if is_plain(schema):
            return
        for branch in branches(schema):
            if branch is not schema:
                self.add_to(branch)
        properties = mapping(schema.get("properties", {}))
        for part in properties.values():
            self.add_to(mapping(part))
        if properties and has_when:
            properties.setdefault("when", {**_WHEN})
        if is_list(schema):
            schema["items"] = self._repeatable(mapping(schema["items"]))
        if has_names(schema):
            schema["additionalProperties"] = self._repeatable(mapping(schema["additionalProperties"]))

    def _repeatable(self, schema: Schema) -> Schema:
        """Return the schema of an entry or item with `for` and `when`."""
        self.add_to(schema)
        whole = self._target(schema)
        if is_plain(whole):
            return schema
        parts = [self._target(branch) for branch in branches(whole)]
        for part in parts:
            if is_plain(part):
                continue
            if has_names(part):
                value = {key: inner for key, inner in part.items() if key != "properties"} | _VALUE
                keys = mapping(part.get("properties", {}))
                part["properties"] = {**keys, "for": {**_FOR}, "when": {**_WHEN}, "value": value}
                return schema
            if "properties" in part:
                mapping(part["properties"]).update({"for": {**_FOR}, "when": {**_WHEN}})
                if not any(is_short_form(other) for other in parts):
                    return schema
        if not whole:
            return schema
        union: list[Json] = [*branches(whole)] if "anyOf" in whole else [schema]
        return {"anyOf": [*union, _long_form({**schema, **_VALUE})]}

    def _target(self, schema: Schema) -> Schema:
        """Return the definition that a schema refers to, or the schema itself."""
        name = reference(schema)
        return schema if name is None else self._target(self._definitions[name])


def is_plain(schema: Schema) -> bool:
    """Whether the keys and items of a schema are the author's own."""
    return schema.get("$comment") == PLAIN


def has_names(schema: Schema) -> bool:
    """Whether a schema describes a map keyed by names; a map of the author's own is none."""
    keys, entry = mapping(schema.get("properties", {})).keys(), schema.get("additionalProperties")
    return isinstance(entry, dict) and not is_plain(entry) and not is_plain(schema) and keys <= {*WORDS, *RAW}


def is_short_form(schema: Schema) -> bool:
    """Whether a schema describes a text, a number or a list in place of an object, but not an expression."""
    return "object" not in str(schema.get("type")) and schema.get("pattern") != _EXPRESSION and "type" in schema


_EXPRESSION = r"\$\("
"""The pattern of a text that must be an expression."""


def is_list(schema: Schema) -> bool:
    """Whether a schema describes a list of any length."""
    return isinstance(schema.get("items"), dict) and "minItems" not in schema


def _long_form(value: Schema) -> Schema:
    properties: Schema = {"for": {**_FOR}, "when": {**_WHEN}, "value": value}
    return {"title": LONG_FORM, "type": "object", "properties": properties, "additionalProperties": False}
