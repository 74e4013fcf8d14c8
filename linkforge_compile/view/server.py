"""The server of a live viewer: one page on 127.0.0.1, its files, and events for each new state of a session.

A request needs the random token in its path, and a Host and Origin of this machine. No path of a file is taken from it.
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from secrets import compare_digest, token_urlsafe
from threading import Thread
from typing import NamedTuple
from urllib.parse import parse_qs, urlsplit

from linkforge_compile.diagnostics.codes import REGISTER
from linkforge_compile.resources import manual_folder
from linkforge_compile.view.html import content_security_policy
from linkforge_compile.view.scene import Scene
from linkforge_compile.view.session import Session

ADDRESS = "127.0.0.1"

KEEP_ALIVE = 5.0
"""Time between two messages to a page without news, which find out whether it is still open [s]."""

FIRST = 60.0
"""The longest time that a page waits for the first compile [s]; it then gets the scene by an event."""

MOST_BYTES = 64 * 1024
"""The longest body of a request."""

_MOST_DRAINED = 1024 * 1024
"""How much of a longer body is read, so that the sender can read the answer."""

_IMAGES = {"png": "image/png", "jpg": "image/jpeg", "webp": "image/webp", "bmp": "image/bmp", "gif": "image/gif"}

_HOST = re.compile(r"(127\.0\.0\.1|localhost)(:\d{1,5})?", re.IGNORECASE)
"""The names of this machine; over ssh the page may be at another port."""


class Choice(NamedTuple):
    """What a page changes: parameters by name, to a text or, with None, to their default, and the variant."""

    values: Mapping[str, str | None]
    variant: str | None = None
    has_variant: bool = False


class RefusedError(Exception):
    """A request is refused; the message says why."""

    def __init__(self, reason: str, status: HTTPStatus = HTTPStatus.BAD_REQUEST) -> None:
        super().__init__(reason)
        self.status = status


def parse_choice(body: bytes) -> Choice:
    """Read `{"parameters": {name: text or null}, "variant": text or null}`, each optional. Raises RefusedError."""
    try:
        document = json.loads(body)
    except (ValueError, RecursionError) as error:
        raise RefusedError("the body is not JSON in UTF-8") from error
    if not isinstance(document, dict) or not document.keys() <= {"parameters", "variant"}:
        raise RefusedError("the body must be an object with the keys parameters and variant")
    parameters, variant = document.get("parameters", {}), document.get("variant")
    if not isinstance(parameters, dict) or not all(
        text is None or isinstance(text, str) for text in parameters.values()
    ):
        raise RefusedError("parameters must be an object with a text or null for each name")
    if variant is not None and not isinstance(variant, str):
        raise RefusedError("variant must be a text or null")
    return Choice(parameters, variant, "variant" in document)


class ViewServer(ThreadingHTTPServer):
    """Serves the pages of one session, each request in a thread of its own.

    `render` makes the page of a scene. Raises OSError if the port, 0 for any, is not free.
    """

    daemon_threads = True
    request_queue_size = 64
    # On Windows, this would let a second program take the port.
    allow_reuse_address = os.name != "nt"

    def __init__(self, session: Session, render: Callable[[Scene], str], port: int = 0) -> None:
        super().__init__((ADDRESS, port), _Handler)
        self.session, self.render = session, render
        self.token = token_urlsafe(24)

    @property
    def url(self) -> str:
        return f"http://{ADDRESS}:{self.server_port}/{self.token}/"

    def start(self) -> None:
        """Serve in a thread, until `stop`."""
        Thread(target=self.serve_forever, name="view", daemon=True).start()

    def stop(self) -> None:
        """End all connections and release the port; only after `start`."""
        self.session.close()
        self.shutdown()
        self.server_close()

    def handle_error(self, request: object, client_address: object) -> None:
        """Report a bug; a page that closed the connection, or does not read, is not one."""
        if not isinstance(sys.exception(), OSError):
            super().handle_error(request, client_address)  # type: ignore[arg-type]  # it prints the address


class _Handler(BaseHTTPRequestHandler):
    """One request."""

    server: ViewServer
    timeout = 30  # a client that neither reads nor writes [s]
    server_version, sys_version = "linkforge", ""

    def do_GET(self) -> None:
        if (words := self._words()) is None:
            return
        match words:
            case [""]:
                self._send_page()
            case ["events"]:
                self._send_events()
            case ["files", digest] if file := self.server.session.state.content_of(digest):
                kind, content = file
                self._send(content, _IMAGES.get(kind, "application/octet-stream"))
            case ["codes", code] if code in REGISTER:
                self._send((manual_folder() / f"{code}.md").read_bytes(), "text/plain; charset=utf-8")
            case _:
                self._refuse(HTTPStatus.NOT_FOUND, "there is no such page")

    def do_POST(self) -> None:
        if (words := self._words()) is None:
            return
        if words != ["settings"]:
            self._refuse(HTTPStatus.NOT_FOUND, "there is no such page")
            return
        try:
            choice = parse_choice(self._body())
        except RefusedError as error:
            self._refuse(error.status, str(error))
            return
        session = self.server.session
        session.choose(choice.values, *([choice.variant] if choice.has_variant else ()))
        self.send_response(HTTPStatus.NO_CONTENT)
        self.end_headers()

    def _body(self) -> bytes:
        """Return the body of a request, JSON by its type. Raises RefusedError."""
        if self.headers.get_content_type() != "application/json":
            raise RefusedError("the body must be application/json", HTTPStatus.UNSUPPORTED_MEDIA_TYPE)
        length = self.headers.get("Content-Length", "")
        if not (length.isascii() and length.isdecimal() and len(length) < 16):
            raise RefusedError("the request needs a Content-Length", HTTPStatus.LENGTH_REQUIRED)
        if int(length) > MOST_BYTES:
            self.rfile.read(min(int(length), _MOST_DRAINED))
            raise RefusedError(f"the body may have {MOST_BYTES} bytes", HTTPStatus.REQUEST_ENTITY_TOO_LARGE)
        return self.rfile.read(int(length))

    def _words(self) -> list[str] | None:
        """Return the path below the token; None if the request was refused, and answered."""
        host, origin = self.headers.get("Host", ""), self.headers.get("Origin")
        if not _HOST.fullmatch(host) or origin not in (None, f"http://{host}"):
            # It comes from another site, also from one whose name leads to this machine.
            self._refuse(HTTPStatus.FORBIDDEN, "the viewer answers its own page only")
            return None
        empty, *words = urlsplit(self.path).path.split("/")
        if empty or not words or not compare_digest(words[0].encode(), self.server.token.encode()):
            self._refuse(HTTPStatus.NOT_FOUND, "there is no such page; open the address that linkforge view prints")
            return None
        return words[1:]

    def _send_page(self) -> None:
        page = self.server.render(self.server.session.wait(0, FIRST).scene)
        self._send(page.encode(), "text/html; charset=utf-8", content_security_policy(page, has_server=True))

    def _send_events(self) -> None:
        """Send an event for the current state and for each new one, until the page or the session ends."""
        session, known = self.server.session, self._known_version()
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/event-stream")
        self.end_headers()
        last = 0
        while not session.is_closed:
            state = session.wait(last, KEEP_ALIVE)
            if state.version == last:
                self.wfile.write(b": keep-alive\n\n")
                continue
            update = json.dumps(state.update_since(known))
            self.wfile.write(f"id: {state.version}\nevent: update\ndata: {update}\n\n".encode())
            last = known = state.version

    def _known_version(self) -> int:
        """Return the version that the page has, from its last event or its first scene; 0 for none."""
        asked = parse_qs(urlsplit(self.path).query).get("version", [""])[-1]
        known = self.headers.get("Last-Event-ID") or asked
        return int(known) if known.isascii() and known.isdecimal() and len(known) < 16 else 0

    def _send(self, content: bytes, type_: str, policy: str = "default-src 'none'") -> None:
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", type_)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Content-Security-Policy", policy)
        self.end_headers()
        self.wfile.write(content)

    def _refuse(self, status: HTTPStatus, reason: str) -> None:
        content = f"{reason}\n".encode()
        self.send_response(status)
        self.send_header("Content-Type", "text/plain; charset=utf-8")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def end_headers(self) -> None:
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "same-origin")
        self.send_header("Cross-Origin-Resource-Policy", "same-origin")
        self.send_header("Cross-Origin-Opener-Policy", "same-origin")
        super().end_headers()

    def log_message(self, format: str, *arguments: object) -> None:  # noqa: A002 the name of its base class
        """Print no line for each request."""
