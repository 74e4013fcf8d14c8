"""The schema of one repository: that of the language, and for each of its specs the words that it may use.

The words are only offered. What is wrong is judged by the language's schema and by the compiler, so that a name that
is new since this schema was written is no fault.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Sequence
from urllib.parse import quote

from linkforge_compile.editor.module_words import entry_of, where_used
from linkforge_compile.editor.spec_paths import SpecPaths
from linkforge_compile.editor.vocabulary import Vocabulary
from linkforge_compile.editor.words import ARGUMENT, NAMES, Words, mark_of
from linkforge_compile.schema.bundle import bundle
from linkforge_compile.schema.json_types import Json, Schema, mapping


def without_parts(vocabularies: Iterable[Vocabulary]) -> tuple[Vocabulary, ...]:
    """Leave out files without a name that others include: they have the words of those, and are no modules."""
    known = tuple(vocabularies)
    included = {file for words in known for file in words.files[1:]}
    return tuple(words for words in known if words.has_name or words.files[0] not in included)


def workspace_text(vocabularies: Sequence[Vocabulary]) -> str:
    """Return the schema as JSON text, the same bytes for the same words."""
    import json

    return json.dumps(workspace_schema(vocabularies), ensure_ascii=False, indent=2) + "\n"


def workspace_schema(vocabularies: Sequence[Vocabulary]) -> Schema:
    """Return the schema of a repository's specs, which holds for each of its files what is offered in it alone."""
    whole = mapping(_without_examples(bundle()))
    definitions = {name: mapping(part) for name, part in mapping(whole["definitions"]).items()}
    # A file that is included from outside of the workspace has no path by which it is known.
    files = [(file, words) for words in vocabularies for file in words.files if not file.startswith("../")]
    known = dict(files)
    modules = _Modules(vocabularies)
    parts = SpecPaths({file: {} for file, words in files if file != words.files[0]}, kind="part", is_list=True)
    offers: list[Json] = []
    made: Schema = {}
    for file, vocabulary in files:
        folder = posixpath.dirname(file)
        paths = modules.paths.paths_from(folder, vocabulary.files)
        used = modules.used_in(file, vocabulary)
        words = Words(
            definitions, vocabulary, paths, parts.paths_from(folder, (file,)), used, prefix=f"words_{len(offers) + 1}_"
        )
        offers.append(_in_file(file, words.of(whole), known))
        made |= words.made
    return {**whole, "allOf": offers, "definitions": {**definitions, **modules.made, **parts.made, **made}}


def _in_file(file: str, offer: Schema, files: Iterable[str]) -> Schema:
    """Return an offer for one file, which the server knows by the end of its path; another may end alike."""
    for longer in files:
        if longer.endswith(f"/{file}"):
            offer = {"if": _path_of(longer), "then": {}, "else": offer}
    return {"if": _path_of(file), "then": offer}


def _path_of(file: str) -> Schema:
    return {"filePatternAssociation": f"*/{quote(file)}"}


class _Modules:
    """What there is to offer in entries that use specs of the workspace; `made` are the definitions it needs."""

    def __init__(self, vocabularies: Sequence[Vocabulary]) -> None:
        specs = {words.files[0]: words for words in vocabularies}
        self._entries = {spec: f"module_{number}" for number, spec in enumerate(specs, start=1)}
        self.paths = SpecPaths({spec: _reference(name) for spec, name in self._entries.items()})
        self._made: Schema = {
            self._entries[spec]: entry_of(words.parameters, words.entries) for spec, words in specs.items()
        }

    @property
    def made(self) -> Schema:
        return self._made | self.paths.made

    def used_in(self, file: str, vocabulary: Vocabulary) -> list[Json]:
        """Return what to offer where a file uses others; its own spelling of a path and packages included."""
        folder = posixpath.dirname(file)
        offers = self.paths.entries_from(folder)
        for use, parameters in vocabulary.arguments.items():
            spec = posixpath.normpath(posixpath.join(folder, use))
            if spec not in self._entries:
                offers.append(where_used(use, entry_of(parameters, {})))
            elif use != posixpath.relpath(spec, folder or "."):
                offers.append(where_used(use, _reference(self._entries[spec])))
        return offers


def _reference(name: str) -> Schema:
    return {"$ref": f"#/definitions/{name}"}


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
