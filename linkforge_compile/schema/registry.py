"""Loads schemas/ and joins the files: each concept's schema becomes one definition of one whole."""

from __future__ import annotations

from functools import cache

from linkforge_compile.resources import schemas_folder
from linkforge_compile.schema.json_types import Json, Schema, mapping, reference
from linkforge_compile.schema.repetition import add_repetition

ROOT = "robot"
"""The schema of a whole file; a module has the same."""

_SUFFIX = ".schema.json"


def load_files() -> dict[str, Schema]:
    """Return every schema file by its concept: `joint` for joint.schema.json; sorted, as read."""
    import json

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
    # Asked for by who makes the whole anew, and by editors.
    from linkforge_compile.schema.patches import add_patches

    return add_patches(definitions(), ROOT)


@cache
def linked() -> Schema:
    """Return the root schema with each `$ref` replaced by its definition itself, shared, not copied.

    A validator then looks nothing up, which is half of its time; a schema that contains itself is a cycle.
    To put it together takes as long as a twelfth of a whole compile, so what an earlier process made is taken.
    """
    return _linked()


def _linked() -> Schema:
    done: dict[str, Schema] = {}

    def link(node: Json) -> Json:
        if isinstance(node, list):
            return [link(item) for item in node]
        if not isinstance(node, dict):
            return node
        if (target := reference(node)) is not None:
            return link_definition(target)
        return {key: link(value) for key, value in node.items()}

    def link_definition(name: str) -> Schema:
        if name not in done:
            done[name] = {}
            done[name].update(mapping(link(definitions_with_patches()[name])))
        return done[name]

    return link_definition(ROOT)


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
