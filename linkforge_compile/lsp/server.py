"""The server of one editor: when specs are analysed, what is published, and which thread answers a request."""

from __future__ import annotations

import asyncio
import gc
import logging
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException, JsonRpcInternalError
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol

from linkforge_compile._version import __version__
from linkforge_compile.analysis import Analysis, Settings, analyse_path
from linkforge_compile.compilation import Compilation
from linkforge_compile.lsp.convert import Columns, path_of
from linkforge_compile.lsp.diagnostics import diagnostics_by_uri
from linkforge_compile.lsp.inlay_hints import HintOptions
from linkforge_compile.lsp.workspace import Document, Workspace, find_users, is_part
from linkforge_compile.roots import identity

_Result = TypeVar("_Result")

_Work: TypeAlias = Callable[[Document, Settings], _Result]
"""What answers a request: a function of a document, and of the settings with which specs are analysed."""

DEBOUNCE = 0.1
"""Time without a change before specs are analysed [s]."""


def _is_fault(record: logging.LogRecord) -> bool:
    """Whether a record is about a fault: an answer may cross its cancellation, and a refusal is an answer."""
    is_refusal = record.exc_info is not None and isinstance(record.exc_info[1], JsonRpcException)
    return not is_refusal and not record.getMessage().startswith("Cancel notification for unknown message")


class _Protocol(LanguageServerProtocol):
    """The protocol of pygls, without what is done: pygls 2.1 keeps 3 kB of every notification, so of every edit."""

    def _execute_handler(self, msg_id: str | int, *arguments: Any, **options: Any) -> None:
        super()._execute_handler(msg_id, *arguments, **options)
        if running := self._request_futures.get(msg_id):
            running.add_done_callback(lambda _: self._request_futures.pop(msg_id, None))


class SpecServer(LanguageServer):
    """The language server of one editor.

    Texts come whole, as specs are short, and an edit by line and column depends on what a line is. Threads analyse
    specs and answer requests; the loop of events changes what is known, and hands them values.
    """

    def __init__(self) -> None:
        sync = types.TextDocumentSyncKind.Full
        super().__init__("linkforge", __version__, text_document_sync_kind=sync, protocol_cls=_Protocol)
        logging.getLogger("pygls.protocol.json_rpc").addFilter(_is_fault)
        self.specs = Workspace()
        self.hints = HintOptions()
        # What takes long, a spec or a request, does not delay the others.
        self._analysers = ThreadPoolExecutor(max_workers=2, thread_name_prefix="analysis")
        self._workers = ThreadPoolExecutor(max_workers=4, thread_name_prefix="requests")
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
            # An analysis leaves cycles, which the collector would leave for many more, and memory grow meanwhile.
            gc.collect()

    def _analysed(self, path: Path) -> asyncio.Future[None]:
        """Return what ends when a spec is analysed; a request that is cancelled does not cancel it."""
        real = identity(path)
        if real not in self._analyses:
            self._analyses[real] = asyncio.get_running_loop().create_task(self._analyse(path))
        return asyncio.shield(self._analyses[real])

    async def _analyse(self, path: Path) -> None:
        """Analyse a spec; again if it changed meanwhile."""
        while path in self.specs.pending():
            settings = self.specs.begin(path)
            run = partial(asyncio.get_running_loop().run_in_executor, self._analysers)
            includers: Iterable[Path] = ()
            try:
                analysis = await run(partial(analyse_path, path, settings))
                if is_part(analysis) and identity(path) in self.specs.buffers:
                    users = await run(partial(find_users, path, self.folders, settings))
                    includers = [user for user, one in users.items() if not is_part(one)]
            except Exception as error:  # a fault of the compiler, which must not end the diagnostics of other specs
                self.report_server_error(error, JsonRpcInternalError)
                analysis = Analysis(Compilation(None, ()))
            self.specs.keep(path, analysis, includers)
        # Not in a callback of the task, since a change may come before that is called.
        del self._analyses[identity(path)]

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

    async def wait_for(self, uri: str) -> None:
        """Wait until the text of a spec is analysed, by itself and by those that read it."""
        path = path_of(uri)
        while path and (pending := self.specs.pending_for(path)):
            await self._analysed(pending[0])

    async def answer_at_once(self, uri: str, work: _Work[_Result]) -> _Result | None:
        """Do what a request needs with what is known of an open spec; None if it is not open."""
        document = self.document(uri)
        return await self.in_thread(partial(work, document, self.specs.settings())) if document else None

    async def answer(self, uri: str, work: _Work[_Result]) -> _Result | None:
        """Do what a request needs with an open spec once its text is analysed; None if it is not open."""
        await self.wait_for(uri)
        return await self.answer_at_once(uri, work)

    def in_thread(self, work: Callable[[], _Result]) -> asyncio.Future[_Result]:
        """Do what a request needs in a thread; it may use values only, as the loop changes what is known."""
        return asyncio.get_running_loop().run_in_executor(self._workers, work)
