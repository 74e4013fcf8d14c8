"""The page with its scene: one HTML text, which works from disk and without a network."""

from __future__ import annotations

import json
from base64 import b64encode
from hashlib import sha256
from html.parser import HTMLParser
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.resources import view_page_file

if TYPE_CHECKING:
    from linkforge_compile.view.files import RobotFiles
    from linkforge_compile.view.scene import Scene


class _Scripts(HTMLParser):
    """Collect the scripts of a page; a `<script>` with JSON data is not a script."""

    def __init__(self) -> None:
        super().__init__()
        self.texts: list[str] = []
        self._is_inside = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._is_inside = tag == "script" and dict(attrs).get("type") != "application/json"
        if self._is_inside:
            self.texts.append("")

    def handle_data(self, data: str) -> None:
        if self._is_inside:
            self.texts[-1] += data

    def handle_endtag(self, tag: str) -> None:
        self._is_inside = False


def content_security_policy(page: str, *, has_server: bool) -> str:
    """Return the policy that limits a page to what it contains, and to its server if it has one.

    Without it, a mesh could name a texture on any machine.
    """
    # Only scripts with these hashes run, so a script that got into the page from the text of a robot would not.
    parser = _Scripts()
    parser.feed(page)
    hashes = (b64encode(sha256(script.encode()).digest()).decode() for script in parser.texts)
    scripts = " ".join(f"'sha256-{one}'" for one in hashes)
    own = "'self' " if has_server else ""
    return "; ".join(
        (
            "default-src 'none'",
            f"script-src {scripts}".rstrip(),
            "style-src 'unsafe-inline'",
            "img-src data: blob:",
            f"connect-src {own}data: blob:",
            "base-uri 'none'",
            "form-action 'none'",
            *(["frame-ancestors 'none'"] if has_server else []),  # which is for headers alone
        )
    )


_PLACE = '<script id="scene" type="application/json">{}</script>'
_HEAD, _END = "<head>", "</body>\n</html>"

# In a script, `</script>` ends it and `<!--` begins a comment.
_ESCAPES = str.maketrans({character: f"\\u{ord(character):04x}" for character in "<>&"})


class NoPageError(Exception):
    """The page of the viewer was not built."""


def html_of(scene: Scene, files: RobotFiles | None, *, last: str = "") -> str:
    """Return the page with a scene and the content of files; for None, the page asks its server for them.

    `last` is an element at the end of the page.

    Raises:
        NoPageError: The page was not built.

    """
    page = _page().replace(_END, f"{last}{_END}")
    if files:
        # A server sends the policy as a header.
        policy = content_security_policy(page, has_server=False)
        page = page.replace(_HEAD, f'{_HEAD}\n<meta http-equiv="Content-Security-Policy" content="{policy}">', 1)
        content = {digest: b64encode(file.content).decode() for digest, file in files.files.items()}
        scene = {**scene, "files": {digest: {**one, "data": content[digest]} for digest, one in scene["files"].items()}}
    text = json.dumps(scene, separators=(",", ":")).translate(_ESCAPES)
    before, place, after = page.partition(_PLACE.format("null"))
    assert place, f"{view_page_file()} has a place for the scene"
    return f"{before}{_PLACE.format(text)}{after}"


def _page() -> str:
    try:
        return view_page_file().read_text("utf-8")
    except FileNotFoundError as error:
        way_out = f"run 'npm ci --ignore-scripts && npm run build' in {Path(__file__).parent / 'page'}"
        raise NoPageError(f"the page of the viewer is not built; {way_out}") from error
