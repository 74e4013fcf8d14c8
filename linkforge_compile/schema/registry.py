"""Load schemas/ and join the files: each concept's schema becomes one definition of one whole."""

from __future__ import annotations

import json
from functools import cache

from linkforge_compile.resources import linked_schema_file, schemas_folder
from linkforge_compile.schema.json_types import Json, Schema, mapping, reference
from linkforge_compile.schema.repetition import add_repetition

IDENTIFIER = "https://linkforge.dev/schema/v1/robot.schema.json"
"""Names version 1 of the language's schema; an identifier, never fetched."""

ROOT = "robot"
"""The schema of a whole file; a module has the same."""

_SUFFIX = ".schema.json"


def load_files() -> dict[str, Schema]:
    """Return every schema file by its concept: `joint` for joint.schema.json; sorted, as read."""
    paths = sorted(schemas_folder().glob(f"*{_SUFFIX}"))
    return {path.name.removesuffix(_SUFFIX): json.loads(path.read_text(encoding="utf-8")) for path in paths}


@cache
def definitions() -> dict[str, Schema]:
    """Return every concept and every definition of every file by name, `$ref`s turned to `#/definitions/NAME`.

    Every object takes `when` and, where it is an entry or an item, `for`, though no file says so.
    All of them share one namespace; two with one name are a fault of ours, raised as ValueError.
    """
    joined: dict[str, Schema] = {}
    for concept, schema in load_files().items():
        own = {key: value for key, value in schema.items() if key not in {"$schema", "definitions"}}
        parts = mapping(schema.get("definitions", {}))
        for name, part in (({concept: own} if "type" in own else {}) | parts).items():
            if name in joined:
                raise ValueError(f"two schemas define '{name}'")
            joined[name] = mapping(_flattened(part))
    add_repetition(joined, ROOT)
    return joined


@cache
def definitions_with_patches() -> dict[str, Schema]:
    """Return all definitions and the patch forms that `override` and `defaults` take, as `link_patch`."""
    # Imported by whoever makes the whole schema, which an installed package only reads.
    from linkforge_compile.schema.patches import add_patches

    return add_patches(definitions(), ROOT)


def linked_schema_text() -> str:
    """Return all definitions as the JSON of one schema, in which each `$ref` names that schema.

    The build of a wheel writes it to `linked_schema_file()`: an installed package reads one file and joins none.
    """
    definitions = json.dumps(definitions_with_patches(), ensure_ascii=False)
    absolute = definitions.replace('"$ref": "#/', f'"$ref": "{IDENTIFIER}#/')
    return f'{{"$id": "{IDENTIFIER}", "definitions": {absolute}}}\n'


@cache
def whole_schema() -> Schema:
    """Return what `linked_schema_text()` holds, read from the installed package, made in a checkout."""
    file = linked_schema_file()
    return mapping(json.loads(file.read_text(encoding="utf-8") if file.is_file() else linked_schema_text()))


@cache
def linked() -> Schema:
    """Return the root schema with each `$ref` replaced by its definition itself, shared, not copied.

    A schema that contains itself is a cycle.
    """
    definitions = mapping(whole_schema()["definitions"])
    done: dict[str, Schema] = {}

    def link(node: Json) -> Json:
        if isinstance(node, list):
            return [link(item) for item in node]
        if not isinstance(node, dict):
            return node
        if (target := reference(node)) is not None:
            return link_definition(target)
        return link_object(node, {})

    def link_definition(name: str) -> Schema:
        if name not in done:
            done[name] = {}
            link_object(mapping(definitions[name]), done[name])
        return done[name]

    def link_object(node: Schema, whole: Schema) -> Schema:
        _UNLINKED[id(whole)] = node
        whole.update((key, link(value)) for key, value in node.items())
        return whole

    return link_definition(ROOT)


def unlinked(schema: Schema) -> Schema:
    """Return a part of the linked schema as it is in `whole_schema()`, with its `$ref`s; any other schema itself."""
    return _UNLINKED.get(id(schema), schema)


# The schemas are made once and stay, so their identity is theirs for ever.
_UNLINKED: dict[int, Schema] = {}


def _flattened(node: Json) -> Json:
    """Return a schema with `link.schema.json` and `link.schema.json#/definitions/visual` as bundle references."""
    if isinstance(node, list):
        return [_flattened(item) for item in node]
    if not isinstance(node, dict):
        return node
    return {key: _flattened(value) if key != "$ref" else _local(str(value)) for key, value in node.items()}


def _local(reference: str) -> str:
    file, _, pointer = reference.partition("#/definitions/")
    return f"#/definitions/{pointer or file.removesuffix(_SUFFIX)}"
