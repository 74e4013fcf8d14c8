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
from linkforge_compile.lsp.changes import workspace_edit
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
from linkforge_compile.lsp.rename import rename
from linkforge_compile.lsp.renaming import RefusedError, renamed_at
from linkforge_compile.lsp.semantic_tokens import LEGEND, semantic_tokens
from linkforge_compile.lsp.symbols import find_symbols, outline
from linkforge_compile.lsp.workspace import Document, Workspace, find_users, is_part
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
        self.hints = HintOptions()
        # Two threads analyse, so that a spec that takes long does not delay the others; one does what requests need.
        self._analysers = ThreadPoolExecutor(max_workers=2, thread_name_prefix="analysis")
        self._worker = ThreadPoolExecutor(max_workers=1, thread_name_prefix="requests")
        self._analyses: dict[str, asyncio.Task[None]] = {}
        self._scheduled: set[asyncio.Task[None]] = set()
        self._published: set[str] = set()

    @property
    def columns(self) -> Columns:
        return Columns(self.workspace.position_codec)

    @property
    def folders(self) -> tuple[Path, ...]:
        """The folders of the workspace, in which specs are that use others."""
        uris = [folder.uri for folder in self.workspace.folders.values()] or [self.workspace.root_uri or ""]
        return tuple(folder for folder in map(path_of, uris) if folder)

    def schedule(self, delay: float = DEBOUNCE) -> None:
        """Analyse what is pending after a delay without another change, and publish the diagnostics."""
        task = asyncio.get_running_loop().create_task(self._analyse_later(delay))
        self._scheduled.add(task)  # the loop itself keeps no reference
        task.add_done_callback(self._scheduled.discard)

    async def _analyse_later(self, delay: float) -> None:
        generation = self.specs.generation
        await asyncio.sleep(delay)
        while generation == self.specs.generation and (pending := self.specs.pending()):
            await asyncio.gather(*map(self._analysed, pending))
        if generation == self.specs.generation:
            self._publish()

    def _analysed(self, path: Path) -> asyncio.Future[None]:
        """Return what ends when a spec is analysed; a request that is cancelled does not cancel it."""
        real = identity(path)
        if real not in self._analyses:
            self._analyses[real] = task = asyncio.get_running_loop().create_task(self._analyse(path))
            task.add_done_callback(lambda _: self._analyses.pop(real))
        return asyncio.shield(self._analyses[real])

    async def _analyse(self, path: Path) -> None:
        """Analyse a spec; again if it changed meanwhile. Threads get values only: the loop changes what is known."""
        while path in self.specs.pending():
            settings = self.specs.begin(path)
            run = partial(asyncio.get_running_loop().run_in_executor, self._analysers)
            analysis = await run(partial(analyse_path, path, settings))
            includers: Iterable[Path] = ()
            if is_part(analysis) and identity(path) in self.specs.buffers:
                users = await run(partial(find_users, path, self.folders, settings))
                includers = [user for user, one in users.items() if not is_part(one)]
            self.specs.keep(path, analysis, includers)

    def in_thread(self, work: Callable[[], _Result]) -> asyncio.Future[_Result]:
        """Do what takes long for a request in a thread; it may use values only, as the loop changes what is known."""
        return asyncio.get_running_loop().run_in_executor(self._worker, work)

    def _publish(self) -> None:
        """Send the diagnostics of all files, and remove those of files that have none any more."""
        roots = {path: self.specs.analyses[identity(path)] for path in self.specs.roots()}
        found = diagnostics_by_uri(roots, self.columns)
        # A file may be open by several paths, which links make.
        by_file = {identity(path): listed for uri, listed in found.items() if (path := path_of(uri))}
        open_texts = {document.uri: document.version for document in self.workspace.text_documents.values()}
        for uri in {**found, **dict.fromkeys(self._published), **open_texts}:
            path = path_of(uri)
            listed = found.get(uri) or (by_file.get(identity(path), []) if path else [])
            self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, listed, open_texts.get(uri)))
        self._published = set(found)

    def document(self, uri: str) -> Document | None:
        """Return what is known of an open spec; its analyses may be older than its text."""
        path = path_of(uri)
        return self.specs.document(path, self.columns) if path else None

    async def analysed(self, uri: str) -> Document | None:
        """Return what is known of an open spec once its text is analysed, by itself and by those that read it."""
        path = path_of(uri)
        while path and (pending := self.specs.pending_for(path)):
            await self._analysed(pending[0])
        return self.document(uri)

    async def analysed_with_users(self, uri: str) -> Document | None:
        """Return what is known of an open spec, and of the specs in the workspace that read it."""
        document = await self.analysed(uri)
        if document is None:
            return None
        find = partial(find_users, document.path, self.folders, self.specs.settings())
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
        options = params.initialization_options
        packages = options.get("packages") if isinstance(options, dict) else None
        entries = packages.items() if isinstance(packages, dict) else ()
        server.specs.packages = {name: Path(place) for name, place in entries if isinstance(place, str)}
        server.hints = HintOptions.of(options)

    @server.feature(types.INITIALIZED)
    async def _initialized(_params: types.InitializedParams) -> None:
        workspace = server.client_capabilities.workspace
        watching = workspace.did_change_watched_files if workspace else None
        if watching and watching.dynamic_registration:
            await server.client_register_capability_async(types.RegistrationParams([_WATCHING]))

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def _opened(params: types.DidOpenTextDocumentParams) -> None:
        _put(server, params.text_document.uri, delay=0)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def _changed(params: types.DidChangeTextDocumentParams) -> None:
        _put(server, params.text_document.uri, delay=DEBOUNCE)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def _closed(params: types.DidCloseTextDocumentParams) -> None:
        if path := path_of(params.text_document.uri):
            server.specs.close(path)
            server.schedule()
            for other in server.workspace.text_documents.values():
                if identity(path_of(other.uri) or "") == identity(path):
                    _put(server, other.uri, delay=0)

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def _files_changed(params: types.DidChangeWatchedFilesParams) -> None:
        paths = (path for change in params.changes if (path := path_of(change.uri)))
        noted = [server.specs.note_change(path) for path in paths if identity(path) not in server.specs.buffers]
        if any(noted):
            server.schedule()


