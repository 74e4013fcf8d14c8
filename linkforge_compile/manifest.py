"""Read the name of a ROS package from its package.xml."""

from __future__ import annotations

import re
from pathlib import Path

from linkforge_compile.roots import ANYWHERE, Roots, is_file

# The file may be hostile: this pattern does not backtrack.
_NAME = re.compile(r"<name>([^<]*)</name>")
_MAX_BYTES = 1024 * 1024


def package_name(folder: Path, roots: Roots = ANYWHERE) -> str | None:
    """Return the name in a folder's package.xml; None if there is none, or it is a link that leaves the roots.

    It is searched as text, because one tag does not justify parsing untrusted XML with its entities.
    """
    manifest = folder / "package.xml"
    if roots.are_left_by(manifest) or not is_file(manifest):  # reading a pipe would block
        return None
    try:
        with manifest.open("rb") as stream:
            text = stream.read(_MAX_BYTES).decode("utf-8", errors="replace")
    except OSError:
        return None
    first, *rest = text.split("<!--")
    match = _NAME.search("".join((first, *(piece.partition("-->")[2] for piece in rest))))
    return match[1].strip() if match else None
