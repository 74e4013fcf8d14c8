"""The schema of one repository: that of the language, and for each of its specs the words that it may use.

The words are only offered. What is wrong is judged by the language's schema and by the compiler, so that a name that
is new since this schema was written is no fault.
"""

from __future__ import annotations

import posixpath
from collections.abc import Sequence
from urllib.parse import quote

from linkforge_compile.editor.module_words import entry_of, where_used
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
    modules = _Modules(vocabularies)
    offers: list[Json] = []
    made: Schema = {}
    for file, vocabulary in [(file, words) for words in vocabularies for file in words.files]:
        others = [other.files[0] for other in vocabularies if other.files[0] not in vocabulary.files]
        usable = [_from(posixpath.dirname(file), other) for other in sorted(others)]
        prefix = f"words_{len(offers) + 1}_"
        words = Words(definitions, vocabulary, usable, modules.used_in(file, vocabulary), prefix=prefix)
        offers.append({"if": {"filePatternAssociation": f"*/{quote(file)}"}, "then": words.of(whole)})
        made |= words.made
    return {**whole, "allOf": offers, "definitions": {**definitions, **modules.made, **made}}


class _Modules:
    """What there is to offer in entries that use specs of the workspace; `made` are the definitions it needs.

    They are the same for all files of a folder, which name other files alike.
    """

    def __init__(self, vocabularies: Sequence[Vocabulary]) -> None:
        self._specs = {words.files[0]: words for words in vocabularies}
        self._entries: dict[str, Schema] = {}
        self._folders: dict[str, Schema] = {}
        self.made: Schema = {}
        for number, (file, words) in enumerate(self._specs.items(), start=1):
            self._entries[file] = self._defined(f"module_{number}", entry_of(words.parameters, words.entries))

    def used_in(self, file: str, vocabulary: Vocabulary) -> list[Schema]:
        """Return what to offer where a file uses others; its own spelling of a path and packages included."""
        folder = posixpath.dirname(file)
        if folder not in self._folders:
            offers: list[Json] = [where_used(_from(folder, spec), entry) for spec, entry in self._entries.items()]
            self._folders[folder] = self._defined(f"modules_from_{len(self._folders) + 1}", {"allOf": offers})
        of_its_own = []
        for use, parameters in vocabulary.arguments.items():
            spec = posixpath.normpath(posixpath.join(folder, use))
            if spec not in self._specs:
                of_its_own.append(where_used(use, entry_of(parameters, {})))
            elif use != _from(folder, spec):
                of_its_own.append(where_used(use, self._entries[spec]))
        return [self._folders[folder], *of_its_own]

    def _defined(self, name: str, schema: Schema) -> Schema:
        self.made[name] = schema
        return {"$ref": f"#/definitions/{name}"}


def _from(folder: str, file: str) -> str:
    """Return the path of a file as a `use` in a file of the folder writes it."""
    return posixpath.relpath(file, folder or ".")


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
