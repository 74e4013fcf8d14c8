"""Show the names of expressions: parameters, variables, data, those of `for`, functions and constants."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.expand.values import NameOrigin, find_name_origin, find_name_origins
from linkforge_compile.export_spec.explanation_lines import name_lines
from linkforge_compile.expressions.functions import CONSTANTS, SIGNATURES
from linkforge_compile.listing import ListedParameter, list_parameters, list_used
from linkforge_compile.load import SpecFile
from linkforge_compile.lsp.cursor import Cursor, Role
from linkforge_compile.lsp.hover.text import MAX_SHOWN, and_more, bullets, code, code_block
from linkforge_compile.lsp.hover.values import in_si_of
from linkforge_compile.lsp.occurrences import COMPUTING
from linkforge_compile.lsp.placed import FileUse, known_analyses, placed_at, uses_in, uses_of
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.schema.shapes import node_at
from linkforge_compile.source import Position
from linkforge_compile.syntax import YamlScalar

_NAME = re.compile(r"[^\W\d]\w*")
_BUILT_IN = {
    "name": "the name of the robot",
    "prefix": "the prefix of this use of the file",
    "standalone": "whether the file is compiled itself, not used as a module",
}
_COMPUTED_SECTIONS = ("parameters", "variables", "data")


def show_name(document: Document, at: Position) -> str:
    """Return what the name at a position in an expression is; "" if none is there."""
    line = document.file.line(at.line)
    spans = ((found.start(), found.end(), found[0]) for found in _NAME.finditer(line))
    name = next((word for start, end, word in spans if start < at.column <= end + 1), "")
    if name in SIGNATURES:
        return f"function {code(SIGNATURES[name].signature)}"
    if name in CONSTANTS:
        return f"{code(name)}, a constant: {code(str(CONSTANTS[name]))}"
    if name in _BUILT_IN:
        return f"{code(name)}: {_BUILT_IN[name]}"
    inside = [origin for one in placed_at(document, at) for origin in _all(find_name_origins(one.node))]
    found = [origin for origin in inside if origin.name == name]
    return _show_origins(found) if found else _show_uses(document, name)


def _all(origins: Iterable[NameOrigin]) -> Iterator[NameOrigin]:
    for one in origins:
        yield one
        yield from _all(one.names)


def _show_origins(origins: Iterable[NameOrigin]) -> str:
    blocks = list(dict.fromkeys(code_block(name_lines(one)) for one in origins))
    return "\n\n".join(filter(None, (*blocks[:MAX_SHOWN], and_more(len(blocks) - MAX_SHOWN))))


def _show_uses(document: Document, name: str) -> str:
    """Return the value of a name in each use of the document's file."""
    return _show_values((use, name) for use in uses_of(document))


def _show_values(names: Iterable[tuple[FileUse, str]]) -> str:
    by_text: dict[str, list[str]] = {}
    for use, name in names:
        origin = find_name_origin(name, use.instance.names) if use.instance.names else None
        if origin is not None:
            by_text.setdefault(code_block(name_lines(origin)), []).append(use.label)
    blocks = [f"{', '.join(map(code, labels))}:\n\n{text}" for text, labels in by_text.items()]
    if len(blocks) == 1:
        blocks = list(by_text)
    return "\n\n".join(filter(None, (*blocks[:MAX_SHOWN], and_more(len(blocks) - MAX_SHOWN))))


def show_declared(document: Document, cursor: Cursor, settings: Settings) -> str:
    """Return what the name is that a section of the file declares at a position, or that `with` sets; "" for none."""
    match cursor.path, cursor.role:
        case ((str(section),), Role.KEY) if section in _COMPUTED_SECTIONS:
            name = cursor.word.text or ""
        case ((str(section), str(name)), Role.VALUE) if section in _COMPUTED_SECTIONS:
            pass
        case (("modules", str(module), "with"), Role.KEY):
            return _show_argument(document, module, cursor.word.text or "", settings)
        case (("modules", str(module), "with", str(name), *_), _):
            return _show_argument(document, module, name, settings)
        case _:
            return ""
    what = f"**{COMPUTING[section,]} {code(name)}**"
    facts = _facts(_declared(document, name, settings)) if section == "parameters" else ""
    values = _show_uses(document, name)
    return "\n\n".join(filter(None, (what, facts, values))) if facts or values else ""


