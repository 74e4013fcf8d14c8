"""What an editor may send, and the function of each feature that answers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics.fix import Edit
from linkforge_compile.lsp.changes import changes_of, workspace_edit
from linkforge_compile.lsp.code_actions import KINDS, code_actions
from linkforge_compile.lsp.completion import TRIGGERS, Client, complete
from linkforge_compile.lsp.convert import path_of
from linkforge_compile.lsp.document_links import declarations_in_xacro, document_links, files_at
from linkforge_compile.lsp.folding import folding_ranges
from linkforge_compile.lsp.formatting import format_edits
from linkforge_compile.lsp.hover import hover
from linkforge_compile.lsp.inlay_hints import HintOptions, inlay_hints
from linkforge_compile.lsp.last_read import as_last_read
from linkforge_compile.lsp.navigation import declarations_of, highlights, references_to
from linkforge_compile.lsp.rename import rename
from linkforge_compile.lsp.renaming import RefusedError, renamed_at
from linkforge_compile.lsp.semantic_tokens import LEGEND, semantic_tokens
from linkforge_compile.lsp.server import DEBOUNCE, SpecServer
from linkforge_compile.lsp.symbols import find_symbols, outline
from linkforge_compile.lsp.workspace import Document, with_users
from linkforge_compile.roots import identity

_WATCHING = types.Registration(
    "files",
    types.WORKSPACE_DID_CHANGE_WATCHED_FILES,
    types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher("**/*")]),
)
"""A spec depends on specs, robots of vendors, data and meshes, whatever their endings; only theirs analyse again."""


def make_server() -> SpecServer:
    """Return a server with all features, not started."""
    server = SpecServer()
    _add_start(server)
    _add_synchronization(server)
    _add_text_features(server)
    _add_symbols(server)
    _add_navigation(server)
    _add_rename(server)
    _add_hover(server)
    _add_hints(server)
    _add_actions(server)
    return server


def _add_start(server: SpecServer) -> None:
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


def _add_synchronization(server: SpecServer) -> None:
    def put(uri: str, *, delay: float) -> None:
        path = path_of(uri)
        if path is not None:
            document = server.workspace.get_text_document(uri)
            server.specs.put(path, document.version, document.source)
            server.schedule(delay)

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def _opened(params: types.DidOpenTextDocumentParams) -> None:
        put(params.text_document.uri, delay=0)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def _changed(params: types.DidChangeTextDocumentParams) -> None:
        put(params.text_document.uri, delay=DEBOUNCE)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def _closed(params: types.DidCloseTextDocumentParams) -> None:
        if path := path_of(params.text_document.uri):
            server.specs.close(path)
            server.schedule()
            for other in server.workspace.text_documents.values():
                if identity(path_of(other.uri) or "") == identity(path):
                    put(other.uri, delay=0)

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def _files_changed(params: types.DidChangeWatchedFilesParams) -> None:
        paths = (path for change in params.changes if (path := path_of(change.uri)))
        noted = [server.specs.note_change(path) for path in paths if identity(path) not in server.specs.buffers]
        if any(noted):
            server.schedule()


def _add_text_features(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=TRIGGERS))
    async def _complete(params: types.CompletionParams) -> types.CompletionList | None:
        at, client = params.position, Client.of(server.client_capabilities)
        return await server.answer_at_once(
            params.text_document.uri, lambda document, settings: complete(document, at, settings, client)
        )

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    async def _fold(params: types.FoldingRangeParams) -> list[types.FoldingRange] | None:
        return await server.answer_at_once(params.text_document.uri, lambda document, _: folding_ranges(document.file))

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    async def _format(params: types.DocumentFormattingParams) -> list[types.TextEdit] | None:
        return await server.answer_at_once(params.text_document.uri, lambda document, _: format_edits(document))


def _add_symbols(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def _outline(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol] | None:
        return await server.answer(params.text_document.uri, lambda document, _: outline(as_last_read(document)))

    @server.feature(types.WORKSPACE_SYMBOL)
    async def _find(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        settings = server.specs.settings()
        return await server.in_thread(partial(find_symbols, params.query, server.folders, settings, server.columns))


def _add_navigation(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def _define(params: types.DefinitionParams) -> list[types.Location] | None:
        def defined(document: Document, settings: Settings) -> list[types.Location]:
            last = as_last_read(document, params.position)
            at = last.place(params.position)
            found = declarations_of(last, at) or files_at(last, at, settings)
            return found or declarations_in_xacro(last, at, settings)

        return await server.answer(params.text_document.uri, defined)

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def _refer(params: types.ReferenceParams) -> list[types.Location] | None:
        folders, is_wanted = server.folders, params.context.include_declaration

        def used(document: Document, settings: Settings) -> list[types.Location]:
            last = with_users(as_last_read(document, params.position), folders, settings)
            return references_to(last, last.place(params.position), with_declarations=is_wanted)

        return await server.answer(params.text_document.uri, used)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    async def _highlight(params: types.DocumentHighlightParams) -> list[types.DocumentHighlight] | None:
        def highlighted(document: Document, _: Settings) -> list[types.DocumentHighlight]:
            last = as_last_read(document, params.position)
            return highlights(last, last.place(params.position))

        return await server.answer(params.text_document.uri, highlighted)


def _add_rename(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    async def _prepare(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        folders = server.folders

        def placeholder(document: Document, settings: Settings) -> types.PrepareRenamePlaceholder | None:
            target = renamed_at(with_users(document, folders, settings), document.place(params.position))
            return (
                types.PrepareRenamePlaceholder(document.columns.range(target[0]), target[0].text or "")
                if target
                else None
            )

        with _refusals():
            return await server.answer(params.text_document.uri, placeholder)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def _rename(params: types.RenameParams) -> types.WorkspaceEdit | None:
        folders, generation = server.folders, server.specs.generation

        def renamed(document: Document, settings: Settings) -> tuple[Edit, ...] | None:
            at = document.place(params.position)
            return rename(with_users(document, folders, settings), at, params.new_name, settings, folders)

        with _refusals():
            edits = await server.answer(params.text_document.uri, renamed)
            if generation != server.specs.generation:
                raise RefusedError("the workspace changed meanwhile; try again")
        if edits is None:
            return None
        return workspace_edit(changes_of(edits, server.columns), server.specs.versions, server.client_capabilities)


@contextmanager
def _refusals() -> Iterator[None]:
    """Answer a request that is refused with the reason, which editors show."""
    try:
        yield
    except RefusedError as error:
        raise JsonRpcException(str(error), types.LSPErrorCodes.RequestFailed.value) from None


def _add_hover(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def _hover(params: types.HoverParams) -> types.Hover | None:
        at = params.position
        return await server.answer(
            params.text_document.uri, lambda document, settings: hover(as_last_read(document, at), at, settings)
        )


def _add_hints(server: SpecServer) -> None:
    @server.feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
    def _configure(params: types.DidChangeConfigurationParams) -> None:
        settings = params.settings
        if isinstance(settings, dict) and "linkforge" in settings:
            server.hints = HintOptions.of(settings["linkforge"])

    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT)
    async def _hint(params: types.InlayHintParams) -> list[types.InlayHint] | None:
        visible, options = params.range, server.hints

        def hints(document: Document, _: Settings) -> list[types.InlayHint]:
            return inlay_hints(document, document.place(visible.start), document.place(visible.end), options)

        return await server.answer(params.text_document.uri, hints)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND)
    async def _classify(params: types.SemanticTokensParams) -> types.SemanticTokens | None:
        return await server.answer(params.text_document.uri, lambda document, _: semantic_tokens(document))

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_LINK)
    async def _link(params: types.DocumentLinkParams) -> list[types.DocumentLink] | None:
        return await server.answer(params.text_document.uri, document_links)


def _add_actions(server: SpecServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(code_action_kinds=KINDS))
    async def _act(params: types.CodeActionParams) -> list[types.CodeAction] | None:
        selection, context = params.range, params.context
        await server.wait_for(params.text_document.uri)
        # Taken together with the document: a later change does not give its version to edits of this text.
        make = partial(workspace_edit, versions=server.specs.versions, client=server.client_capabilities)
        return await server.answer_at_once(
            params.text_document.uri,
            lambda document, settings: code_actions(document, selection, context, settings, make),
        )
