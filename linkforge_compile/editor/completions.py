"""Schemas that complete the words of one spec, and the paths of specs, where they are valid; they accept everything."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from linkforge_compile.editor.vocabulary import Entries, Vocabulary
from linkforge_compile.listing import ListedParameter
from linkforge_compile.schema.json_schema import PATCH_SUFFIX, Json, Schema, branches, mapping, reference
from linkforge_compile.syntax.nodes import scalar_value

NAMES, KEYS = "names", "keys"
"""The start of a `$comment` in a schema whose values, or whose keys, are names: `names: link, joint`."""

FILE, INCLUDED, PARAMETER, ARGUMENT = "file", "included", "parameter", "argument"
"""The kinds of names in a `$comment` that are not parts of a robot: specs, files that specs include, the file's own
parameters, and those of a module that is used.
"""

_BARE = re.compile(r"[\w./-]+")


def marked_names(schema: Schema) -> tuple[str, list[str]]:
    """Return whether values or keys are names (NAMES or KEYS), and of which kinds; ("", []) for neither."""
    what, _, kinds = str(schema.get("$comment", "")).partition(": ")
    return (what, kinds.split(", ")) if what in (NAMES, KEYS) else ("", [])


class Completions:
    """Completions for one file; `definitions` collects the definitions to which they refer."""

    def __init__(
        self,
        language: Mapping[str, Schema],
        vocabulary: Vocabulary,
        paths: Schema,
        included: Schema,
        modules: Sequence[Json],
        *,
        prefix: str,
    ) -> None:
        """`language` has the definitions of the language's schema.

        `paths` completes the values of `use` in this file, `included` those of `include`, and `modules` complete an
        entry that uses a module. `prefix` begins the names of the definitions.
        """
        self._language = language
        self._parameters = vocabulary.parameters
        self._names = vocabulary.names
        self._included = included
        self._paths = paths
        self._modules = modules
        self._prefix = prefix
        self._visited: set[str] = set()
        self.definitions: Schema = {}

    def complete(self, schema: Schema) -> Schema:
        """Return the completions in what a schema of the language describes; an empty schema for none."""
        what, kinds = marked_names(schema)
        if what == NAMES:
            return self._values(schema, kinds)
        if (name := reference(schema)) is not None:
            return self._definition(name)
        parts = {
            "properties": self._properties(schema) | (self._keys(schema, kinds) if what == KEYS else {}),
            "additionalProperties": self._nested(schema, "additionalProperties"),
            "items": self._nested(schema, "items"),
        }
        unions = [*_schemas_at(schema, "anyOf"), *_schemas_at(schema, "allOf")]
        inside: list[Json] = [completion for part in unions if (completion := self.complete(part))]
        properties = mapping(schema.get("properties", {})).values()
        if any(ARGUMENT in marked_names(mapping(part))[1] for part in properties):
            inside += self._modules
        return {key: part for key, part in parts.items() if part} | ({"allOf": inside} if inside else {})

    def _properties(self, schema: Schema) -> Schema:
        """Return the keys of the language with completions in them; its own schema completes the keys themselves."""
        parts = {key: self.complete(mapping(part)) for key, part in mapping(schema.get("properties", {})).items()}
        return {key: {"doNotSuggest": True, "allOf": [part]} for key, part in parts.items() if part}

    def _nested(self, schema: Schema, key: str) -> Schema:
        inner = schema.get(key)
        return self.complete(inner) if isinstance(inner, dict) else {}

    def _definition(self, name: str) -> Schema:
        """Return a reference to the completions in a definition; none in a patch, which names parts of a module."""
        own_name = f"{self._prefix}{name}"
        if name not in self._visited and not name.endswith(PATCH_SUFFIX):
            self._visited.add(name)
            if completion := self.complete(self._language[name]):
                self.definitions[own_name] = completion
        return {"$ref": f"#/definitions/{own_name}"} if own_name in self.definitions else {}

    def _values(self, schema: Schema, kinds: Sequence[str]) -> Schema:
        """Return completions for names of some kinds, as a value or as the items of a list."""
        if FILE in kinds:
            return self._paths
        if INCLUDED in kinds:
            return self._included
        snippets: list[Json] = [
            snippet(name, f"a {kind} of this robot") for kind in kinds for name in self._names.get(kind, ())
        ]
        if not snippets:
            return {}
        shared = self._share("_or_".join((NAMES, *kinds)), {"defaultSnippets": snippets})
        whole = self._language[reference(schema) or ""] if "$ref" in schema else schema
        return {"items": shared} if any("items" in part for part in branches(whole)) else shared

    def _keys(self, schema: Schema, kinds: Sequence[str]) -> Schema:
        """Return completions for the names that are keys of a map, each with the snippet of its entry."""
        if PARAMETER in kinds:
            return complete_arguments(self._parameters)
        entry = schema.get("additionalProperties")
        snippets = entry.get("defaultSnippets") if isinstance(entry, dict) else None
        # With a union, the server inserts a key with its colon.
        completion: Schema = {"anyOf": [self._nested(schema, "additionalProperties")]}
        if snippets:
            completion["defaultSnippets"] = snippets
        names = [name for kind in kinds for name in self._names.get(kind, ())]
        shared = self._share(f"entry_of_{schema.get('title')}", completion) if names else {}
        return dict.fromkeys(names, shared)

    def _share(self, name: str, completion: Schema) -> Schema:
        """Add a definition, unless there is an equal one, and return a reference to it."""
        own_name = f"{self._prefix}{name.replace(' ', '_')}"
        while self.definitions.setdefault(own_name, completion) != completion:
            own_name += "_"
        return {"$ref": f"#/definitions/{own_name}"}


def _schemas_at(schema: Schema, key: str) -> list[Schema]:
    listed = schema.get(key)
    return [mapping(part) for part in listed] if isinstance(listed, list) else []


def snippet(name: str, description: str) -> Schema:
    """Return a snippet that inserts a name, in quotes if YAML would otherwise read another type."""
    return {"label": name, "description": description, "body": re.sub(r"[$}\\]", r"\\\g<0>", in_quotes_if_needed(name))}


def in_quotes_if_needed(name: str) -> str:
    """Return a name as YAML has it: in quotes if it would otherwise read another type."""
    is_plain = _BARE.fullmatch(name) and scalar_value(name) is name
    return name if is_plain else json.dumps(name, ensure_ascii=False)


def complete_module(parameters: Sequence[ListedParameter], entries: Entries) -> Schema:
    """Return completions for an entry of `modules`: parameters under `with`, and names to override."""
    return {
        "properties": {"with": _only_in(complete_arguments(parameters)), "override": _complete_override(entries)},
    }


def complete_macros(macros: Mapping[str, Sequence[ListedParameter]]) -> Schema:
    """Return completions for an entry of `modules` that uses a macro: their names, and their parameters."""
    names: list[Json] = [snippet(name, ", ".join(one.name for one in has)) for name, has in macros.items()]
    rules: list[Json] = [
        {"if": {"properties": {"macro": {"const": name}}, "required": ["macro"]}, "then": complete_module(has, {})}
        for name, has in macros.items()
    ]
    return {"properties": {"macro": {"doNotSuggest": True, "allOf": [{"defaultSnippets": names}]}}, "allOf": rules}


def _complete_override(entries: Sequence[str] | Entries) -> Schema:
    if isinstance(entries, Mapping):
        return _only_in({section: _complete_override(inner) for section, inner in entries.items()})
    # With a union, the server inserts a key with its colon.
    return _only_in({name: {"anyOf": [{}]} for name in entries})


def if_used(use: str, completion: Schema) -> Schema:
    """Return a completion that applies to entries whose `use` is this text."""
    return {"if": {"properties": {"use": {"const": use}}, "required": ["use"]}, "then": completion}


def complete_arguments(parameters: Sequence[ListedParameter]) -> Schema:
    """Return completions for parameters as keys, with their descriptions and values."""
    return {parameter.name: _complete_argument(parameter) for parameter in parameters}


def _only_in(properties: Schema) -> Schema:
    """Return completions for keys inside a key of the language, which the language's own schema completes."""
    return {"doNotSuggest": True, "properties": properties}