def show_bound(document: Document, cursor: Cursor, settings: Settings) -> str:
    """Return a value in the declaration of a parameter, as written and in SI; "" for what is in SI as written."""
    match cursor.path:
        case ("parameters", str(name), "default" | "minimum" | "maximum" | "enum" as key, *_) if (
            cursor.role is not Role.KEY
        ):
            one = _declared(document, name, settings)
        case _:
            return ""
    analysis = next(iter(known_analyses(document)), None)
    node = node_at(analysis.spec.tree, cursor.path) if analysis and analysis.spec else None
    written = node.text if isinstance(node, YamlScalar) else ""
    in_si = (one.computed if one and key == "default" else "") or (in_si_of(node) if node else "")
    return f"{code(written)} = {code(in_si)}" if written and in_si not in ("", written) else ""


def _declared(document: Document, name: str, settings: Settings) -> ListedParameter | None:
    """Return a parameter of the document's own file, or of the file that includes it."""
    for analysis in known_analyses(document):
        if analysis.spec is not None and document.holds(analysis.spec.file.whole):
            return _named(_listed(analysis.spec, settings), name)
    use = next(uses_of(document), None)
    return _of_module(use, name, settings) if use is not None else None


def _of_module(use: FileUse, name: str, settings: Settings) -> ListedParameter | None:
    """Return a parameter of the file of a module, which is listed where it is used."""
    spec = use.analysis.spec
    stack = use.instance.include_stack
    if spec is None or not stack:
        return None
    try:
        listings = list_used(spec, settings.loader(spec.file.path))
    except BeyondLimitError:
        return None
    listing = listings.get((stack[0].text or "").strip("'\""))
    macro = use.instance.entry.node.child("macro") if use.instance.entry else None
    called = macro.text if isinstance(macro, YamlScalar) else None
    return _named(listing.settable(called), name) if listing else None


def _listed(spec: SpecFile, settings: Settings) -> tuple[ListedParameter, ...]:
    try:
        return list_parameters(spec, settings.loader(spec.file.path), Diagnostics()).parameters
    except BeyondLimitError:
        return ()


def _named(parameters: Iterable[ListedParameter], name: str) -> ListedParameter | None:
    return next((one for one in parameters if one.name == name), None)


def _facts(one: ListedParameter | None) -> str:
    if one is None:
        return ""
    default = "required" if one.default is None else f"default {code(one.default)}"
    in_si = f" = {code(one.computed)}" if one.computed and one.computed != one.default else ""
    facts = bullets((one.type or "", default + in_si, code(one.limits) if one.limits else ""))
    return "\n\n".join(filter(None, (one.description, facts)))


def _show_argument(document: Document, module: str, name: str, settings: Settings) -> str:
    """Return what the parameter of a module is that this document sets, with its value in each use of the module."""
    uses = [use for use in uses_in(known_analyses(document)) if _is_entry(document, use, module)]
    if not uses:
        return ""
    facts = _facts(_of_module(uses[0], name, settings))
    values = _show_values((use, name) for use in uses)
    what = f"**parameter {code(name)}** of {code(_file_name(uses[0]))}"
    return "\n\n".join(filter(None, (what, facts, values))) if facts or values else ""


def _is_entry(document: Document, use: FileUse, module: str) -> bool:
    entry = use.instance.entry
    return entry is not None and document.holds(entry.span) and entry.span.text == module


def _file_name(use: FileUse) -> str:
    tree = use.instance.tree
    return tree.span.file.shown if tree is not None else ""
