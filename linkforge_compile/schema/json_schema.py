"""Schemas as Python values, and what our schema files leave out: repetition and patch forms."""

from __future__ import annotations

from typing import TypeAlias

Json: TypeAlias = None | bool | int | float | str | list["Json"] | dict[str, "Json"]
Schema: TypeAlias = dict[str, Json]


class LinkedSchema(dict[str, Json]):
    """A part of the linked schema; `source` is the same part with its `$ref`s.

    Hashed and compared by identity: schemas that contain themselves cannot be compared by content.
    """

    def __init__(self, source: Schema) -> None:
        super().__init__(source)
        self.source = source

    # dict has no hash, as it is mutable; a linked schema is never changed.
    def __hash__(self) -> int:  # type: ignore[override]
        return id(self)

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other


def mapping(node: object) -> Schema:
    """Return a node as an object; raise TypeError if it is not one, which our schemas rule out."""
    if not isinstance(node, dict):
        raise TypeError(f"expected a JSON object, found {node!r}")
    return node


def linked_part(node: object) -> LinkedSchema:
    """Return a part of the linked schema; raise TypeError for anything else."""
    if not isinstance(node, LinkedSchema):
        raise TypeError(f"expected a part of the linked schema, found {node!r}")
    return node


def branches(schema: Schema) -> list[Schema]:
    """Return the branches of the schema's `anyOf`, or the schema itself."""
    union = schema.get("anyOf")
    return [mapping(branch) for branch in union] if isinstance(union, list) else [schema]


def reference(schema: Schema) -> str | None:
    """Return the name of the definition that a schema refers to; None for one without `$ref`."""
    target = schema.get("$ref")
    return target.rpartition("#/definitions/")[2] if isinstance(target, str) else None


PLAIN = "plain"
"""The `$comment` of a schema whose keys and items are the author's own, even `for`, `when` and `value`."""

FOR_PLUGINS = "plain, for plugins"
"""The `$comment` of a schema whose keys and items are those of a plugin, but for `when` and `for` where these could be
no data of a plugin: `when` with true, false or an expression, `for` with a map.
"""

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
    "description": "The value, once or for each iteration of 'for'.",
    "markdownDescription": "The value, once or for each iteration of `for`."
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
        entry = schema.get("additionalProperties")
        if isinstance(entry, dict) and (is_for_plugins(schema) or is_for_plugins(entry)):
            long_form = _long_form({**entry, **_VALUE})
            schema["additionalProperties"] = {"$comment": FOR_PLUGINS, "anyOf": [entry, long_form]}
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
    return schema.get("$comment") in (PLAIN, FOR_PLUGINS)


def is_for_plugins(schema: Schema) -> bool:
    """Whether the keys and items of a schema are those of a plugin, among which `for` and `when` may be."""
    return schema.get("$comment") == FOR_PLUGINS


def has_names(schema: Schema) -> bool:
    """Whether a schema describes a map keyed by names; a map of the author's own is none."""
    keys, entry = mapping(schema.get("properties", {})).keys(), schema.get("additionalProperties")
    return isinstance(entry, dict) and not is_plain(entry) and not is_plain(schema) and keys <= {*WORDS, *RAW}


def is_short_form(schema: Schema) -> bool:
    """Whether a schema describes a text, a number or a list in place of an object, but not an expression."""
    return "object" not in str(schema.get("type")) and schema.get("pattern") != EXPRESSION and "type" in schema


EXPRESSION = r"\$\("
"""The pattern of a text that must be an expression."""


def is_list(schema: Schema) -> bool:
    """Whether a schema describes a list of any length."""
    return isinstance(schema.get("items"), dict) and "minItems" not in schema


def _long_form(value: Schema) -> Schema:
    properties: Schema = {"for": {**_FOR}, "when": {**_WHEN}, "value": value}
    return {"title": LONG_FORM, "type": "object", "properties": properties, "additionalProperties": False}


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
        descriptions = {key: value for key, value in schema.items() if key.endswith(("escription", "examples"))}
        return {"anyOf": [form, self._positions(schema)], **descriptions}

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