def _add_completion(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=TRIGGERS))
    def _complete(params: types.CompletionParams) -> list[types.CompletionItem]:
        document = server.document(params.text_document.uri)
        client = Client.of(server.client_capabilities)
        return complete(document, params.position, server.specs.settings(), client) if document else []


def _put(server: SpecServer, uri: str, *, delay: float) -> None:
    path = path_of(uri)
    if path is not None:
        document = server.workspace.get_text_document(uri)
        server.specs.put(path, document.version, document.source)
        server.schedule(delay)


def _add_structure(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    def _fold(params: types.FoldingRangeParams) -> list[types.FoldingRange]:
        document = server.document(params.text_document.uri)
        return folding_ranges(document.file) if document else []

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    async def _format(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        document = server.document(params.text_document.uri)
        return await server.in_thread(partial(format_edits, document)) if document else []

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def _outline(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        document = await server.analysed(params.text_document.uri)
        return outline(document) if document else []

    @server.feature(types.WORKSPACE_SYMBOL)
    async def _find(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        specs = server.specs
        return await server.in_thread(
            partial(find_symbols, params.query, server.folders, specs.settings(), server.columns)
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
        generation = server.specs.generation
        document = await server.analysed_with_users(params.text_document.uri)
        if document is None:
            return None
        at, settings = document.place(params.position), server.specs.settings()
        with _refusals():
            edits = await server.in_thread(partial(rename, document, at, params.new_name, settings, server.folders))
            if generation != server.specs.generation:
                raise RefusedError("the workspace changed meanwhile; try again")
        return (
            workspace_edit(edits, server.specs.versions, server.columns, server.client_capabilities) if edits else None
        )


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
        if document is None:
            return []
        settings = server.specs.settings()
        return await server.in_thread(partial(code_actions, document, params.range, params.context, settings))
