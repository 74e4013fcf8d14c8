"""A client of yaml-language-server over stdio: it opens a document, asks at a place, and closes it again."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from queue import Queue
from threading import Thread
from typing import Any, NamedTuple

CARET = "|"
"""Marks the place of a request in a document."""

SPEC = "arm.robot.yaml"
"""The default name of a document."""

_PATIENCE = 60.0
"""[s]; far more than the server takes, so that a loaded machine fails no test."""

_OFFLINE = {"schemaStore": {"enable": False}, "kubernetesCRDStore": {"enable": False}}

_CAPABILITIES = {
    "textDocument": {
        "completion": {"completionItem": {"snippetSupport": True, "documentationFormat": ["markdown"]}},
        "hover": {"contentFormat": ["markdown"]},
    },
    "workspace": {"configuration": True},
}


class Completion(NamedTuple):
    """A completion: the word, its description, and the inserted text."""

    label: str
    description: str
    inserted: str


class Fault(NamedTuple):
    """A diagnostic of the server: the text that is underlined, and the message."""

    text: str
    message: str


class LanguageServer:
    """One server process, and the folder of its documents and of the schema that their modeline names."""

    def __init__(self, command: list[str], folder: Path, settings: Mapping[str, object] | None = None) -> None:
        """`settings` are further ones of "yaml"."""
        self._folder = folder
        self._settings = {"yaml": {**_OFFLINE, **(settings or {})}}
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._numbers = count(1)
        self._received: Queue[dict[str, Any]] = Queue()
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()
        self._request("initialize", processId=None, rootUri=folder.as_uri(), capabilities=_CAPABILITIES)
        self._notify("initialized")
        self._notify("workspace/didChangeConfiguration", settings=self._settings)

    def close(self) -> None:
        self._request("shutdown")
        self._notify("exit")
        self._reader.join(_PATIENCE)
        with self._process:  # closes its pipes and waits for it
            pass

    def completions(self, document: str, file: str = SPEC) -> list[Completion]:
        """Return what is offered at the caret of a file, in the order in which an editor shows it."""
        items = (self._at_caret("textDocument/completion", document, file) or {"items": []})["items"]
        return [
            Completion(item["label"], _markdown(item.get("documentation")), item["textEdit"]["newText"])
            for item in sorted(items, key=lambda item: str(item.get("sortText", item["label"])))
        ]

    def hover(self, document: str, file: str = SPEC) -> str:
        """Return what is shown for the word at the caret; "" for nothing."""
        shown = self._at_caret("textDocument/hover", document, file)
        return _markdown(shown["contents"]) if shown else ""

    def faults(self, text: str, file: str = SPEC) -> list[Fault]:
        """Return what is underlined in a document, from top to bottom."""
        with self._opened(text, file) as document:
            published = self._validated(document)
        found = sorted(published["params"]["diagnostics"], key=lambda fault: _place(fault["range"]["start"]))
        return [Fault(_underlined(text, fault["range"]), fault["message"]) for fault in found]

    def _at_caret(self, method: str, document: str, file: str) -> Any:
        before, caret, after = document.partition(CARET)
        assert caret, f"no {CARET} in {document!r}"
        line, column = before.count("\n"), len(before) - before.rfind("\n") - 1
        with self._opened(before + after, file) as opened:
            # As in an editor, where nobody asks before the file is judged: only then the server knows which it is.
            self._validated(opened)
            place = {"line": line, "character": column}
            return self._request(method, textDocument=opened, position=place)

    @contextmanager
    def _opened(self, text: str, file: str) -> Iterator[dict[str, object]]:
        # What it knows of a document it keeps for the version.
        opened = {"uri": (self._folder / file).as_uri(), "version": next(self._numbers)}
        self._notify("textDocument/didOpen", textDocument={**opened, "languageId": "yaml", "text": text})
        yield opened
        self._notify("textDocument/didClose", textDocument=opened)
        self._validated(opened)  # nothing is underlined any more

    def _validated(self, opened: dict[str, object]) -> dict[str, Any]:
        return self._until(lambda message: (message.get("params") or {}).get("uri") == opened["uri"])

    def _request(self, method: str, **params: object) -> Any:
        number = next(self._numbers)
        self._send({"id": number, "method": method, "params": params})
        answer = self._until(lambda message: message.get("id") == number and "method" not in message)
        assert "error" not in answer, answer
        return answer["result"]

    def _notify(self, method: str, **params: object) -> None:
        self._send({"method": method, "params": params})

    def _send(self, message: dict[str, object]) -> None:
        content = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self._process.stdin
        self._process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(content) + content)
        self._process.stdin.flush()

    def _until(self, is_wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Return the first message that is wanted; what the server asks meanwhile is answered."""
        while True:
            message = self._received.get(timeout=_PATIENCE)
            if "method" in message and "id" in message:
                sections = [item.get("section") for item in message["params"].get("items", [])]
                self._send(
                    {"id": message["id"], "result": [self._settings.get(str(section)) for section in sections] or None}
                )
            elif is_wanted(message):
                return message

    def _read(self) -> None:
        """Put every message into the queue, until the server closes its end."""
        stream = self._process.stdout
        assert stream
        while header := stream.readline():
            length = int(header.removeprefix(b"Content-Length:")) if header.startswith(b"Content-Length:") else None
            if length is not None:
                while stream.readline().strip():
                    pass
                self._received.put(json.loads(stream.read(length)))


def _markdown(content: str | dict[str, str] | None) -> str:
    return content["value"] if isinstance(content, dict) else content or ""


def _place(position: dict[str, int]) -> tuple[int, int]:
    return position["line"], position["character"]


def _underlined(text: str, span: dict[str, dict[str, int]]) -> str:
    lines = text.split("\n")
    (first, start), (last, end) = _place(span["start"]), _place(span["end"])
    whole = "\n".join(lines[first : last + 1])
    return whole[start : len(whole) - len(lines[last]) + end]
