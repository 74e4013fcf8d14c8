"""The JSON Schema of one repository: that of the language, with completions for each of its specs.

It accepts what the language's schema accepts, so that a name which is newer than the schema is not an error.
"""

from __future__ import annotations

import json
import posixpath
from collections.abc import Iterable, Sequence
from urllib.parse import quote

from linkforge_compile.editor.bundle import bundle
from linkforge_compile.editor.completions import (
    ARGUMENT,
    NAMES,
    Completions,
    SpecPaths,
    complete_macros,
    complete_module,
    if_used,
    marked_names,
)
from linkforge_compile.editor.vocabulary import Vocabulary
from linkforge_compile.schema.json_schema import Json, Schema, mapping


def without_parts(vocabularies: Iterable[Vocabulary]) -> tuple[Vocabulary, ...]:
    """Leave out files without a name that other specs include: they complete the words of those specs."""
    known = tuple(vocabularies)
    included = {file for vocabulary in known for file in vocabulary.files[1:]}
    return tuple(one for one in known if one.has_name or one.files[0] not in included)


def workspace_text(vocabularies: Sequence[Vocabulary]) -> str:
    """Return the schema as JSON text, with the same bytes for the same vocabularies."""
    return json.dumps(workspace_schema(vocabularies), ensure_ascii=False, indent=2) + "\n"


def workspace_schema(vocabularies: Sequence[Vocabulary]) -> Schema:
    """Return the schema of a repository's specs, in which each completion applies to one file."""
    whole = mapping(_without_examples(bundle()))
    language = {name: mapping(part) for name, part in mapping(whole["definitions"]).items()}
    # The server knows a file by its path in the workspace; an included file may be outside.
    files = [(file, one) for one in vocabularies for file in one.files if not file.startswith("../")]
    paths = dict(files)
    modules = _Modules(vocabularies)
    parts = SpecPaths({file: {} for file, one in files if file != one.files[0]}, kind="part", is_list=True)
    rules: list[Json] = []
    definitions: Schema = {}
    for number, (file, vocabulary) in enumerate(files, start=1):
        folder = posixpath.dirname(file)
        completions = Completions(
            language,
            vocabulary,
            modules.paths.paths_from(folder, vocabulary.files),
            parts.paths_from(folder, (file,)),
            modules.used_in(file, vocabulary),
            prefix=f"words_{number}_",
        )
        rules.append(_if_file(file, completions.complete(whole), paths))
        definitions |= completions.definitions
    return {
        **whole,
        # JSON Schema has no empty `allOf`. There are no files where all are parts that include each other.
        **({"allOf": rules} if rules else {}),
        "definitions": {**language, **modules.definitions, **parts.definitions, **definitions},
    }


def _if_file(file: str, completion: Schema, files: Iterable[str]) -> Schema:
    """Return a completion that applies to one file; the server compares ends of paths, and another may end alike."""
    for longer in files:
        if longer.endswith(f"/{file}"):
            completion = {"if": _path_pattern(longer), "then": {}, "else": completion}
    return {"if": _path_pattern(file), "then": completion}


def _path_pattern(file: str) -> Schema:
    return {"filePatternAssociation": f"*/{quote(file)}"}


class _Modules:
    """Completions for entries that use specs of the workspace."""

    def __init__(self, vocabularies: Sequence[Vocabulary]) -> None:
        specs = {vocabulary.files[0]: vocabulary for vocabulary in vocabularies}
        self._names = {spec: f"module_{number}" for number, spec in enumerate(specs, start=1)}
        self.paths = SpecPaths({spec: _reference(name) for spec, name in self._names.items()})
        self._definitions: Schema = {
            self._names[spec]: complete_module(one.parameters, one.entries) for spec, one in specs.items()
        }

    @property
    def definitions(self) -> Schema:
        """The definitions to which the completions refer."""
        return self._definitions | self.paths.definitions

    def used_in(self, file: str, vocabulary: Vocabulary) -> list[Json]:
        """Return the completions in a file, also for specs that it names in its own way or that are in packages."""
        folder = posixpath.dirname(file)
        completions = self.paths.entries_from(folder)
        for use, used in vocabulary.used.items():
            spec = posixpath.normpath(posixpath.join(folder, use))
            if spec not in self._names:
                completions.append(if_used(use, complete_module(used.parameters, used.entries)))
                completions += [if_used(use, complete_macros(used.macros))] if used.macros else []
            elif use != posixpath.relpath(spec, folder or "."):
                completions.append(if_used(use, _reference(self._names[spec])))
        return completions


def _reference(name: str) -> Schema:
    return {"$ref": f"#/definitions/{name}"}


def _without_examples(node: Json) -> Json:
    """Return a schema without made-up names as examples where completions have real ones."""
    if isinstance(node, list):
        return [_without_examples(item) for item in node]
    if not isinstance(node, dict):
        return node
    whole = {key: _without_examples(part) for key, part in node.items()}
    what, kinds = marked_names(node)
    if ARGUMENT in kinds:
        whole.pop("defaultSnippets", None)
    if what != NAMES or "examples" not in whole:
        return whole
    described = {key: whole.pop(key) for key in _DESCRIPTION if key in whole}
    del whole["examples"]
    # With a union, as with examples, the server inserts a key with its colon.
    return {**described, "anyOf": [whole]}


_DESCRIPTION = ("$comment", "description", "markdownDescription")
"""The keys of a property's schema that describe it, and do not restrict its value."""
