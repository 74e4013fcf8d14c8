"""The server of a live viewer over HTTP: what it answers, and what it refuses."""

import gc
import http.client
import json
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from linkforge_compile.analysis import Settings
from linkforge_compile.view import server as server_module
from linkforge_compile.view.server import ViewServer
from linkforge_compile.view.session import Session

SPEC = """\
linkforge: 1
name: arm
parameters: {reach: {type: length, default: 1 m}}
links: {base: {visual: {mesh: part.stl}}}
"""
MESH = (
    b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"
)
PAGE = '<script>console.log(1)</script><script id="scene" type="application/json">{}</script>'


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "arm.robot.yaml"
    path.write_text(SPEC)
    (tmp_path / "part.stl").write_bytes(MESH)
    return path


@pytest.fixture
def server(spec: Path) -> Iterator[ViewServer]:
    session = Session(spec, Settings([]))
    session.renew()
    server = ViewServer(session, lambda scene: PAGE.format(json.dumps(scene)))
    server.start()
    yield server
    server.stop()


class Answer:
    """The answer to one request."""

    def __init__(self, response: http.client.HTTPResponse) -> None:
        self.status, self.body, self.headers = response.status, response.read(), response.headers


def request(server: ViewServer, path: str, method: str = "GET", body: bytes | None = None, **headers: str) -> Answer:
    """Send a request to a path below the token, or to another one if it begins with a slash."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=20)
    path = path if path.startswith("/") else f"/{server.token}/{path}"
    try:
        connection.request(method, path, body, {name.replace("_", "-"): value for name, value in headers.items()})
        return Answer(connection.getresponse())
    finally:
        connection.close()


def post(server: ViewServer, body: object, **headers: str) -> Answer:
    content = body if isinstance(body, bytes) else json.dumps(body).encode()
    return request(server, "settings", "POST", content, **{"Content_Type": "application/json"} | headers)


class Events:
    """A page that receives events."""

    def __init__(self, server: ViewServer, query: str = "", **headers: str) -> None:
        self._socket = socket.create_connection(("127.0.0.1", server.server_port), timeout=20)
        lines = [f"{name.replace('_', '-')}: {value}\r\n" for name, value in headers.items()]
        head = f"GET /{server.token}/events{query} HTTP/1.1\r\nHost: 127.0.0.1\r\n{''.join(lines)}\r\n"
        self._socket.sendall(head.encode())
        self._stream = self._socket.makefile("rb")
        while self._stream.readline().strip():
            pass

    def next(self) -> dict[str, Any]:
        while line := self._stream.readline():
            if line.startswith(b"data: "):
                update: dict[str, Any] = json.loads(line[6:])
                return update
        raise EOFError

    def close(self) -> None:
        self._stream.close()
        self._socket.close()


def test_the_page_holds_the_scene_and_runs_only_its_own_script(server: ViewServer):
    page = request(server, "")
    assert page.status == 200
    assert json.loads(page.body.decode().partition('json">')[2].removesuffix("</script>"))["live"] is True
    policy = page.headers["Content-Security-Policy"]
    # echo -n 'console.log(1)' | openssl dgst -sha256 -binary | base64
    assert "script-src 'sha256-CihokcEcBW4atb/CW/XWsvWwbTjqwQlE9nj9ii5ww5M=';" in policy
    assert "default-src 'none'" in policy
    assert "unsafe-eval" not in policy


@pytest.mark.parametrize("path", ["", "codes/LF4102", "nothing", "/"])
def test_every_answer_has_strict_headers(server: ViewServer, path: str):
    headers = request(server, path).headers
    assert headers["Cache-Control"] == "no-store"
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "same-origin"
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin"


def test_a_file_is_sent_by_its_digest(server: ViewServer):
    (digest,) = server.session.state.files.files
    answer = request(server, f"files/{digest}")
    assert (answer.status, answer.body) == (200, MESH)
    assert answer.headers["Content-Type"] == "application/octet-stream"


def test_the_manual_page_of_a_code_is_text(server: ViewServer):
    answer = request(server, "codes/LF4102")
    assert answer.body.startswith(b"# LF4102")
    assert answer.headers["Content-Type"] == "text/plain; charset=utf-8"


@pytest.mark.parametrize(
    "path",
    [
        "/",
        "/favicon.ico",
        "/wrong/",
        "/wrong/events",
        "files/0123456789abcdef0123456789abcdef",
        "files/",
        "files/part.stl",
        "files/../arm.robot.yaml",
        "files/..%2Farm.robot.yaml",
        "files//etc/passwd",
        "../../etc/passwd",
        "codes/../README",
        "codes/LF0000",
        "codes/..%2F..%2Fsecurity",
        "arm.robot.yaml",
        "settings",
    ],
)
def test_nothing_else_is_found(server: ViewServer, path: str):
    assert request(server, path).status == 404


def test_a_request_without_the_token_is_not_answered_even_with_the_digest(server: ViewServer):
    (digest,) = server.session.state.files.files
    assert request(server, f"/files/{digest}").status == 404
    assert request(server, f"/{server.token[:-1]}/files/{digest}").status == 404
    assert request(server, f"/{server.token}%C3%A9/").status == 404


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "localhost@evil", ""])
def test_another_host_is_refused(server: ViewServer, host: str):
    """A name of another site may lead to this machine (DNS rebinding)."""
    assert request(server, "", Host=host).status == 403
    assert post(server, {}, Host=host).status == 403


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://localhost:1", "https://127.0.0.1:80"])
def test_another_origin_is_refused(server: ViewServer, origin: str):
    assert request(server, "", Origin=origin).status == 403
    assert post(server, {"parameters": {"reach": "2 m"}}, Origin=origin).status == 403
    assert server.session.poll() == ()


def test_a_forwarded_port_is_answered(server: ViewServer):
    answer = post(server, {"parameters": {"reach": "2 m"}}, Host="localhost:8123", Origin="http://localhost:8123")
    assert answer.status == 204
    assert server.session.poll() == ("parameter reach",)


def test_settings_are_chosen_and_null_sets_nothing(server: ViewServer):
    answer = post(server, {"parameters": {"reach": "2 m", "tool": None}, "variant": None})
    assert (answer.status, answer.body) == (204, b"")
    assert server.session.poll() == ("parameter reach",)


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        (b"{", "is not JSON"),
        (b"\xff\xfe\xff", "is not JSON"),
        (b"[" * 60_000, "is not JSON"),
        ([], "must be an object"),
        ({"parameter": {}}, "must be an object with the keys parameters and variant"),
        ({"parameters": []}, "parameters must be"),
        ({"parameters": {"reach": 2}}, "parameters must be"),
        ({"variant": ["sim"]}, "variant must be"),
    ],
)
def test_wrong_settings_are_refused_with_the_reason(server: ViewServer, body: object, reason: str):
    answer = post(server, body)
    assert answer.status == 400
    assert reason in answer.body.decode()
    assert server.session.poll() == ()


def test_settings_that_are_too_long_or_of_another_type_are_refused(server: ViewServer):
    assert post(server, b" " * (server_module.MOST_BYTES + 1)).status == 413
    assert post(server, {}, Content_Type="text/plain").status == 415
    assert post(server, {}, Content_Length="-1").status == 411
    assert request(server, "", "POST", b"{}", Content_Type="application/json").status == 404
    assert request(server, "settings", "PUT", b"{}").status == 501


def test_events_begin_with_the_present_state_and_follow_each_change(server: ViewServer, spec: Path):
    events = Events(server)
    first = events.next()
    assert (first["version"], first["scene"]["name"], first["problems"]) == (1, "arm", [])
    spec.write_text("linkforge: 1\nname: arm\nlinks: {base: }\n")
    server.session.renew()
    assert events.next()["scene"]["links"][0]["visuals"] == []
    spec.write_text("linkforge: 1\nname: arm\nlinks: {bose: {}, base: }\n")
    server.session.renew()
    third = events.next()
    assert (third["version"], third["scene"]) == (3, None)
    assert third["problems"][0]["code"] == "LF5404"
    events.close()


@pytest.mark.parametrize(("query", "headers"), [("?version=1", {}), ("", {"Last_Event_ID": "1"})])
def test_a_page_that_has_the_scene_gets_no_second_one(server: ViewServer, query: str, headers: dict[str, str]):
    events = Events(server, query, **headers)
    assert events.next()["scene"] is None
    events.close()


def test_pages_receive_the_same_events(server: ViewServer):
    pages = [Events(server) for _ in range(2)]
    assert [page.next()["version"] for page in pages] == [1, 1]
    server.session.renew()
    assert [page.next()["version"] for page in pages] == [2, 2]
    for page in pages:
        page.close()


def test_the_end_of_the_server_ends_the_events(spec: Path):
    session = Session(spec, Settings([]))
    session.renew()
    server = ViewServer(session, lambda _: PAGE)
    server.start()
    events = Events(server)
    events.next()
    server.stop()
    with pytest.raises(EOFError):
        events.next()
    events.close()
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", server.server_port), timeout=20)


def test_pages_that_vanish_leave_no_threads(server: ViewServer, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(server_module, "KEEP_ALIVE", 0.05)
    before = threading.active_count()
    pages = [Events(server) for _ in range(20)]
    assert [page.next()["version"] for page in pages] == [1] * 20
    assert threading.active_count() == before + 20
    for page in pages:
        page.close()
    until = time.monotonic() + 20
    while threading.active_count() > before and time.monotonic() < until:
        time.sleep(0.05)
    assert threading.active_count() == before


def test_a_port_that_is_not_free_is_an_error(server: ViewServer):
    with pytest.raises(OSError, match="in use"):
        ViewServer(server.session, lambda _: PAGE, server.server_port)


def test_updates_leave_nothing_in_memory(server: ViewServer, spec: Path):
    events, sizes = Events(server), [0]
    events.next()
    for number in range(220):
        spec.write_text(SPEC.replace("part.stl}", f"part.stl, origin: [{number + 1}, 0, 0]}}"))
        server.session.renew()
        assert events.next()["scene"]["version"] == number + 2
        if number in (20, 219):
            gc.collect()
            sizes.append(len(gc.get_objects()))
    events.close()
    assert sizes[2] - sizes[1] < 500  # a state has thousands
