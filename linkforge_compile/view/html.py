"""The page with a scene inside: one HTML text, which works from disk and without a network."""

from __future__ import annotations

import json
from base64 import b64encode
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkforge_compile.view.files import RobotFiles
    from linkforge_compile.view.scene import Scene

_PLACE = '<script id="scene" type="application/json">{}</script>'
_HEAD = "<head>"

_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src {0}; connect-src {0}; "
    "base-uri 'none'; form-action 'none'"
)
"""What the page may load; a mesh can name textures on any machine."""

# In a script, `</script>` ends it and `<!--` begins a comment.
_ESCAPES = str.maketrans({character: f"\\u{ord(character):04x}" for character in "<>&"})


class NoPageError(Exception):
    """The page of the viewer was not built."""


def page_file() -> Path:
    """Return the built page, which a wheel has, and a checkout after `npm run build`."""
    return Path(__file__).parent / "page" / "out" / "view.html"


def html_of(scene: Scene, files: RobotFiles | None) -> str:
    """Return the page with a scene and the content of files; for None, the page asks its server for them.

    Raises:
        NoPageError: The page was not built.

    """
    if files:
        content = {digest: b64encode(file.content).decode() for digest, file in files.files.items()}
        scene = {**scene, "files": {digest: {**one, "data": content[digest]} for digest, one in scene["files"].items()}}
    text = json.dumps(scene, separators=(",", ":")).translate(_ESCAPES)
    policy = _POLICY.format("data: blob:" if files else "'self' data: blob:")
    before, place, after = _page().partition(_PLACE.format("null"))
    before = before.replace(_HEAD, f'{_HEAD}\n<meta http-equiv="Content-Security-Policy" content="{policy}">', 1)
    assert place, f"{page_file()} has a place for the scene"
    return f"{before}{_PLACE.format(text)}{after}"


def _page() -> str:
    try:
        return page_file().read_text("utf-8")
    except FileNotFoundError as error:
        way_out = f"run 'npm ci --ignore-scripts && npm run build' in {page_file().parents[1]}"
        raise NoPageError(f"the page of the viewer is not built; {way_out}") from error
