"""An editor for tests: the real server in a process of its own, driven over stdio by pygls's client."""

import asyncio
import contextlib
import re
import sys
import threading
from collections.abc import Awaitable, Callable, Coroutine, Iterator, Sequence
from pathlib import Path
from typing import Self, TypeVar

from lsprotocol import types
from pygls.lsp.client import LanguageClient

_Answer = TypeVar("_Answer")

TIMEOUT = 30
"""How long an answer may take [s]; a machine under load is slow."""


def split_at_cursor(text: str) -> tuple[str, types.Position]:
    """Return a text without the `¦` that marks a position in it, and the position."""
    before, mark, after = text.partition("¦")
    assert mark, "a ¦ marks the position"
    line = before.rpartition("\n")[2]
    return before + after, types.Position(before.count("\n"), len(line.encode("utf-16-le")) // 2)


class Editor:
    """One server and the documents open in it; each method returns when the server has answered."""

    def __init__(
        self,
        *folders: Path,
        options: dict[str, object] | None = None,
        python: str = sys.executable,
        abilities: types.ClientCapabilities | None = None,
    ) -> None:
        """Create an editor with folders open; `options` are those of the server, which `python` runs.

        `abilities` are those of the editor, none unless given.
        """
        self._client = LanguageClient("editor", "1")
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._published: dict[str, types.PublishDiagnosticsParams] = {}
        self.registered: list[str] = []
        self._news = threading.Condition()
        self._versions: dict[str, int] = {}
        self._folders = folders
        self._options = options
        self._python = python
        self._abilities = abilities or types.ClientCapabilities()

    def __enter__(self) -> Self:
        self._thread.start()

        @self._client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
        def _published(params: types.PublishDiagnosticsParams) -> None:
            self._note_diagnostics(params)

        @self._client.feature(types.CLIENT_REGISTER_CAPABILITY)
        def _registered(params: types.RegistrationParams) -> None:
            with self._news:
                self.registered += [one.method for one in params.registrations]
                self._news.notify_all()

        self.wait(self._client.start_io(self._python, "-m", "linkforge_compile", "lsp"))
        folders = [types.WorkspaceFolder(folder.as_uri(), folder.name) for folder in self._folders]
        self.capabilities = self.wait(
            self._client.initialize_async(
                types.InitializeParams(self._abilities, workspace_folders=folders, initialization_options=self._options)
            )
        ).capabilities
        self._client.initialized(types.InitializedParams())
        return self

    def __exit__(self, *_exception: object) -> None:
        self.wait(self._client.shutdown_async(None))
        self._client.exit(None)
        self.wait(self._client.stop())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    @contextlib.contextmanager
    def in_workspace(self, folder: Path) -> Iterator[None]:
        """Open a folder, and close it with all of its documents."""
        opened = types.WorkspaceFolder(folder.as_uri(), folder.name)
        self._change_folders(added=[opened])
        try:
            yield
        finally:
            for uri in [*self._versions]:
                self._close(uri)
            self._change_folders(removed=[opened])
            with self._news:
                self._published.clear()

    def _change_folders(
        self, added: Sequence[types.WorkspaceFolder] = (), removed: Sequence[types.WorkspaceFolder] = ()
    ) -> None:
        event = types.WorkspaceFoldersChangeEvent(added, removed)
        params = types.DidChangeWorkspaceFoldersParams(event)
        self._send(lambda: self._client.workspace_did_change_workspace_folders(params))

    def wait(self, coroutine: Coroutine[object, object, _Answer]) -> _Answer:
        """Return the result of a coroutine of the client."""
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result(TIMEOUT)

    def ask(self, request: Callable[[LanguageClient], Awaitable[_Answer]]) -> _Answer:
        """Return the server's answer: `editor.ask(lambda client: client.text_document_hover_async(params))`."""

        async def answer() -> _Answer:
            return await request(self._client)

        return self.wait(answer())

    def send(self, notify: Callable[[LanguageClient], None]) -> None:
        """Send a notification."""
        self._send(lambda: notify(self._client))

    def cancel(self, method: str, params: object, after: float) -> None:
        """Send a request, and cancel it after some seconds."""

        async def send() -> None:
            answer = self._client.protocol.send_request(method, params, msg_id="cancelled")
            await asyncio.sleep(after)
            self._client.cancel_request(types.CancelParams("cancelled"))
            with contextlib.suppress(Exception, asyncio.CancelledError):
                await asyncio.wait_for(asyncio.wrap_future(answer), TIMEOUT)

        self.wait(send())

    def _note_diagnostics(self, params: types.PublishDiagnosticsParams) -> None:
        with self._news:
            self._published[params.uri] = params
            self._news.notify_all()

    def open(self, path: Path, text: str | None = None) -> types.TextDocumentIdentifier:
        """Open a file, with an unsaved text if one is given; a file that is open gets the text."""
        uri, text = path.as_uri(), path.read_text("utf-8") if text is None else text
        self._versions[uri] = version = self._versions.get(uri, 0) + 1
        if version == 1:
            item = types.TextDocumentItem(uri, "yaml", version, text)
            self._send(lambda: self._client.text_document_did_open(types.DidOpenTextDocumentParams(item)))
        else:
            document = types.VersionedTextDocumentIdentifier(version, uri)
            change = types.TextDocumentContentChangeWholeDocument(text)
            self._send(
                lambda: self._client.text_document_did_change(types.DidChangeTextDocumentParams(document, [change]))
            )
        return types.TextDocumentIdentifier(uri)

    def close(self, path: Path) -> None:
        self._close(path.as_uri())

    def _close(self, uri: str) -> None:
        del self._versions[uri]
        document = types.TextDocumentIdentifier(uri)
        self._send(lambda: self._client.text_document_did_close(types.DidCloseTextDocumentParams(document)))

    def wait_for_registration(self, method: str) -> None:
        """Wait until the server has asked for notifications of a kind."""
        with self._news:
            assert self._news.wait_for(lambda: method in self.registered, TIMEOUT), method

    def notify_files(self, changes: list[types.FileEvent]) -> None:
        """Report changes of files on disk."""
        params = types.DidChangeWatchedFilesParams(changes)
        self._send(lambda: self._client.workspace_did_change_watched_files(params))

    def _send(self, notify: Callable[[], None]) -> None:
        async def send() -> None:
            notify()

        self.wait(send())

    def diagnostics(self, path: Path) -> list[types.Diagnostic]:
        """Return the diagnostics of the current text of an open file."""
        uri = path.as_uri()

        def is_current() -> bool:
            return uri in self._published and self._published[uri].version == self._versions[uri]

        with self._news:
            assert self._news.wait_for(is_current, TIMEOUT), f"no diagnostics of {path}"
            return list(self._published[uri].diagnostics)

    def memory(self) -> float:
        """Return the memory that the server uses [MB]."""
        assert self._client._server is not None
        status = Path(f"/proc/{self._client._server.pid}/status").read_text("ascii")
        return int(re.findall(r"VmRSS:\s*(\d+)", status)[0]) / 1024

    def log(self) -> str:
        """Return what the server wrote to standard error, once it has ended."""
        assert self._client._server is not None
        assert self._client._server.stderr is not None
        return bytes(self._client._server.stderr._buffer).decode()  # type: ignore[attr-defined]  # its loop has ended

    def published(self, path: Path, until: Callable[[list[types.Diagnostic]], bool]) -> list[types.Diagnostic]:
        """Return the diagnostics of a file that need not be open, once they fulfil a condition."""
        uri = path.as_uri()

        def found() -> list[types.Diagnostic]:
            return list(self._published[uri].diagnostics) if uri in self._published else []

        with self._news:
            assert self._news.wait_for(lambda: until(found()), TIMEOUT), f"{path}: {found()}"
            return found()
