"""Complete expressions: names in scope, functions, the keys of maps, and names of parts in quotes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions.functions import CONSTANTS, FILE_FUNCTIONS, SIGNATURES
from linkforge_compile.listing import as_written
from linkforge_compile.load.loader import ImportSite
from linkforge_compile.load.locations import PathSite, locate
from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.files import offer_files
from linkforge_compile.lsp.completion.items import COMMON, KNOWN, LIKELY, REQUIRED, Kind, Offer
from linkforge_compile.lsp.completion.names import names_here
from linkforge_compile.lsp.cursor import MARKER, Role
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar

_IN_CALL = re.compile(r"\b(link|joint|path)\(\s*$")
_COMPARED = re.compile(r"([A-Za-z_]\w*)\s*[!=]=\s*$")
_INDEXED = re.compile(r"([A-Za-z_]\w*(?:\.\w+)*)\[\s*$")
_ATTRIBUTE = re.compile(r"([A-Za-z_]\w*(?:\.\w+)*)\.(\w*)$")
_NAME = re.compile(r"\w*$")
_ALONE = re.compile(r"\$\(\s*([A-Za-z_]\w*(?:\.\w+)*)\s*\)")
_MOST_STEPS = 20
"""How many variables are followed to a map."""

_BUILT_IN = {
    "name": "the name of the robot",
    "prefix": "the prefix of this use of the file",
    "standalone": "whether the file is compiled itself, not used as a module",
}


class _Name(NamedTuple):
    """A name that expressions may use: its value as written, and what it is."""

    value: YamlNode | None
    what: str
    description: str = ""


def offer_in_expression(context: Context, expression: str) -> list[Offer]:
    """Return what may follow in an expression, given what is written of it up to the position."""
    begin, in_quotes = _open_quote(expression)
    if in_quotes is not None:
        return _in_quotes(context, expression[:begin], in_quotes)
    scope = {**_declared(context), **_repeated(context)}
    if attribute := _ATTRIBUTE.search(expression):
        keys = _keys(_follow(attribute[1], scope, context))
        return [_offer(key, what, Kind.Field, REQUIRED, len(attribute[2]), context) for key, what in keys]
    typed = _NAME.search(expression)
    return [*_names(scope, context, len(typed[0]) if typed else 0)]


def _open_quote(expression: str) -> tuple[int, str | None]:
    """Return the index of the quote that is open at the end of an expression and what follows it; None for none."""
    quote, begin = "", 0
    for index, character in enumerate(expression):
        if character == quote:
            quote = ""
        elif not quote and character in "'\"":
            quote, begin = character, index
    return begin, expression[begin + 1 :] if quote else None


def _in_quotes(context: Context, before: str, typed: str) -> list[Offer]:
    """Return what a text in quotes may be; `before` is what precedes the quote."""
    if call := _IN_CALL.search(before):
        if call[1] == "path":
            return offer_files(context, typed)
        names = [(name, call[1]) for name in names_here(context, call[1])]
    elif compared := _COMPARED.search(before):
        names = [(choice, f"a value of {compared[1]}") for choice in _choices(compared[1], context)]
    elif indexed := _INDEXED.search(before):
        scope = {**_declared(context), **_repeated(context)}
        names = [*_keys(_follow(indexed[1], scope, context))]
    else:
        return []
    return [_offer(name, what, Kind.Reference, REQUIRED, len(typed), context) for name, what in names]


def _names(scope: dict[str, _Name], context: Context, typed: int) -> Iterator[Offer]:
    for name, known in scope.items():
        detail = as_written(known.value) if known.value else ""
        if MARKER in detail:  # the position is in its value
            detail = ""
        offer = _offer(
            name, f"{known.what}: {detail}" if detail else known.what, Kind.Variable, REQUIRED, typed, context
        )
        yield offer._replace(plain=known.description, markdown=known.description)
    for name, what in _BUILT_IN.items():
        yield _offer(name, what, Kind.Constant, KNOWN, typed, context)
    for name, function in SIGNATURES.items():
        quote = "'" if name in FILE_FUNCTIONS else ""
        offer = _offer(name, function.signature or "", Kind.Function, LIKELY, typed, context)
        ends = context.line[offer.end - 1 :].startswith("(") if offer.end else False
        yield offer if ends else offer._replace(text=f"{name}({quote}$0{quote})", is_snippet=True)
    for name in CONSTANTS:
        yield _offer(name, "a constant", Kind.Constant, COMMON, typed, context)


def _offer(name: str, detail: str, kind: Kind, rank: int, typed: int, context: Context) -> Offer:  # noqa: PLR0917
    """Return an offer that replaces the identifier around the position, of which `typed` characters precede it."""
    rest = re.match(r"[\w-]*", context.line[context.column - 1 :])
    end = context.column + (rest.end() if rest else 0)
    return Offer(name, name, kind, rank, detail, begin=context.column - typed, end=end)


def _declared(context: Context) -> dict[str, _Name]:
    """Return the parameters, variables and data of the file."""
    found: dict[str, _Name] = {}
    for section, name, value in context.sections("parameters", "variables", "data"):
        if section == "parameters" and isinstance(value, YamlMap):
            facts = " ".join(filter(None, ("parameter", value.text("type"))))
            found[name] = _Name(value.get("default"), facts, value.text("description") or "")
        else:
            found[name] = _Name(value, {"variables": "variable", "parameters": "parameter"}.get(section, section))
    return found


def _repeated(context: Context) -> dict[str, _Name]:
    """Return the variables of each `for` around the position."""
    path, found = context.cursor.path, {}
    around = [context.node(path[:length]) for length in range(1, len(path) + 1)]
    if context.cursor.role is Role.KEY:
        here = context.node(path)
        around += [entry.value for entry in here if MARKER in entry.name] if isinstance(here, YamlMap) else []
    for node in around:
        for entry in node.section("for").values() if isinstance(node, YamlMap) else ():
            found[entry.name] = _Name(entry.value, "of for")
    return found


def _choices(name: str, context: Context) -> list[str]:
    """Return the words that a parameter may be."""
    node = context.node(("parameters", name, "enum"))
    return [item.text for item in node if isinstance(item, YamlScalar)] if isinstance(node, YamlList) else []


def _keys(node: YamlNode | None) -> Iterator[tuple[str, str]]:
    for entry in node if isinstance(node, YamlMap) else ():
        yield entry.name, as_written(entry.value)[:40]


def _follow(dotted: str, scope: dict[str, _Name], context: Context, steps: int = _MOST_STEPS) -> YamlNode | None:
    """Return what a name with attributes stands for, as written; None if it would have to be computed."""
    name, *attributes = dotted.split(".")
    known = scope.get(name)
    node = known.value if known and steps else None
    if known and known.what == "data" and isinstance(node, YamlScalar):
        node = _read_data(node, scope, context)
    node = _plain(node, scope, context, steps)
    if known and known.what == "of for" and isinstance(node, YamlList):
        node = _plain(node.items[0] if node.items else None, scope, context, steps)
    for attribute in attributes:
        node = _plain(node.child(attribute) if node else None, scope, context, steps)
    return node


def _plain(node: YamlNode | None, scope: dict[str, _Name], context: Context, steps: int) -> YamlNode | None:
    """Return a node, or what it stands for if it is an expression of one name."""
    alone = _ALONE.fullmatch(node.text) if isinstance(node, YamlScalar) else None
    return _follow(alone[1], scope, context, steps - 1) if alone else node


def _read_data(file: YamlScalar, scope: dict[str, _Name], context: Context) -> YamlNode | None:
    """Return the tree of a data file, whose name may depend on the defaults of parameters."""
    spec = context.readable.spec if context.readable else None
    if spec is None:
        return None
    loader, sink = context.settings.loader(context.document.path), Diagnostics()
    text = _ALONE.sub(lambda found: _text(_follow(found[1], scope, context)), file.text)
    target = locate(PathSite(text, file.span, spec, {}), loader, sink)
    return loader.open_data(target.path, sink, {}, ImportSite(text, file.span)) if target else None


def _text(node: YamlNode | None) -> str:
    return node.text if isinstance(node, YamlScalar) else ""
