"""The schema of one repository: that of the language, and for each of its specs the words that it may use.

The words are only offered. What is wrong is judged by the language's schema and by the compiler, so that a name that
is new since this schema was written is no fault.
"""

from __future__ import annotations

import posixpath
from collections.abc import Sequence
from urllib.parse import quote

from linkforge_compile.editor.vocabulary import Vocabulary
from linkforge_compile.editor.words import ARGUMENT, NAMES, Words, mark_of
from linkforge_compile.schema import bundle
from linkforge_compile.schema.json_types import Json, Schema, mapping


def workspace_text(vocabularies: Sequence[Vocabulary]) -> str:
    """Return the schema as JSON text, the same bytes for the same words."""
    import json

    return json.dumps(workspace_schema(vocabularies), ensure_ascii=False, indent=2) + "\n"


def workspace_schema(vocabularies: Sequence[Vocabulary]) -> Schema:
    """Return the schema of a repository's specs, which holds for each of its files what is offered in it alone."""
    whole = mapping(_without_examples(bundle()))
    definitions = {name: mapping(part) for name, part in mapping(whole["definitions"]).items()}
    specs = sorted(vocabulary.files[0] for vocabulary in vocabularies)
    offers: list[Json] = []
    made: Schema = {}
    for file, vocabulary in [(file, words) for words in vocabularies for file in words.files]:
        usable = [_from(file, spec) for spec in specs if spec not in vocabulary.files]
        words = Words(definitions, vocabulary, usable, prefix=f"words_{len(offers) + 1}_")
        offers.append({"if": {"filePatternAssociation": f"*/{quote(file)}"}, "then": words.of(whole)})
        made |= words.made
    return {**whole, "allOf": offers, "definitions": {**definitions, **made}}


def _from(file: str, other: str) -> str:
    """Return the path of another file as a `use` in this file writes it."""
    return posixpath.relpath(other, posixpath.dirname(file) or ".")


def _without_examples(node: Json) -> Json:
    """Return a schema that does not offer made-up names where there are real ones."""
    if isinstance(node, list):
        return [_without_examples(item) for item in node]
    if not isinstance(node, dict):
        return node
    whole = {key: _without_examples(part) for key, part in node.items()}
    what, kinds = mark_of(node)
    if ARGUMENT in kinds:
        whole.pop("defaultSnippets", None)
    if what != NAMES or "examples" not in whole:
        return whole
    said = {key: whole.pop(key) for key in _SAID if key in whole}
    del whole["examples"]
    # By a union the server knows to put in the key with its colon, as otherwise by examples.
    return {**said, "anyOf": [whole]}


_SAID = ("$comment", "description", "markdownDescription")
"""What is said of a property beside what it takes."""
