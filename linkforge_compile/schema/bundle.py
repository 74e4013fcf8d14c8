"""The one self-contained schema file that editors want."""

from __future__ import annotations

from linkforge_compile.schema.for_editors import EditorForm
from linkforge_compile.schema.json_types import Schema
from linkforge_compile.schema.registry import IDENTIFIER, ROOT, definitions, definitions_with_patches


def bundle() -> Schema:
    """Return the schema of a whole file, with all that it refers to under `definitions`."""
    whole = definitions_with_patches()
    form = EditorForm(whole)
    parts = {name: form.of(part, is_patch=name not in definitions()) for name, part in whole.items()}
    root = {**parts.pop(ROOT), "type": "object"}
    return {"$schema": "http://json-schema.org/draft-07/schema#", "$id": IDENTIFIER, **root, "definitions": {**parts}}


def bundle_text() -> str:
    """Return the bundle as JSON text, the same bytes on every run and machine."""
    import json

    return json.dumps(bundle(), ensure_ascii=False, indent=2) + "\n"
