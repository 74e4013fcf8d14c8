"""Pictures of robots, drawn by a real browser: what is where, and what has an effect."""

import io
import os
import sys
import threading
from collections.abc import Sequence
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import numpy as np
import pytest

from linkforge_compile import compile_text
from linkforge_compile.view import picture
from linkforge_compile.view.files import collect_files
from linkforge_compile.view.html import html_of
from linkforge_compile.view.picture import WAIT, PictureError, Size, draw_picture, find_browser
from linkforge_compile.view.scene import SceneView, make_scene

Image = pytest.importorskip("PIL.Image")

SIZE = Size(320, 240)

BOXES = """\
linkforge: 1
name: boxes
links:
  base: {visual: {box: [0.1, 0.1, 0.1], material: {name: grey, color: [0.5, 0.5, 0.5]}}}
  red: {visual: {box: [0.4, 0.4, 0.4], material: {name: red, color: [1, 0, 0]}}}
  blue: {visual: {box: [0.4, 0.4, 0.4], material: {name: blue, color: [0, 0, 1]}}}
joints:
  left: {type: fixed, parent: base, child: red, origin: [0, -1, 0]}
  turn: {type: continuous, parent: base, child: arm, axis: z}
  right: {type: fixed, parent: arm, child: blue, origin: [0, 1, 0]}
"""
BOXES = BOXES.replace("links:\n", "links:\n  arm: {}\n")


@pytest.fixture
def page_of(page: Path):
    """Return a function from the view of the boxes to their page."""

    def made(last: str = WAIT, **view: object) -> str:
        robot = compile_text(BOXES).result()
        files = collect_files(robot)
        whole: SceneView = {"panels": False, "camera": {"azimuth": 0, "elevation": 0}, "layers": ["visuals"], **view}
        return html_of(make_scene(robot, files, whole), files, last=last)

    return made


def pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def middle_of(image: np.ndarray, channel: int) -> tuple[float, float]:
    """Return the middle of the pixels of one color, in x and y."""
    others = [each for each in range(3) if each != channel]
    is_of_color = (image[:, :, channel] > 60) & (image[:, :, others] < 40).all(axis=2)
    assert is_of_color.any(), f"nothing is in color {channel}"
    ys, xs = np.nonzero(is_of_color)
    return float(xs.mean()), float(ys.mean())


def test_a_red_box_is_left_of_a_blue_one(page_of, browser: Sequence[str]):
    html = page_of()
    first = draw_picture(html, SIZE, browser).png
    image = pixels(first)
    assert image.shape == (SIZE.height, SIZE.width, 3)
    red, blue = middle_of(image, 0), middle_of(image, 2)
    # From the front, x points to the eye and y to the right.
    assert red[0] < SIZE.width / 2 < blue[0]
    assert red[0] + blue[0] == pytest.approx(SIZE.width, abs=4)
    assert red[1] == pytest.approx(SIZE.height / 2, abs=4)
    assert draw_picture(html, SIZE, browser).png == first


def test_the_camera_and_the_pose_have_effect(page_of, browser: Sequence[str]):
    behind = pixels(draw_picture(page_of(camera={"azimuth": 180, "elevation": 0}), SIZE, browser).png)
    assert middle_of(behind, 0)[0] > middle_of(behind, 2)[0]
    turned = pixels(draw_picture(page_of(pose={"turn": np.pi}), SIZE, browser).png)
    assert middle_of(turned, 2)[0] < SIZE.width / 2
    far = pixels(draw_picture(page_of(camera={"azimuth": 0, "elevation": 0, "distance": 20}), SIZE, browser).png)
    assert abs(middle_of(far, 0)[0] - SIZE.width / 2) < 40
    above = pixels(draw_picture(page_of(camera={"azimuth": -90, "elevation": 60}), SIZE, browser).png)
    assert middle_of(above, 0)[1] > middle_of(above, 2)[1]


