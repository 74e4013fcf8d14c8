"""What a page may load: nothing but what it contains, and what its server has."""

from __future__ import annotations

from base64 import b64encode
from hashlib import sha256
from html.parser import HTMLParser


class _Scripts(HTMLParser):
    """Finds the scripts that are in a page; data in elements of the same name is none."""

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
    """Return the policy with which a page may use what it contains, and its server if it has one, and nothing else.

    Without it, a mesh could name a texture on any machine.
    """
    # By their hashes: text of a robot that got into the page as a script would not run.
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
