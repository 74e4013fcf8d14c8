"""Makes patch forms of schemas, for `override` and `defaults`: null deletes, and a map of positions patches a list."""

from __future__ import annotations

from linkforge_compile.schema.json_types import Json, Schema, branches, mapping, reference
from linkforge_compile.schema.repetition import LONG_FORM, WORDS, has_names, is_list, is_plain

PATCH = "patch"
"""Beside a `$ref`, this `$comment` says that the patch form of what it refers to is meant."""

POSITION = "^[0-9]+$"
"""The keys by which a map patches a list; the first item is 0."""

PATCH_SUFFIX = "_patch"
"""How the names of patch forms end."""

_NOT_PATCHED = frozenset(
    {"linkforge", "name", "version", "description", "metadata", "parameters", "variables", "data", "variants"}
    | {"packages", "include", "defaults", "frames"}
)
"""Keys of a robot that no override reaches: what computes it, and frames, which are links and joints by then."""


def add_patches(definitions: dict[str, Schema], root: str) -> dict[str, Schema]:
    """Return the definitions with the patch form of each that is referred to so, as `link_patch`."""
    forms = _PatchForms(definitions, root)
    whole = {name: mapping(forms.led_to_patches(schema)) for name, schema in definitions.items()}
    return {**whole, **forms.made()}


class _PatchForms:
    def __init__(self, definitions: dict[str, Schema], root: str) -> None:
        self._definitions = definitions
        self._root = root
        self._wanted: dict[str, Schema | None] = {}

    def led_to_patches(self, node: Json) -> Json:
        """Return a schema in which every reference marked as a patch leads to the patch form."""
        if isinstance(node, list):
            return [self.led_to_patches(item) for item in node]
        if not isinstance(node, dict):
            return node
        if node.get("$comment") == PATCH and reference(node) is not None:
            return self._reference(node)
        return {key: self.led_to_patches(value) for key, value in node.items()}

    def made(self) -> dict[str, Schema]:
        """Return all patch forms that are wanted, and those that these want."""
        while waiting := [name for name, form in self._wanted.items() if form is None]:
            for name in waiting:
                self._wanted[name] = self._whole(name)
        return {f"{name}{PATCH_SUFFIX}": form for name, form in self._wanted.items() if form is not None}

    def _whole(self, name: str) -> Schema:
        form = self._form(self._definitions[name])
        if name != self._root:
            return form
        properties = {key: part for key, part in mapping(form["properties"]).items() if key not in _NOT_PATCHED}
        return {
            "title": "an override",
            "type": ["object", "string"],
            "pattern": "\\$\\(",
            "patternErrorMessage": "expected a map of what to change in the module",
            "properties": {**properties, "when": {"$ref": "#/definitions/when"}},
            "additionalProperties": False,
        }

    def _reference(self, schema: Schema) -> Schema:
        name = reference(schema)
        assert name is not None, "asked of references only"
        self._wanted.setdefault(name, None)
        kept = {key: value for key, value in schema.items() if key != "$comment"}
        return {**kept, "$ref": f"#/definitions/{name}{PATCH_SUFFIX}"}

    def _form(self, schema: Schema) -> Schema:
        if is_plain(schema) or schema.get("title") == LONG_FORM:
            return schema
        if reference(schema) is not None:
            return self._reference(schema)
        if "anyOf" in schema:
            return {**schema, "anyOf": [*self._union(branches(schema))]}
        form = self._or_null(schema)
        if "properties" in form:
            form["properties"] = {
                key: part if key in WORDS else self._form(mapping(part))
                for key, part in mapping(form["properties"]).items()
            }
        if has_names(schema):
            form["additionalProperties"] = self._form(mapping(form["additionalProperties"]))
        if not is_list(schema):
            return form
        union: list[Json] = [form, self._positions(schema)]
        return {"anyOf": union, **_said_of(schema)}

    def _union(self, parts: list[Schema]) -> list[Schema]:
        """Return the branches of a union; where one is a list of another, a map may be either's patch."""
        lists = [part for part in parts if is_list(part)]
        objects = [part for part in parts if self._is_object(part)]
        forms = [self._form(part) for part in parts if part not in lists and not (lists and part in objects)]
        if lists:
            forms += [self._or_null(part) for part in lists]
            positions = self._positions(lists[0])
            for part in objects:
                form = self._form(self._target(part))
                forms.append({**form, "patternProperties": positions["patternProperties"]})
            if not objects:
                forms.append(positions)
        return forms

    def _positions(self, schema: Schema) -> Schema:
        """Return the map of patches by position for a list."""
        item = self._form(mapping(schema["items"]))
        return {
            "title": "items by position",
            "type": "object",
            "patternProperties": {POSITION: item},
            "additionalProperties": False,
        }

    def _is_object(self, schema: Schema) -> bool:
        target = self._target(schema)
        return "properties" in target and target.get("title") != LONG_FORM

    def _target(self, schema: Schema) -> Schema:
        name = reference(schema)
        return schema if name is None else self._target(self._definitions[name])

    def _or_null(self, schema: Schema) -> Schema:
        kinds = schema.get("type")
        form: Schema = {key: value for key, value in schema.items() if key != "defaultSnippets"}
        if kinds is not None:
            listed: list[Json] = [*kinds] if isinstance(kinds, list) else [kinds]
            form["type"] = listed if "null" in listed else [*listed, "null"]
        if isinstance(words := schema.get("enum"), list):
            form["enum"] = [*words, None]
        return form


def _said_of(schema: Schema) -> Schema:
    return {key: value for key, value in schema.items() if key.endswith(("escription", "examples"))}
