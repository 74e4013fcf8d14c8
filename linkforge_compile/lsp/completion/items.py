"""What completion offers, and how the protocol has it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from lsprotocol import types

from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.snippets import without_stops
from linkforge_compile.schema.descriptions import Described
from linkforge_compile.schema.json_schema import LONG_FORM, Json, Schema
from linkforge_compile.schema.shapes import words_of

Kind = types.CompletionItemKind

REQUIRED, LIKELY, KNOWN, COMMON = range(4)
"""Ranks of offers, in the order of the list."""

_MAX_WORDS = 12


class Client(NamedTuple):
    """What an editor can do with an item."""

    has_snippets: bool = False
    has_markdown: bool = False
    has_text_as_is: bool = False

    @classmethod
    def of(cls, capabilities: types.ClientCapabilities) -> Client:
        """Return what an editor declares."""
        completion = capabilities.text_document and capabilities.text_document.completion
        item = completion and completion.completion_item
        if not item:
            return cls()
        modes = item.insert_text_mode_support.value_set if item.insert_text_mode_support else ()
        formats = item.documentation_format or ()
        return cls(bool(item.snippet_support), types.MarkupKind.Markdown in formats, types.InsertTextMode.AsIs in modes)


class Offer(NamedTuple):
    """One thing to insert.

    `text` is a snippet if `is_snippet`. It replaces the word, or what is between the columns `begin` and `end`.
    `markdown` and `plain` document it. `sought` is what the user types to find it, the label unless given.
    """

    label: str
    text: str
    kind: Kind
    rank: int = KNOWN
    detail: str = ""
    markdown: str = ""
    plain: str = ""
    is_snippet: bool = False
    begin: int | None = None
    end: int | None = None
    sought: str = ""


def unique(offers: Iterable[Offer]) -> list[Offer]:
    """Return the offers, of several with one label the first."""
    found: dict[str, Offer] = {}
    for offer in offers:
        found.setdefault(offer.label, offer)
    return [*found.values()]


def documented(offer: Offer, schema: Schema) -> Offer:
    """Return an offer with the documentation of a schema: its description, words and examples."""
    plain, markdown = (str(schema.get(key, "")) for key in ("description", "markdownDescription"))
    facts = _facts(schema)
    return offer._replace(
        plain="\n\n".join(filter(None, (plain, facts))),
        markdown="\n\n".join(filter(None, (markdown or plain, facts))),
    )


def expected_of(branches: Iterable[Described]) -> str:
    """Return what the branches of a schema expect, in short; expressions and repetition are not mentioned."""
    words = (_expected(branch.schema) for branch in branches if branch.schema.get("title") not in _UNMENTIONED)
    return " or ".join(dict.fromkeys(filter(None, words)))


_UNMENTIONED = ("an expression", LONG_FORM)


def _expected(schema: Schema) -> str:
    sentence = str(schema.get("patternErrorMessage", ""))
    return sentence.removeprefix("expected ") if "a number [" in sentence else str(schema.get("title", ""))


def _facts(schema: Schema) -> str:
    words = words_of(schema)[:_MAX_WORDS]
    examples = schema.get("examples")
    shown = [_shown(example) for example in examples] if isinstance(examples, list) else []
    lines = [
        f"One of: {', '.join(f'`{word}`' for word in words)}." if words else "",
        f"For example: {', '.join(f'`{one}`' for one in shown)}." if shown and not words else "",
    ]
    return "\n\n".join(filter(None, lines))


def _shown(value: Json) -> str:
    return ("true" if value else "false") if isinstance(value, bool) else str(value) or '""'


def to_item(offer: Offer, order: int, context: Context, client: Client) -> types.CompletionItem:
    """Return an offer as the protocol has it; `order` is its place among those of its rank."""
    text = offer.text
    if offer.is_snippet and not client.has_snippets:
        text = without_stops(text)
    begin = context.word.column if offer.begin is None else offer.begin
    documentation = offer.markdown if client.has_markdown else offer.plain
    kind = types.MarkupKind.Markdown if client.has_markdown else types.MarkupKind.PlainText
    is_snippet = offer.is_snippet and client.has_snippets
    return types.CompletionItem(
        label=offer.label,
        kind=offer.kind,
        detail=offer.detail or None,
        documentation=types.MarkupContent(kind, documentation) if documentation else None,
        sort_text=f"{offer.rank}{order:04}",
        filter_text=offer.sought or offer.label,
        insert_text_format=types.InsertTextFormat.Snippet if is_snippet else types.InsertTextFormat.PlainText,
        insert_text_mode=types.InsertTextMode.AsIs if client.has_text_as_is and "\n" in text else None,
        text_edit=types.TextEdit(context.range(begin, offer.end), text),
    )
