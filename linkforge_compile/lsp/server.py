"""The server: what the editor sends, and the features that answer."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer

from linkforge_compile._version import __version__
from linkforge_compile.analysis import analyse_path
from linkforge_compile.lsp.code_actions import KINDS, code_actions
from linkforge_compile.lsp.completion import TRIGGERS, Client, complete
from linkforge_compile.lsp.convert import Columns, path_of
from linkforge_compile.lsp.diagnostics import diagnostics_by_uri
from linkforge_compile.lsp.document_links import document_links, files_at
from linkforge_compile.lsp.folding import folding_ranges
from linkforge_compile.lsp.formatting import format_edits
from linkforge_compile.lsp.hover import hover
from linkforge_compile.lsp.inlay_hints import HintOptions, inlay_hints
from linkforge_compile.lsp.navigation import declarations_of, highlights, references_to
from linkforge_compile.lsp.rename import RefusedError, rename, renamed_at
from linkforge_compile.lsp.semantic_tokens import LEGEND, semantic_tokens
from linkforge_compile.lsp.symbols import find_symbols, outline
from linkforge_compile.lsp.workspace import Document, Workspace, find_users, is_part, is_spec
from linkforge_compile.roots import identity

_Result = TypeVar("_Result")

_WATCHING = types.Registration(
    "files",
    types.WORKSPACE_DID_CHANGE_WATCHED_FILES,
    types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher("**/*")]),
)
"""A spec depends on specs, robots of vendors, data and meshes, whatever their endings; only theirs analyse again."""

DEBOUNCE = 0.1
"""Time without a change before specs are analysed [s]."""


class SpecServer(LanguageServer):
    """The language server of one editor.

    Texts come whole, as specs are short, and an edit by line and column depends on what a line is. One thread analyses,
    so that requests are answered meanwhile.
    """

    def __init__(self) -> None:
        super().__init__("linkforge", __version__, text_document_sync_kind=types.TextDocumentSyncKind.Full)
        self.specs = Workspace()
        self._analyser = ThreadPoolExecutor(max_workers=1, thread_name_prefix="analysis")
        self._published: set[str] = set()
        self.hints = HintOptions()
        self._analysing = asyncio.Lock()

    @property
    def columns(self) -> Columns:
        return Columns(self.workspace.position_codec)

    async def schedule(self, delay: float = DEBOUNCE) -> None:
        """Analyse what is pending after a delay without another change, and publish the diagnostics."""
        generation = self.specs.generation
        await asyncio.sleep(delay)
        if generation == self.specs.generation:
            await self._analyse()
        if generation == self.specs.generation:
            self._publish()

    async def _analyse(self) -> None:
        """Analyse what is pending."""
        async with self._analysing:
            while pending := self.specs.pending():
                path, settings = pending[0], self.specs.begin(pending[0])
                analysis = await self.in_thread(partial(analyse_path, path, settings))
                includers: Iterable[Path] = ()
                if is_part(analysis) and identity(path) in self.specs.buffers:
                    users = await self.in_thread(partial(find_users, path, self.specs.folders, settings))
                    includers = [user for user, one in users.items() if not is_part(one)]
                self.specs.keep(path, analysis, includers)

    def in_thread(self, work: Callable[[], _Result]) -> asyncio.Future[_Result]:
        """Do what takes long in the thread that analyses; it may use values only, as the loop changes what is known."""
        return asyncio.get_running_loop().run_in_executor(self._analyser, work)

    def _publish(self) -> None:
        """Send the diagnostics of all files, and remove those of files that have none any more."""
        roots = {path: self.specs.analyses[identity(path)] for path in self.specs.roots()}
        found = diagnostics_by_uri(roots, self.columns)
        open_uris = {document.uri: document.version for document in self.workspace.text_documents.values()}
        for uri in {**found, **dict.fromkeys(self._published), **open_uris}:
            params = types.PublishDiagnosticsParams(uri, found.get(uri, []), open_uris.get(uri))
            self.text_document_publish_diagnostics(params)
        self._published = set(found)

    def document(self, uri: str) -> Document | None:
        """Return what is known of an open spec; its analyses may be older than its text."""
        path = path_of(uri)
        return self.specs.document(path, self.columns) if path else None

    async def analysed(self, uri: str) -> Document | None:
        """Return what is known of an open spec once its text is analysed."""
        await self._analyse()
        return self.document(uri)

    async def analysed_with_users(self, uri: str) -> Document | None:
        """Return what is known of an open spec, and of the specs in the workspace that read it."""
        document = await self.analysed(uri)
        if document is None:
            return None
        find = partial(find_users, document.path, self.specs.folders, self.specs.settings())
        known = {identity(one.compilation.files[0]) for one in document.analyses if one.compilation.files}
        users = await self.in_thread(find)
        others = (one for path, one in users.items() if identity(path) not in known)
        return document._replace(analyses=(*document.analyses, *others))


def make_server() -> SpecServer:
    """Return a server with all features, not started."""
    server = SpecServer()
    _add_synchronization(server)
    _add_structure(server)
    _add_completion(server)
    _add_navigation(server)
    _add_rename(server)
    _add_hover(server)
    _add_hints(server)
    _add_actions(server)
    return server


def _add_synchronization(server: SpecServer) -> None:
    @server.feature(types.INITIALIZE)
    def _initialize(params: types.InitializeParams) -> None:
        folders = (path_of(folder.uri) for folder in params.workspace_folders or ())
        server.specs.folders = tuple(folder for folder in folders if folder)
        options = params.initialization_options
        packages = options.get("packages", {}) if isinstance(options, dict) else {}
        server.specs.packages = {name: Path(place) for name, place in packages.items()}
        server.hints = HintOptions.of(options)

    @server.feature(types.INITIALIZED)
    async def _initialized(_params: types.InitializedParams) -> None:
        workspace = server.client_capabilities.workspace
        watching = workspace.did_change_watched_files if workspace else None
        if watching and watching.dynamic_registration:
            await server.client_register_capability_async(types.RegistrationParams([_WATCHING]))

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    async def _opened(params: types.DidOpenTextDocumentParams) -> None:
        await _put(server, params.text_document.uri, delay=0)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    async def _changed(params: types.DidChangeTextDocumentParams) -> None:
        await _put(server, params.text_document.uri, delay=DEBOUNCE)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    async def _closed(params: types.DidCloseTextDocumentParams) -> None:
        if path := path_of(params.text_document.uri):
            server.specs.close(path)
            await server.schedule()

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    async def _files_changed(params: types.DidChangeWatchedFilesParams) -> None:
        for change in params.changes:
            if (path := path_of(change.uri)) and identity(path) not in server.specs.buffers:
                server.specs.note_change(path)
        await server.schedule()


def _add_completion(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=TRIGGERS))
    def _complete(params: types.CompletionParams) -> list[types.CompletionItem]:
        document = server.document(params.text_document.uri)
        client = Client.of(server.client_capabilities)
        return complete(document, params.position, server.specs.settings(), client) if document else []


async def _put(server: SpecServer, uri: str, *, delay: float) -> None:
    path = path_of(uri)
    if path is not None and is_spec(path):
        document = server.workspace.get_text_document(uri)
        server.specs.put(path, document.version, document.source)
        await server.schedule(delay)


def _add_structure(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    def _fold(params: types.FoldingRangeParams) -> list[types.FoldingRange]:
        document = server.document(params.text_document.uri)
        return folding_ranges(document.file) if document else []

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def _format(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        document = server.document(params.text_document.uri)
        return format_edits(document) if document else []

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def _outline(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        document = await server.analysed(params.text_document.uri)
        return outline(document) if document else []

    @server.feature(types.WORKSPACE_SYMBOL)
    async def _find(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        specs = server.specs
        return await server.in_thread(
            partial(find_symbols, params.query, specs.folders, specs.settings(), server.columns)
        )


def _add_navigation(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def _define(params: types.DefinitionParams) -> list[types.Location]:
        document = await server.analysed(params.text_document.uri)
        if document is None:
            return []
        at, settings = document.place(params.position), server.specs.settings()
        return declarations_of(document, at) or await server.in_thread(partial(files_at, document, at, settings))

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def _refer(params: types.ReferenceParams) -> list[types.Location]:
        document = await server.analysed_with_users(params.text_document.uri)
        is_wanted = params.context.include_declaration
        at = document.place(params.position) if document else None
        return references_to(document, at, with_declarations=is_wanted) if document and at else []

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    async def _highlight(params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        document = await server.analysed(params.text_document.uri)
        return highlights(document, document.place(params.position)) if document else []


def _add_rename(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    async def _prepare(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        document = await server.analysed_with_users(params.text_document.uri)
        with _refusals():
            target = renamed_at(document, document.place(params.position)) if document else None
        if document is None or target is None:
            return None
        return types.PrepareRenamePlaceholder(document.columns.range(target[0]), target[0].text or "")

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def _rename(params: types.RenameParams) -> types.WorkspaceEdit | None:
        document = await server.analysed_with_users(params.text_document.uri)
        if document is None:
            return None
        at, settings = document.place(params.position), server.specs.settings()
        with _refusals():
            return await server.in_thread(partial(rename, document, at, params.new_name, settings))


def _add_hover(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def _hover(params: types.HoverParams) -> types.Hover | None:
        document = await server.analysed(params.text_document.uri)
        settings = server.specs.settings()
        return await server.in_thread(partial(hover, document, params.position, settings)) if document else None


def _add_hints(server: SpecServer) -> None:
    @server.feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
    def _configure(params: types.DidChangeConfigurationParams) -> None:
        settings = params.settings
        if isinstance(settings, dict) and "linkforge" in settings:
            server.hints = HintOptions.of(settings["linkforge"])

    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT)
    async def _hint(params: types.InlayHintParams) -> list[types.InlayHint]:
        document = await server.analysed(params.text_document.uri)
        if document is None:
            return []
        start, end = document.place(params.range.start), document.place(params.range.end)
        return await server.in_thread(partial(inlay_hints, document, start, end, server.hints))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND)
    async def _classify(params: types.SemanticTokensParams) -> types.SemanticTokens:
        document = await server.analysed(params.text_document.uri)
        return semantic_tokens(document) if document else types.SemanticTokens([])

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_LINK)
    async def _link(params: types.DocumentLinkParams) -> list[types.DocumentLink]:
        document = await server.analysed(params.text_document.uri)
        settings = server.specs.settings()
        return await server.in_thread(partial(document_links, document, settings)) if document else []


@contextmanager
def _refusals() -> Iterator[None]:
    """Answer a request that is refused with the reason, which editors show."""
    try:
        yield
    except RefusedError as error:
        raise JsonRpcException(str(error), types.LSPErrorCodes.RequestFailed.value) from None


def _add_actions(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(code_action_kinds=KINDS))
    async def _act(params: types.CodeActionParams) -> list[types.CodeAction]:
        document = await server.analysed(params.text_document.uri)
        return code_actions(document, params.range, params.context) if document else []
