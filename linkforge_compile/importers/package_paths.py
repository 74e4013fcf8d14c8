"""Write paths that `$(find PACKAGE)` of a xacro made as expressions, `$(path('package://PACKAGE/...'))`.

Such a path is one of this machine; the expression is computed on each.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Mapping
from typing import NamedTuple

_PATH = r"(?>[\w.+/-]*\w)(?!'\w)"
"""A path in a text with other words."""
_WHOLE_PATH = r"""(?:(?![ ][-/])[^,;:|"'<>\n$()])*[^,;:|"'<>\s$()/](?=\s*(?:\Z|["<]))|""" + _PATH
"""A path that may be a whole value, and contain blanks then."""


class FoundPackage(NamedTuple):
    """A package that xacro was given the folder of; `is_near` if a spec finds the same one by its name."""

    name: str
    is_near: bool


class PackagePaths:
    """The folders of packages in texts, by their paths."""

    def __init__(self, packages: Mapping[str, FoundPackage]) -> None:
        self._packages = packages
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

    def _expression(self, found: re.Match[str]) -> str:
        package, path = self._packages[found["folder"]], found["path"]
        is_kept = package.is_near and posixpath.normpath(path) == path
        return f"$(path('package://{package.name}/{path}'))" if is_kept else found[0]


NO_PACKAGE_PATHS = PackagePaths({})
