"""Schemas that offer the words of one spec where they may stand, and take whatever stands there."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence

from linkforge_compile.editor.module_words import arguments_of
from linkforge_compile.editor.vocabulary import Vocabulary
from linkforge_compile.schema.json_types import Json, Schema, branches, mapping, reference
from linkforge_compile.schema.patches import PATCH_SUFFIX
from linkforge_compile.syntax.scalars import scalar_value

NAMES, KEYS = "names", "keys"
"""How a `$comment` of the schemas begins whose values, or whose keys, are names: `names: link, joint`."""

FILE, INCLUDED, PARAMETER, ARGUMENT = "file", "included", "parameter", "argument"
"""What is marked beside the parts of a robot: specs, files that specs include, the file's own parameters, those of the
module that is used.
"""

_BARE = re.compile(r"[\w./-]+")


def mark_of(schema: Schema) -> tuple[str, list[str]]:
    """Return whether values or keys are names, and of what; ("", []) where neither are."""
    what, _, kinds = str(schema.get("$comment", "")).partition(": ")
    return (what, kinds.split(", ")) if what in (NAMES, KEYS) else ("", [])


class Words:
    """The words of one file; `made` are the definitions that they need, each name with `prefix` before it."""

    def __init__(
        self,
        definitions: Mapping[str, Schema],
        words: Vocabulary,
        paths: Schema,
        included: Schema,
        modules: Sequence[Json],
        *,
        prefix: str,
    ) -> None:
        """`definitions` are those of the language; `paths` offers what `use` may name in this file, `included` what
        `include` may, and `modules` are what there is to offer in an entry that uses one.
        """
        self._definitions = definitions
        self._parameters = words.parameters
        self._names = words.names
        self._included = included
        self._paths = paths
        self._modules = modules
        self._prefix = prefix
        self._begun: set[str] = set()
        self.made: Schema = {}

    def of(self, schema: Schema) -> Schema:
        """Return what there is to offer in what a schema describes; an empty schema for nothing."""
        what, kinds = mark_of(schema)
        if what == NAMES:
            return self._offered(schema, kinds)
        if (name := reference(schema)) is not None:
            return self._referred(name)
        parts = {
            "properties": self._properties(schema) | (self._keys(schema, kinds) if what == KEYS else {}),
            "additionalProperties": self._within(schema, "additionalProperties"),
            "items": self._within(schema, "items"),
        }
        unions = [*_listed(schema, "anyOf"), *_listed(schema, "allOf")]
        inside: list[Json] = [offer for part in unions if (offer := self.of(part))]
        if any(ARGUMENT in mark_of(mapping(part))[1] for part in mapping(schema.get("properties", {})).values()):
            inside += self._modules
        return {key: part for key, part in parts.items() if part} | ({"allOf": inside} if inside else {})

    def _properties(self, schema: Schema) -> Schema:
        """Return the keys of the language in which there is something to offer; the keys it offers itself."""
        offers = {key: self.of(mapping(part)) for key, part in mapping(schema.get("properties", {})).items()}
        return {key: {"doNotSuggest": True, "allOf": [offer]} for key, offer in offers.items() if offer}

    def _within(self, schema: Schema, key: str) -> Schema:
        inner = schema.get(key)
        return self.of(inner) if isinstance(inner, dict) else {}

    def _referred(self, name: str) -> Schema:
        """Return what there is to offer in a definition; nothing in a patch, whose names are those of the module."""
        made = f"{self._prefix}{name}"
        if name not in self._begun and not name.endswith(PATCH_SUFFIX):
            self._begun.add(name)
            if offer := self.of(self._definitions[name]):
                self.made[made] = offer
        return {"$ref": f"#/definitions/{made}"} if made in self.made else {}

    def _offered(self, schema: Schema, kinds: Sequence[str]) -> Schema:
        """Return the names of some kinds, as a value or as the items of a list."""
        if FILE in kinds:
            return self._paths
        if INCLUDED in kinds:
            return self._included
        snippets: list[Json] = [
            snippet(name, f"a {kind} of this robot") for kind in kinds for name in self._names.get(kind, ())
        ]
        if not snippets:
            return {}
        offer = self._shared("_or_".join((NAMES, *kinds)), {"defaultSnippets": snippets})
        whole = self._definitions[reference(schema) or ""] if "$ref" in schema else schema
        return {"items": offer} if any("items" in part for part in branches(whole)) else offer

    def _keys(self, schema: Schema, kinds: Sequence[str]) -> Schema:
        """Return the keys that a map may have; each is put in with the snippet of its entry."""
        if PARAMETER in kinds:
            return arguments_of(self._parameters)
        entry = schema.get("additionalProperties")
        snippets = entry.get("defaultSnippets") if isinstance(entry, dict) else None
        # By a union the server knows to put in a key with its colon.
        offer: Schema = {"anyOf": [self._within(schema, "additionalProperties")]}
        if snippets:
            offer["defaultSnippets"] = snippets
        names = [name for kind in kinds for name in self._names.get(kind, ())]
        shared = self._shared(f"entry_of_{schema.get('title')}", offer) if names else {}
        return dict.fromkeys(names, shared)

    def _shared(self, name: str, offer: Schema) -> Schema:
        """Return a reference to an offer, which is written once however often it is made."""
        made = f"{self._prefix}{name.replace(' ', '_')}"
        while self.made.setdefault(made, offer) != offer:
            made += "_"
        return {"$ref": f"#/definitions/{made}"}


def _listed(schema: Schema, key: str) -> list[Schema]:
    listed = schema.get(key)
    return [mapping(part) for part in listed] if isinstance(listed, list) else []


def snippet(name: str, description: str) -> Schema:
    """Return what offers a name and puts it in, in quotes where YAML would read it as another kind."""
    is_plain = _BARE.fullmatch(name) and scalar_value(name) is name
    written = name if is_plain else json.dumps(name, ensure_ascii=False)
    return {"label": name, "description": description, "body": re.sub(r"[$}\\]", r"\\\g<0>", written)}
