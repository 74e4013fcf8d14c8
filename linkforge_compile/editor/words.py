"""Schemas that offer the words of one spec where they may stand, and take whatever stands there."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence

from linkforge_compile.editor.vocabulary import Vocabulary
from linkforge_compile.modules import ListedParameter
from linkforge_compile.schema.json_types import Json, Schema, branches, mapping, reference
from linkforge_compile.schema.patches import PATCH_SUFFIX
from linkforge_compile.syntax.scalars import scalar_value

NAMES, KEYS = "names", "keys"
"""How a `$comment` of the schemas begins whose values, or whose keys, are names: `names: link, joint`."""

FILE, PARAMETER, ARGUMENT = "file", "parameter", "argument"
"""What is marked beside the parts of a robot: specs, the file's own parameters, those of the module that is used."""

_BARE = re.compile(r"[\w./-]+")


def mark_of(schema: Schema) -> tuple[str, list[str]]:
    """Return whether values or keys are names, and of what; ("", []) where neither are."""
    what, _, kinds = str(schema.get("$comment", "")).partition(": ")
    return (what, kinds.split(", ")) if what in (NAMES, KEYS) else ("", [])


class Words:
    """The words of one file; `made` are the definitions that they need, each name with `prefix` before it."""

    def __init__(
        self, definitions: Mapping[str, Schema], vocabulary: Vocabulary, usable: Sequence[str], *, prefix: str
    ) -> None:
        """`definitions` are those of the language; `usable` are the files that `use` may name in this one."""
        self._definitions = definitions
        self._arguments = vocabulary.arguments
        self._parameters = vocabulary.parameters
        self._names = {**vocabulary.names, FILE: tuple(usable)}
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
        inside += [self._of_module(use, parameters) for use, parameters in self._used_in(schema)]
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
        described = {kind: "a spec" if kind == FILE else f"a {kind} of this robot" for kind in kinds}
        snippets: list[Json] = [
            {"label": name, "description": description, "body": _plain(name)}
            for kind, description in described.items()
            for name in self._names.get(kind, ())
        ]
        if not snippets:
            return {}
        offer = self._shared("_or_".join((NAMES, *kinds)), {"defaultSnippets": snippets})
        whole = self._definitions[reference(schema) or ""] if "$ref" in schema else schema
        return {"items": offer} if any("items" in part for part in branches(whole)) else offer

    def _keys(self, schema: Schema, kinds: Sequence[str]) -> Schema:
        """Return the keys that a map may have; each is put in with the snippet of its entry."""
        if PARAMETER in kinds:
            return {parameter.name: _argument(parameter) for parameter in self._parameters}
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
        self.made[made] = offer
        return {"$ref": f"#/definitions/{made}"}

    def _used_in(self, schema: Schema) -> Iterator[tuple[str, tuple[ListedParameter, ...]]]:
        """Yield what each module takes, where a schema describes an entry that uses one."""
        marks = (mark_of(mapping(part)) for part in mapping(schema.get("properties", {})).values())
        if any(ARGUMENT in kinds for _, kinds in marks):
            yield from self._arguments.items()

    def _of_module(self, use: str, parameters: tuple[ListedParameter, ...]) -> Schema:
        arguments: Schema = {parameter.name: _argument(parameter) for parameter in parameters}
        return {
            "if": {"properties": {"use": {"const": use}}, "required": ["use"]},
            "then": {"properties": {"with": {"doNotSuggest": True, "properties": arguments}}},
        }


def _listed(schema: Schema, key: str) -> list[Schema]:
    listed = schema.get(key)
    return [mapping(part) for part in listed] if isinstance(listed, list) else []


def _plain(name: str) -> str:
    """Return a name as YAML has it: in quotes where it would be read as another kind."""
    return name if _BARE.fullmatch(name) and scalar_value(name) is name else json.dumps(name, ensure_ascii=False)


def _argument(parameter: ListedParameter) -> Schema:
    """Return what a module's parameter means, what it takes and its values, those of its choice or the default."""
    unit = f" {parameter.unit}" if parameter.unit else ""
    facts = [f"type `{parameter.type}`"] if parameter.type else []
    facts.append("required" if parameter.default is None else f"default `{parameter.default}`")
    facts += [f"at least `{parameter.minimum}{unit}`"] if parameter.minimum is not None else []
    facts += [f"at most `{parameter.maximum}{unit}`"] if parameter.maximum is not None else []
    told = "\n\n".join(filter(None, (parameter.description, "; ".join(facts))))
    values = [f"{choice}{unit}" if unit else choice for choice in parameter.choices or ()]
    if not values and parameter.type == "boolean":
        values = [True, False]
    elif not values and parameter.value is not None and parameter.type not in ("list", "map", "vector"):
        values = [parameter.default if unit or isinstance(parameter.value, str) else parameter.value]
    offer: Schema = {"title": parameter.type or "a parameter", "description": told.replace("`", "'")}
    # As in `_keys`, where there are no examples to put in.
    return offer | {"markdownDescription": told} | ({"examples": values} if values else {"anyOf": [{}]})
