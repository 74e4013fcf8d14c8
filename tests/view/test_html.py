"""The page with a scene inside: nothing of a name ends the script, and nothing is loaded from elsewhere."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from linkforge_compile.core.models.geometry import Box, Mesh, Vector3
from linkforge_compile.core.models.link import Link, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.view import html
from linkforge_compile.view.files import File, RobotFiles
from linkforge_compile.view.html import NoPageError, html_of
from linkforge_compile.view.scene import make_scene

NASTY = "</script><script>alert(1)</script><!-- <script> & \u2028 \ud800 '\""
PAGE = """<!doctype html>
<html>
<head>
<meta charset="utf-8">
</head>
<body>
<script id="scene" type="application/json">null</script>
<script>start()</script>
</body>
</html>
"""


@pytest.fixture
def small_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    page = tmp_path / "page" / "out" / "view.html"
    page.parent.mkdir(parents=True)
    page.write_text(PAGE, "utf-8")
    monkeypatch.setattr(html, "view_page_file", lambda: page)
    return page


class Scripts(HTMLParser):
    """The texts of the scripts of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[str] = []
        self.inside = False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.inside = tag == "script"
        if self.inside:
            self.found.append("")

    def handle_endtag(self, tag):
        self.inside = False

    def handle_data(self, data):
        if self.inside:
            self.found[-1] += data


def nasty_robot() -> tuple[Robot, RobotFiles]:
    link = Link("a", visuals=[Visual(Box(Vector3(1, 1, 1)), name=NASTY), Visual(Mesh(NASTY), name="m")])
    return Robot("r", links=[link]), RobotFiles({"d": File(NASTY, "stl", b"\0\xff", {NASTY: "d"})}, {NASTY: "d"})


@pytest.mark.usefixtures("small_page")
def test_no_name_ends_the_script():
    robot, files = nasty_robot()
    scene, program = Scripts(html_of(make_scene(robot, files), files)).found
    assert program == "start()"
    assert not set("<>&") & set(scene)
    shown = json.loads(scene)
    box, mesh = shown["links"][0]["visuals"]
    assert (box["name"], mesh["file"]) == (NASTY, "d")
    assert shown["files"]["d"] == {"name": NASTY, "kind": "stl", "size": 2, "uses": {NASTY: "d"}, "data": "AP8="}


@pytest.mark.usefixtures("small_page")
def test_a_page_from_disk_runs_its_own_scripts_and_loads_nothing():
    robot, files = nasty_robot()
    scene = make_scene(robot, files)
    text = html_of(scene, files, last="<script>end()</script>")
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="(.*?)"', text)
    # echo -n 'start()' | openssl dgst -sha256 -binary | base64, and the same of 'end()'
    hashes = (
        "'sha256-DIm7WJS6ZKDYe5qFLPy+h4JFI9Bol5QmYC57mt3Fb00=' 'sha256-2VOP+ZDnztWSWeD2tqXN/Gm8M2oWchEgb497RXO7xjQ='"
    )
    assert policy.startswith(f"default-src 'none'; script-src {hashes}; ")
    assert "'self'" not in policy
    assert text.endswith("<script>end()</script></body>\n</html>\n")
    live = html_of(scene, None)
    assert '"data"' not in live
    assert "Content-Security-Policy" not in live, "the server sends it"


def test_a_page_that_is_not_built_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(html, "view_page_file", lambda: tmp_path / "page" / "out" / "view.html")
    robot, files = nasty_robot()
    with pytest.raises(NoPageError, match=r"not built; run 'npm ci --ignore-scripts && npm run build' in .*page$"):
        html_of(make_scene(robot, files), files)


def test_the_built_page_holds_the_scene_once(page: Path):
    robot, files = nasty_robot()
    text = html_of(make_scene(robot, files), files)
    assert page.read_text("utf-8").count('<script id="scene" type="application/json">') == 1
    assert json.loads(Scripts(text).found[0])["name"] == "r"
