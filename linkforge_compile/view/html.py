"""The page with a scene inside: one HTML text, which works from disk and without a network."""

from __future__ import annotations

import json
from base64 import b64encode
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.resources import view_page_file
from linkforge_compile.view.policy import content_security_policy

if TYPE_CHECKING:
    from linkforge_compile.view.files import RobotFiles
    from linkforge_compile.view.scene import Scene

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
