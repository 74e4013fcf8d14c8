"""Complete keys, values and expressions at a position, from its text and the latest analysis; it never compiles.

context      the position, the map around it as written now, and the latest readable analysis
items        what is offered, and how the protocol has it
keys, values, expressions    what may be at each kind of position
names, arguments, units, files, snippets    what these have in common
"""

from __future__ import annotations

from lsprotocol import types

from linkforge_compile.analysis import Settings
from linkforge_compile.lsp.completion.arguments import offer_arguments
from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.expressions import offer_in_expression
from linkforge_compile.lsp.completion.items import Client, Offer, to_item
from linkforge_compile.lsp.completion.keys import offer_keys
from linkforge_compile.lsp.completion.values import offer_values
from linkforge_compile.lsp.cursor import Role, find_cursor
from linkforge_compile.lsp.workspace import Document

TRIGGERS = (" ", "(", "'", '"', "/", ".", "{", "[")
"""The characters after which an editor asks for completions, besides those of words."""


def complete(document: Document, position: types.Position, settings: Settings, client: Client) -> types.CompletionList:
    """Return what may be written at a position; `settings` are those that specs are analysed with.

    Before the first analysis the list is incomplete: an editor asks again for it with the next character.
    """
    cursor = find_cursor(document.file, document.columns.place(document.file, position))
    context = Context(document, cursor, position, settings) if cursor else None
    items = [to_item(offer, order, context, client) for order, offer in enumerate(_offers(context))] if context else []
    return types.CompletionList(is_incomplete=document.analysis is None, items=items)


def _offers(context: Context) -> list[Offer]:
    cursor = context.cursor
    if (expression := cursor.expression) is not None:
        return offer_in_expression(context, expression)
    match cursor.role:
        case Role.KEY:
            return [*offer_arguments(context), *offer_keys(context)]
        case Role.ITEM if cursor.is_own_line:
            return [*offer_values(context), *offer_keys(context)]
    return offer_values(context)