def _complete_argument(parameter: ListedParameter) -> Schema:
    """Return a parameter's description, type and limits, with its choices or its default as values."""
    unit = f" {parameter.unit}" if parameter.unit else ""
    facts = [f"type `{parameter.type}`"] if parameter.type else []
    default = "required" if parameter.default is None else f"default `{parameter.default}`"
    facts.append(f"the module's `{parameter.field}`" if parameter.field else default)
    facts += [f"at least `{parameter.minimum}{unit}`"] if parameter.minimum is not None else []
    facts += [f"at most `{parameter.maximum}{unit}`"] if parameter.maximum is not None else []
    text = "\n\n".join(filter(None, (parameter.description, "; ".join(facts))))
    values = [f"{choice}{unit}" if unit else choice for choice in parameter.choices or ()]
    if not values and parameter.type == "boolean":
        values = [True, False]
    elif not values and parameter.value is not None and parameter.type not in ("list", "map", "vector"):
        values = [parameter.default if unit or isinstance(parameter.value, str) else parameter.value]
    elif not values and parameter.value is None and parameter.default and "$" not in parameter.default:
        values = [parameter.default]  # of a xacro, whose defaults are not computed
    completion: Schema = {"title": parameter.type or "a parameter", "description": text.replace("`", "'")}
    # With examples or a union, the server inserts a key with its colon.
    return completion | {"markdownDescription": text} | ({"examples": values} if values else {"anyOf": [{}]})


