"""Link the paths in a spec to their files: modules with their macros, includes, data, meshes and textures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from lsprotocol import types

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.load import Loader, SpecFile
from linkforge_compile.load.locations import PathSite, locate, names_xacro
from linkforge_compile.load.xacro_library import Macro, XacroLibrary, read_library
from linkforge_compile.lsp.convert import uri_of
from linkforge_compile.lsp.placed import leaves_in, placed_in
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.roots import exists, identity
from linkforge_compile.schema.descriptions import described_at
from linkforge_compile.source import Position, Span
from linkforge_compile.source.xml_tree import XmlAttribute
from linkforge_compile.syntax import YamlMap, YamlScalar, has_expression

_FILE = "a file name"


def document_links(document: Document, settings: Settings) -> list[types.DocumentLink]:
    """Return the links of an open spec, to files that exist and that it may read."""
    user, packages = _spec_of(document)
    if user is None:
        return []
    loader = settings.loader(document.path)
    found = {(span.start, span.end): PathSite(text, span, user, packages) for span, text in _paths(document, user)}
    return [link for site in found.values() if (link := _link(document, loader, site))]


def files_at(document: Document, at: Position, settings: Settings) -> list[types.Location]:
    """Return the start of the file that the path at a position of an open spec names; none for other text."""
    start = types.Range(types.Position(0, 0), types.Position(0, 0))
    place = document.columns.position(document.file, at)
    here = (link for link in document_links(document, settings) if link.range.start <= place <= link.range.end)
    return [types.Location(link.target, start) for link in here if link.target]


def declarations_in_xacro(document: Document, at: Position, settings: Settings) -> list[types.Location]:
    """Return where the xacro of a module declares what is named at a position: the macro, or a parameter in `with`."""
    user, packages = _spec_of(document)
    entries = user.tree.section("modules").values() if user else ()
    for fields in (entry.value for entry in entries if isinstance(entry.value, YamlMap)):
        use, macro = fields.get("use"), fields.get("macro")
        parameter = next((one for one in fields.section("with").values() if _is_at(one.key.span, document, at)), None)
        is_macro = isinstance(macro, YamlScalar) and _is_at(macro.span, document, at)
        if user and isinstance(use, YamlScalar) and (parameter or is_macro):
            library = _library(PathSite(use.text, use.span, user, packages), settings.loader(document.path))
            called = library.macros.get(macro.text) if library and isinstance(macro, YamlScalar) else None
            name = _declaration(library, called, parameter.name if parameter else "") if library else None
            location = document.columns.location(name.span) if name else None
            return [location] if location else []
    return []


def _is_at(span: Span, document: Document, at: Position) -> bool:
    return document.holds(span) and span.start <= at <= span.end


def _library(site: PathSite, loader: Loader) -> XacroLibrary | None:
    """Return what a xacro declares; None for another file."""
    sink = Diagnostics()
    try:
        target = locate(site, loader, sink) if names_xacro(site, loader) else None
        return read_library(target.path, loader, sink, site.used) if target else None
    except BeyondLimitError:
        return None


def _declaration(library: XacroLibrary, macro: Macro | None, parameter: str) -> XmlAttribute | None:
    """Return the name of a macro, the list with a parameter of it, or the name of an argument; None if unknown."""
    if macro is not None and (not parameter or macro.parameter(parameter)):
        return macro.element.attributes.get("params" if parameter else "name")
    element = library.declarations.get(parameter)
    return element.attributes.get("name") if element else None


def _spec_of(document: Document) -> tuple[SpecFile | None, Mapping[str, Path]]:
    """Return the file of a document as the compiler read it, itself or as a part of another one, and its packages."""
    for analysis in document.analyses:
        if analysis.spec is None:
            continue
        packages = analysis.instance.packages if analysis.instance else analysis.spec.packages
        if document.holds(analysis.spec.file.whole):
            return analysis.spec, packages
        for file, part in analysis.spec.included.items():
            if file.path is not None and identity(file.path) == identity(document.path):
                return part, packages
    return None, {}


def _paths(document: Document, user: SpecFile) -> Iterator[tuple[Span, str]]:
    """Yield the paths that the document writes or computes, each with its place."""
    last = Position(len(document.file.lines), 1)
    written = ((path, node) for path, node in leaves_in(user.tree) if document.holds(node.span))
    computed = ((one.path, one.node) for one in placed_in(document, Position(1, 1), last) if one.key is None)
    # What is included is merged into the tree, without the paths.
    for span in (file.included for analysis in document.analyses if analysis.spec for file in analysis.spec.included):
        if span is not None and document.holds(span):
            yield span, (span.text or "").strip("'\"")
    for path, node in (*written, *computed):
        if isinstance(node, YamlScalar) and _is_file(path, node):
            yield node.span, node.text


def _is_file(path: tuple[str | int, ...], node: YamlScalar) -> bool:
    is_path = isinstance(node.value, str) and not has_expression(node.text)
    return is_path and any(one.schema.get("title") == _FILE for one in described_at(path))


def _link(document: Document, loader: Loader, site: PathSite) -> types.DocumentLink | None:
    try:
        target = locate(site, loader, Diagnostics())
    except BeyondLimitError:
        return None
    if target is None or not loader.roots.hold(target.path) or not exists(target.path):
        return None
    return types.DocumentLink(document.columns.range(site.where), uri_of(target.path), str(target.path))
