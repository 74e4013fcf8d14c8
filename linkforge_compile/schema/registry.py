"""The schemas of all files as one linked schema, and its fast validator."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING

from linkforge_compile.resources import linked_schema_file, schemas_folder
from linkforge_compile.schema.json_schema import (
    Json,
    LinkedSchema,
    Schema,
    add_patches,
    add_repetition,
    mapping,
    reference,
)
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar

if TYPE_CHECKING:
    from jsonschema_rs import Draft7Validator, Registry


IDENTIFIER = "https://linkforge.dev/schema/v1/robot.schema.json"
"""The `$id` of the schema of version 1 of the language; it is never fetched."""

ROOT = "robot"
"""The definition of a whole file, which may be a module."""

_SUFFIX = ".schema.json"


def load_files() -> dict[str, Schema]:
    """Return the content of the schema files by concept, `joint` for joint.schema.json, in alphabetical order."""
    paths = sorted(schemas_folder().glob(f"*{_SUFFIX}"))
    return {path.name.removesuffix(_SUFFIX): json.loads(path.read_text(encoding="utf-8")) for path in paths}


@cache
def definitions() -> dict[str, Schema]:
    """Return the concepts and definitions of all files by name, their `$ref`s as `#/definitions/NAME`.

    `when` and `for` are added, which the files leave out. Raises ValueError if two files define the same name.
    """
    joined: dict[str, Schema] = {}
    for concept, schema in load_files().items():
        own = {key: value for key, value in schema.items() if key not in {"$schema", "definitions"}}
        parts = mapping(schema.get("definitions", {}))
        for name, part in (({concept: own} if "type" in own else {}) | parts).items():
            if name in joined:
                raise ValueError(f"two schemas define '{name}'")
            joined[name] = mapping(_with_local_references(part))
    add_repetition(joined, ROOT)
    return joined


@cache
def definitions_with_patches() -> dict[str, Schema]:
    """Return all definitions and their patch forms for `override` and `defaults`, such as `link_patch`."""
    return add_patches(definitions(), ROOT)


def linked_schema_text() -> str:
    """Return all definitions as the JSON of one schema, with absolute `$ref`s.

    Building a wheel writes it to `linked_schema_file()`, so that an installed package reads one file.
    """
    definitions = json.dumps(definitions_with_patches(), ensure_ascii=False)
    absolute = definitions.replace('"$ref": "#/', f'"$ref": "{IDENTIFIER}#/')
    return f'{{"$id": "{IDENTIFIER}", "definitions": {absolute}}}\n'


@cache
def whole_schema() -> Schema:
    """Return the schema of `linked_schema_text()`, read from an installed package or made in a checkout."""
    file = linked_schema_file()
    return mapping(json.loads(file.read_text(encoding="utf-8") if file.is_file() else linked_schema_text()))


@cache
def linked() -> LinkedSchema:
    """Return the root schema with each `$ref` replaced by its definition, which is shared, not copied.

    A schema that contains itself is a cycle.
    """
    definitions = mapping(whole_schema()["definitions"])
    done: dict[str, LinkedSchema] = {}

    def link(node: Json) -> Json:
        if isinstance(node, list):
            return [link(item) for item in node]
        if not isinstance(node, dict):
            return node
        if (target := reference(node)) is not None:
            return link_definition(target)
        return fill(LinkedSchema(node))

    def link_definition(name: str) -> LinkedSchema:
        if name not in done:
            done[name] = LinkedSchema(mapping(definitions[name]))
            fill(done[name])
        return done[name]

    def fill(schema: LinkedSchema) -> LinkedSchema:
        schema.update((key, link(value)) for key, value in schema.source.items())
        return schema

    return link_definition(ROOT)


def _with_local_references(node: Json) -> Json:
    """Return a schema with its `$ref`s to files, `link.schema.json#/definitions/visual`, as local ones."""
    if isinstance(node, list):
        return [_with_local_references(item) for item in node]
    if not isinstance(node, dict):
        return node
    local = {key: _with_local_references(value) for key, value in node.items()}
    if "$ref" in node:
        file, _, pointer = str(node["$ref"]).partition("#/definitions/")
        local["$ref"] = f"#/definitions/{pointer or file.removesuffix(_SUFFIX)}"
    return local


HEADER = ("linkforge", "name")
"""The keys that every file needs; an included file needs the first only."""

FAULTY = object()
"""Takes the place of a YamlFault in plain data; it has no JSON type, so every schema with a type rejects it."""


def accepts(schema: LinkedSchema, node: YamlNode) -> bool:
    """Whether a node is valid by a part of the linked schema; jsonschema then finds no error in it either.

    False does not imply that an error is reported: faults and fields without a value are skipped, and only
    jsonschema accepts infinity as a number.
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
