"""`linkforge view SPEC`: the live viewer as a process, from its address to Ctrl-C."""

import json
import socket
import sys
import urllib.request
import webbrowser
from collections.abc import Iterator
from pathlib import Path
from queue import Queue
from urllib.parse import urlsplit

import pytest

from linkforge_compile.view.session import Session
from tests.cli.in_process import linkforge
from tests.view.viewer import Viewer

SPEC = """\
linkforge: 1
name: arm
parameters: {reach: {type: length, default: 1 m}}
links: {base: {visual: {sphere: 1 m}}}
"""

pytestmark = pytest.mark.usefixtures("page")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "arm.robot.yaml").write_text(SPEC)
    return tmp_path


@pytest.fixture
def viewer(folder: Path) -> Iterator[Viewer]:
    viewer = Viewer("arm.robot.yaml", "reach:=2 m", cwd=folder)
    yield viewer
    viewer.close()


WATCHING = "watching arm.robot.yaml; Ctrl-C ends"


def test_each_change_is_compiled_and_printed_until_ctrl_c(viewer: Viewer, folder: Path):
    viewer.wait_for("shows arm: 1 link, no joints", WATCHING)
    spec = folder / "arm.robot.yaml"
    spec.write_text(SPEC.replace("sphere", "spere"))
    fault = "arm.robot.yaml:4:25: error: 'spere' is not a key of a visual; did you mean 'sphere'? [LF2101]"
    viewer.wait_for("arm.robot.yaml changed", fault, "the last robot without errors remains", WATCHING)
    spec.write_text(SPEC)
    viewer.wait_for("arm.robot.yaml changed", "shows arm: 1 link, no joints", WATCHING)
    body, head = json.dumps({"parameters": {"reach": "3 m"}}).encode(), {"Content-Type": "application/json"}
    with urllib.request.urlopen(urllib.request.Request(f"{viewer.url}settings", body, head)) as answer:
        assert answer.status == 204
    viewer.wait_for("parameter reach changed", "shows arm: 1 link, no joints", WATCHING)
    assert viewer.interrupt() == 130


def test_the_page_of_the_printed_address_holds_the_robot(viewer: Viewer):
    assert viewer.url.startswith("http://127.0.0.1:")
    with urllib.request.urlopen(viewer.url) as answer:
        assert '"name":"arm"' in answer.read().decode()


def test_a_spec_with_errors_is_served_without_a_robot(folder: Path):
    (folder / "arm.robot.yaml").write_text(SPEC.replace("sphere", "spere"))
    viewer = Viewer("arm.robot.yaml", cwd=folder)
    viewer.wait_for("there is no robot to show yet", WATCHING)
    with urllib.request.urlopen(viewer.url) as answer:
        assert '"links":[]' in answer.read().decode()
    assert viewer.interrupt() == 130
    viewer.close()


@pytest.mark.parametrize(
    ("words", "environment", "is_opened"),
    [
        ((), {"DISPLAY": ":0"}, True),
        ((), {"WAYLAND_DISPLAY": "wayland-0"}, True),
        ((), {"BROWSER": "firefox"}, True),
        ((), {}, False),
        (("--no-browser",), {"DISPLAY": ":0"}, False),
    ],
)
@pytest.mark.skipif(sys.platform in {"win32", "darwin"}, reason="they always have windows")
def test_the_browser_is_opened_where_it_has_a_window(
    words: tuple[str, ...],
    environment: dict[str, str],
    is_opened: bool,
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
):
    for name in ("BROWSER", "DISPLAY", "WAYLAND_DISPLAY", "WSL_DISTRO_NAME"):
        monkeypatch.delenv(name, raising=False)
    opened = Queue[str]()
    monkeypatch.setattr(webbrowser, "open", opened.put)
    monkeypatch.setattr(Session, "pause", _interrupt)
    result = linkforge(
        "view", "arm.robot.yaml", *words, cwd=folder, SSH_CONNECTION="10.0.0.1 5 10.0.0.2 22", **environment
    )
    assert result.returncode == 130
    url = result.stdout.strip()
    assert ([opened.get(timeout=20)] if is_opened else []) == ([url] if is_opened else [])
    assert opened.empty()
    port = urlsplit(url).port
    assert f"over ssh, first run on your machine: ssh -L {port}:127.0.0.1:{port} 10.0.0.2\n" in result.stderr


def _interrupt(_session: Session, _seconds: float) -> None:
    raise KeyboardInterrupt


def test_a_missing_spec_is_the_usual_error(folder: Path):
    result = linkforge("view", "arn.robot.yaml", cwd=folder)
    assert (result.returncode, result.stderr) == (1, "error: there is no file 'arn.robot.yaml' [LF3001]\n")


def test_a_port_that_is_not_free_is_wrong_usage(folder: Path):
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = str(other.getsockname()[1])
        result = linkforge("view", "arm.robot.yaml", "--port", port, "--no-browser", cwd=folder)
    assert result.returncode == 2
    assert f"--port {port}: Address already in use; omit it to use any free port" in result.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("-",), "takes a file, not standard input"),
        (("arm.robot.yaml", "--port", "65536"), "takes a whole number from 0 to 65535, found '65536'"),
        (("arm.robot.yaml", "--format", "html"), "--format is about a file; add -o FILE.html"),
        (("arm.robot.yaml", "--port", "1", "-o", "a.html"), "--port is about the page in a browser"),
        (("arm.robot.yaml", "--pose", "arm/home", "--no-browser"), "the robot has no state 'arm/home'"),
    ],
)
def test_wrong_usage_is_refused(words: tuple[str, ...], message: str, folder: Path):
    result = linkforge("view", *words, cwd=folder)
    assert result.returncode == 2
    assert message in result.stderr
