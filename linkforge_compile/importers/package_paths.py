"""Write paths that `$(find PACKAGE)` of a xacro made as expressions, `$(path('package://PACKAGE/...'))`.

Such a path is one of this machine; the expression is computed on each.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

_PATH = r"(?>[\w.+/-]*\w)(?!'\w)"
"""A path in a text with other words."""
_WHOLE_PATH = r"""(?:(?![ ][-/])[^,;:|"'<>\n$()\\])*[^,;:|"'<>\s$()/\\](?=\s*(?:\Z|["<]))|""" + _PATH
"""A path that may be a whole value, and contain blanks then."""


class FoundPackage(NamedTuple):
    """A package that xacro was given the folder of; `near` is that of the same name for a spec, None for none."""

    name: str
    near: Path | None

    @property
    def is_near(self) -> bool:
        return self.near is not None


class PackagePaths:
    """The folders of packages in texts, by their paths; `is_there` tells whether another copy has a file."""

    def __init__(self, packages: Mapping[str, FoundPackage], is_there: Callable[[Path], bool]) -> None:
        self._packages, self._is_there = packages, is_there
        folders = "|".join(map(re.escape, sorted(packages, key=len, reverse=True)))
        begin = r"""(?:(?P<whole>(?<=file://)|(?<=[">])|\A)|(?<![\w./-]))"""
        self._paths = re.compile(rf"{begin}(?P<folder>{folders})/(?P<path>(?(whole)(?:{_WHOLE_PATH})|{_PATH}))")
        self._folders = re.compile(rf"(?:(?<=file://)|(?<![\w./-]))(?P<folder>{folders})(?![\w-]|\.\w)")

    def in_expressions(self, text: str) -> tuple[str, FoundPackage | None]:
        """Return a text with expressions for its paths, and the first package whose folder is still in it."""
        if not self._packages:
            return text, None
        written = self._paths.sub(self._expression, text)
        left = self._folders.search(written)
        return written, self._packages[left["folder"]] if left else None

    def _finds_file(self, found: re.Match[str]) -> bool:
        """Whether a spec finds the file by the name of its package, perhaps in the sources of an installed one."""
        near = self._packages[found["folder"]].near
        if near is None or str(near) == found["folder"]:
            return near is not None
        return self._is_there(near / found["path"])

    def _expression(self, found: re.Match[str]) -> str:
        package, path = self._packages[found["folder"]], found["path"]
        is_kept = self._finds_file(found) and posixpath.normpath(path) == path
        return f"$(path('package://{package.name}/{path}'))" if is_kept else found[0]


NO_PACKAGE_PATHS = PackagePaths({}, lambda _: False)