class _Recorder(BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        self.server.paths.append(self.path)
        self.send_response(404)
        self.end_headers()

    def log_message(self, *_: object) -> None:
        pass


def test_a_page_asks_no_other_machine(page_of, browser: Sequence[str], monkeypatch: pytest.MonkeyPatch):
    server = ThreadingHTTPServer(("127.0.0.1", 0), _Recorder)
    server.paths = []
    threading.Thread(target=server.serve_forever, daemon=True).start()
    # Without the option that resolves no name, the policy of the page alone is tested.
    monkeypatch.setattr(picture, "_OPTIONS", tuple(one for one in picture._OPTIONS if "resolver" not in one))
    url = f"http://127.0.0.1:{server.server_port}"
    ask = f"<script>fetch('{url}/fetch').catch(() => 0); new Image().src = '{url}/image'</script><img src={url}/img>"
    # As if the page itself asked, so that the policy lets its script run.
    html = page_of(last=f"{ask}{WAIT}")
    # A script that a name of the robot brings does not run.
    html = html.replace(WAIT, f"{WAIT}<script>document.write('<img src={url}/script>')</script><b onclick=x>")
    draw_picture(html, SIZE, browser)
    assert server.paths == []
    draw_picture(html.replace("Content-Security-Policy", "X"), SIZE, browser)
    server.shutdown()
    server.server_close()
    assert {"/fetch", "/image", "/img", "/script"} <= set(server.paths)


def test_a_fault_of_the_page_is_the_reason(browser: Sequence[str]):
    html = "<script>linkforge = {ready: Promise.reject(Error('a mesh is broken'))}</script>"
    with pytest.raises(PictureError, match="drew no picture: Error: a mesh is broken"):
        draw_picture(f"<html><body>{html}{WAIT}</body></html>", SIZE, browser)
    with pytest.raises(PictureError, match="the page did not start"):
        draw_picture(f"<html><body>{WAIT}</body></html>", SIZE, browser)


def test_a_page_that_is_never_ready_has_a_time_limit(browser: Sequence[str]):
    html = f"<html><body><script>linkforge = {{ready: new Promise(() => 0)}}</script>{WAIT}</body></html>"
    with pytest.raises(PictureError, match="did not draw the picture within 3 s"):
        draw_picture(html, SIZE, browser, time_limit=3)


def test_no_browser_is_a_message_with_the_names(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv(picture.VARIABLE, raising=False)
    monkeypatch.setattr(picture, "_usual_places", lambda: ())
    with pytest.raises(PictureError, match=r"google-chrome, .*chromium, .*msedge.*LINKFORGE_BROWSER"):
        find_browser()


@pytest.mark.skipif(sys.platform == "win32", reason="programs of Windows have endings")
def test_the_environment_names_the_browser(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    program = tmp_path / "my browser"
    program.write_text("#!/bin/sh\n", "utf-8")
    program.chmod(0o755)
    monkeypatch.setenv(picture.VARIABLE, str(program))
    assert find_browser() == [str(program)]
    monkeypatch.setenv(picture.VARIABLE, f"'{program}' --no-sandbox")
    assert find_browser() == [str(program), "--no-sandbox"]
    monkeypatch.setenv(picture.VARIABLE, "no-such-browser")
    with pytest.raises(PictureError, match="no program 'no-such-browser', which LINKFORGE_BROWSER names"):
        find_browser()


@pytest.mark.skipif(sys.platform == "win32", reason="a script of a shell")
def test_a_program_that_is_no_browser_is_reported(tmp_path: Path):
    program = tmp_path / "chromium"
    program.write_text("#!/bin/sh\necho cannot open display >&2\n", "utf-8")
    program.chmod(0o755)
    with pytest.raises(PictureError, match="chromium drew no picture: cannot open display"):
        draw_picture("<html><body></body></html>", SIZE, [str(program)])


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="there are no users")
def test_only_root_has_no_sandbox(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert list(picture._sandbox()) == []
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    assert list(picture._sandbox()) == ["--no-sandbox"]
