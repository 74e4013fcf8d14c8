"""Make patch forms of schemas for `override` and `defaults`: null deletes, and a map by position patches a list."""

from __future__ import annotations

from linkforge_compile.schema.json_types import Json, Schema, branches, mapping, reference
from linkforge_compile.schema.repetition import LONG_FORM, WORDS, has_names, is_list, is_plain

PATCH = "patch"
"""The `$comment` of a `$ref` to the patch form of a definition."""

POSITION = "^[0-9]+$"
"""The keys of a map that patches a list by position, from 0."""

PATCH_SUFFIX = "_patch"
"""The suffix of the names of patch forms."""

_NOT_PATCHED = frozenset(
    {"linkforge", "name", "version", "description", "metadata", "parameters", "variables", "data", "variants"}
    | {"packages", "include", "defaults", "frames"}
)
"""Keys of a robot that no override changes: those it is computed from, and frames, which are links and joints then."""


def add_patches(definitions: dict[str, Schema], root: str) -> dict[str, Schema]:
    """Return the definitions and the patch forms that they refer to, such as `link_patch`."""
    forms = _PatchForms(definitions, root)
    whole = {name: mapping(forms.with_patch_references(schema)) for name, schema in definitions.items()}
    return {**whole, **forms.make()}


class _PatchForms:
    def __init__(self, definitions: dict[str, Schema], root: str) -> None:
        self._definitions = definitions
        self._root = root
        self._wanted: dict[str, Schema | None] = {}

    def with_patch_references(self, node: Json) -> Json:
        """Return a schema with the references marked as PATCH leading to patch forms."""
        if isinstance(node, list):
            return [self.with_patch_references(item) for item in node]
        if not isinstance(node, dict):
            return node
        if node.get("$comment") == PATCH and reference(node) is not None:
            return self._reference(node)
        return {key: self.with_patch_references(value) for key, value in node.items()}

    def make(self) -> dict[str, Schema]:
        """Return all patch forms that are referred to, also by other patch forms."""
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
        assert name is not None, "called for references only"
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
        return {"anyOf": union, **_descriptions(schema)}

    def _union(self, parts: list[Schema]) -> list[Schema]:
        """Return the branches of a union; next to a list of objects, a map may patch the object or the list."""
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
        """Return the schema of the map that patches a list by position."""
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


def _descriptions(schema: Schema) -> Schema:
    return {key: value for key, value in schema.items() if key.endswith(("escription", "examples"))}
