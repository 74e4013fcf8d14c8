"""Puts `for`, `when` and the long form into the schemas: in all objects alike, so that no schema file says so."""

from __future__ import annotations

from linkforge_compile.schema.json_types import Json, Schema, branches, mapping, reference

PLAIN = "plain"
"""A schema with this `$comment` has keys and items that are the author's: `for`, `when` and `value` too."""

LONG_FORM = "the long form"
"""The title of what an entry or item may be that is no object: `{for: {i: 3}, value: joint_$(i)}`."""

XML = "XML"
"""The title of what is raw XML."""

WORDS = ("for", "when", "value")

RAW = ("extra", "extra_attributes", "extra_inside")
"""What most objects may say; the only keys but WORDS that are no names in a map keyed by names."""

_FOR: Schema = {"$ref": "#/definitions/for"}
_WHEN: Schema = {"$ref": "#/definitions/when"}
_VALUE: Schema = {
    "description": "What stands here, once or as often as 'for' says.",
    "markdownDescription": "What stands here, once or as often as `for` says."
    "\n\n```yaml\n{for: {i: 3}, value: joint_$(i)}\n```",
}


def add_repetition(definitions: dict[str, Schema], root: str) -> None:
    """Change every definition so that it admits repetition: `when` in objects, `for` in entries and items as well.

    What is no object takes the long form there; in a map of names, it is the three words that are no names.
    Lists of a fixed length are one value, such as a vector, and repeat nothing within.
    """
    for name, schema in definitions.items():
        _Repetition(definitions).admit_in(schema, takes_when=name != root)


class _Repetition:
    def __init__(self, definitions: dict[str, Schema]) -> None:
        self._definitions = definitions

    def admit_in(self, schema: Schema, *, takes_when: bool = True) -> None:
        """Admit repetition in whatever a schema describes, but not in what it refers to."""
        if is_plain(schema):
            return
        for branch in branches(schema):
            if branch is not schema:
                self.admit_in(branch)
        properties = mapping(schema.get("properties", {}))
        for part in properties.values():
            self.admit_in(mapping(part))
        if properties and takes_when:
            properties.setdefault("when", {**_WHEN})
        if is_list(schema):
            schema["items"] = self._repeatable(mapping(schema["items"]))
        if has_names(schema):
            schema["additionalProperties"] = self._repeatable(mapping(schema["additionalProperties"]))

    def _repeatable(self, schema: Schema) -> Schema:
        """Return the schema of an entry or item as one that takes `for` and `when`."""
        self.admit_in(schema)
        whole = self._target(schema)
        if is_plain(whole):
            return schema
        parts = [self._target(branch) for branch in branches(whole)]
        for part in parts:
            if is_plain(part):
                continue
            if has_names(part):
                value = {key: said for key, said in part.items() if key != "properties"} | _VALUE
                said = mapping(part.get("properties", {}))
                part["properties"] = {**said, "for": {**_FOR}, "when": {**_WHEN}, "value": value}
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
        """Return the definition that a schema refers to, itself where it is one."""
        name = reference(schema)
        return schema if name is None else self._target(self._definitions[name])


def is_plain(schema: Schema) -> bool:
    """Whether the keys and items of what a schema describes mean nothing to the compiler."""
    return schema.get("$comment") == PLAIN


def has_names(schema: Schema) -> bool:
    """Whether a schema describes a map keyed by names of things; one of free texts is none."""
    keys, entry = mapping(schema.get("properties", {})).keys(), schema.get("additionalProperties")
    return isinstance(entry, dict) and not is_plain(entry) and not is_plain(schema) and keys <= {*WORDS, *RAW}


def is_short_form(schema: Schema) -> bool:
    """Whether a schema describes what stands in an object's place: a text, a number or a list, but no expression."""
    return "object" not in str(schema.get("type")) and schema.get("pattern") != _EXPRESSION and "type" in schema


_EXPRESSION = r"\$\("
"""The pattern of what is nothing but an expression."""


def is_list(schema: Schema) -> bool:
    """Whether a schema describes a list of any length, whose items are things of their own."""
    return isinstance(schema.get("items"), dict) and "minItems" not in schema


def _long_form(value: Schema) -> Schema:
    properties: Schema = {"for": {**_FOR}, "when": {**_WHEN}, "value": value}
    return {"title": LONG_FORM, "type": "object", "properties": properties, "additionalProperties": False}