class SpecPaths:
    """Completions for the specs of a workspace; `definitions` collects the definitions to which they refer.

    A relative path is `../` for each folder that one goes up, and the way down from there. So all files at the same
    depth below a folder share the completions for its specs, and the schema grows with the number of specs, not its
    square.
    """

    def __init__(self, entries: Mapping[str, Schema], *, kind: str = "spec", is_list: bool = False) -> None:
        """`entries` has the completion for an entry that uses a spec, by its path from the workspace.

        `kind` is the word for the specs, and part of the names of definitions. `is_list` says that a file names several
        of them in a list.
        """
        self._kind = kind
        self._is_list = is_list
        self._entries = {spec: entries[spec] for spec in sorted(entries)}
        self._below: dict[str, tuple[str, ...]] = {}
        self._names: dict[tuple[object, ...], str] = {}
        self.definitions: Schema = {}

    def entries_from(self, folder: str) -> list[Json]:
        """Return the completions for entries that use a spec, in a file in the folder."""
        ways = _ways_up(folder)
        return [self._entries_below(above, steps_up) for above, steps_up, _ in ways if self._specs_below(above)]

    def paths_from(self, folder: str, left_out: Collection[str]) -> Schema:
        """Return the completion of a path in a file in the folder, with each other spec once; {} for none."""
        blocks: list[Json] = []
        for above, steps_up, branch in _ways_up(folder):
            out = {*left_out, *(() if branch is None else self._specs_below(branch))}
            indices = [index for index, spec in enumerate(self._specs_below(above)) if spec not in out]
            blocks += [self._path_block(above, steps_up, *block) for block in _blocks(indices)]
        return {"allOf": blocks} if blocks else {}

    def _specs_below(self, folder: str) -> Sequence[str]:
        if folder not in self._below:
            self._below[folder] = tuple(spec for spec in self._entries if spec.startswith(_with_slash(folder)))
        return self._below[folder]

    def _entries_below(self, above: str, steps_up: int) -> Schema:
        key = (above, steps_up)
        if key not in self._names:
            below = self._specs_below(above)
            used: list[Json] = [if_used(_path(above, steps_up, spec), self._entries[spec]) for spec in below]
            self._define(key, "modules_from", {"allOf": used})
        return {"$ref": f"#/definitions/{self._names[key]}"}

    def _path_block(self, above: str, steps_up: int, first: int, size: int) -> Schema:
        """Return the completion of the paths to `size` specs below a folder: of one path, or of two halves."""
        key = (above, steps_up, first, size)
        if key not in self._names:
            if size == 1:
                path = _path(above, steps_up, self._specs_below(above)[first])
                named: Schema = {"defaultSnippets": [snippet(path, f"a {self._kind}")]}
                block: Schema = {"items": named} if self._is_list else named
            else:
                half = size // 2
                block = {"allOf": [self._path_block(above, steps_up, at, half) for at in (first, first + half)]}
            self._define(key, f"paths_of_{self._kind}", block)
        return {"$ref": f"#/definitions/{self._names[key]}"}

    def _define(self, key: tuple[object, ...], kind: str, schema: Schema) -> None:
        self._names[key] = f"{kind}_{len(self._names) + 1}"
        self.definitions[self._names[key]] = schema


def _ways_up(folder: str) -> Iterator[tuple[str, int, str | None]]:
    """Yield a folder and each above it, with the number of steps up and the folder below it on the way, if any."""
    steps = folder.split("/") if folder else []
    for steps_up in range(len(steps) + 1):
        above = len(steps) - steps_up
        yield "/".join(steps[:above]), steps_up, "/".join(steps[: above + 1]) if steps_up else None


def _with_slash(folder: str) -> str:
    return f"{folder}/" if folder else ""


def _path(above: str, steps_up: int, spec: str) -> str:
    return "../" * steps_up + spec.removeprefix(_with_slash(above))


def _blocks(indices: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the first index and the size of the largest blocks that make up the indices, in order.

    A block begins at a multiple of its size, which is a power of two, so that lists with few gaps share most blocks.
    """
    present = set(indices)
    at = 0
    while at < len(indices):
        first, size = indices[at], 1
        while first % (2 * size) == 0 and present.issuperset(range(first, first + 2 * size)):
            size *= 2
        yield first, size
        at += size
