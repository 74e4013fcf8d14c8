"""The name of a package of ROS, as the package.xml in its folder says it."""

from __future__ import annotations

import re
from pathlib import Path

from linkforge_compile.roots import ANYWHERE, Roots, is_file

# A stranger wrote what it is searched in: no character is tried twice.
_NAME = re.compile(r"<name>([^<]*)</name>")
_MOST_BYTES = 1024 * 1024


def package_name(folder: Path, roots: Roots = ANYWHERE) -> str | None:
    """Return the name in a folder's package.xml, None where there is none, or a link that leads out of the roots.

    Read as text: one tag of a file that strangers wrote is not worth an XML parser and its entities.
    """
    manifest = folder / "package.xml"
    if roots.are_left_by(manifest) or not is_file(manifest):  # a pipe of that name would make us wait
        return None
    try:
        with manifest.open("rb") as stream:
            text = stream.read(_MOST_BYTES).decode("utf-8", errors="replace")
    except OSError:
        return None
    first, *behind = text.split("<!--")
    match = _NAME.search("".join((first, *(piece.partition("-->")[2] for piece in behind))))
    return match[1].strip() if match else None
