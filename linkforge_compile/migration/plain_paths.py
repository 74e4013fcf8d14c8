"""Write absolute paths of a robot without `a/..`: those of two working folders lead to the same files."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

from linkforge_compile.compare import with_texts
from linkforge_compile.core import Robot
from linkforge_compile.paths import follow

_CLIMBING = re.compile(r"""(?:(?<=file://)|(?<![\w./-]))/(?!/)(?:[^"'<>\n]*/)?\.\.(?![^/"'<>\s])""")
"""An absolute path up to its last `..`; a folder may have spaces in its name."""


def with_plain_paths(robot: Robot) -> Robot:
    """Return a robot in which absolute paths have no `a/..`, unless `a` is a symbolic link.

    Only fields that are compared are complete in the result.
    """
    return with_texts(robot, partial(_CLIMBING.sub, _plain))


def _plain(path: re.Match[str]) -> str:
    return follow(Path("/"), path[0]).as_posix().rstrip("/")
