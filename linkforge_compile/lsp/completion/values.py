"""Complete values: words, names, files, units, and those of parameters."""

from __future__ import annotations

from collections.abc import Iterator

from linkforge_compile.file_names import stem_of
from linkforge_compile.lsp.completion.arguments import offer_macros, parameter_at, values_of
from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.files import endings_at, names_file, offer_files
from linkforge_compile.lsp.completion.items import COMMON, KNOWN, LIKELY, REQUIRED, Kind, Offer, unique
from linkforge_compile.lsp.completion.names import kinds_of_values, offer_names, written
from linkforge_compile.lsp.completion.snippets import in_flow
from linkforge_compile.lsp.completion.units import offer_units
from linkforge_compile.schema.descriptions import Described
from linkforge_compile.schema.json_schema import mapping


def offer_values(context: Context) -> list[Offer]:
    """Return what the value or item at the position may be."""
    parameter = parameter_at(context)
    if units := offer_units(context, parameter):
        return units
    if names_file(context):
        return offer_files(context, context.cursor.before, endings_at(context))
    offers = [*offer_names(context), *offer_macros(context), *(values_of(parameter) if parameter else ())]
    is_named = bool(kinds_of_values(context))
    for branch in context.branches:
        offers += _words(branch)
        offers += _snippets(branch)
        offers += () if is_named or context.cursor.path == ("name",) else _examples(branch)
    if context.cursor.path == ("name",):
        stem = written(stem_of(context.document.path), context)
        offers.append(Offer(stem, stem, Kind.Value, LIKELY, "the name of the file"))
    listed = context.items_around
    return unique(offer for offer in offers if offer.label not in listed)


def _words(branch: Described) -> Iterator[Offer]:
    """Yield the words of an enumeration, true and false, and null where it deletes."""
    words = branch.schema.get("enum")
    listed = words if isinstance(words, list) else []
    plain, markdown = (branch.schema.get(key) for key in ("enumDescriptions", "markdownEnumDescriptions"))
    for index, word in enumerate(listed):
        if word is not None:
            text = in_flow(word)
            offer = Offer(text, text, Kind.EnumMember, REQUIRED)
            shown, rich = (
                str(one[index]) if isinstance(one, list) and index < len(one) else "" for one in (plain, markdown)
            )
            yield offer._replace(plain=shown, markdown=rich or shown)
    if branch.kinds[:1] == ("boolean",):
        yield from (Offer(word, word, Kind.EnumMember, REQUIRED) for word in ("true", "false"))
    if branch.definition.endswith("_patch") and "null" in branch.kinds:
        yield Offer("null", "null", Kind.Keyword, COMMON, "deletes it from the module")


def _snippets(branch: Described) -> Iterator[Offer]:
    """Yield the snippets of a value, on one line; a new entry of a map of names is none."""
    listed = branch.schema.get("defaultSnippets")
    for snippet in map(mapping, listed) if isinstance(listed, list) else ():
        text = in_flow(snippet["body"])
        label, description = str(snippet["label"]), str(snippet.get("description", ""))
        yield Offer(label, text, Kind.Snippet, LIKELY, description, is_snippet=True)


def _examples(branch: Described) -> Iterator[Offer]:
    examples = branch.schema.get("examples")
    for example in examples if isinstance(examples, list) else ():
        text = in_flow(example) or '""'
        yield Offer(text, text, Kind.Value, KNOWN, "for example")
