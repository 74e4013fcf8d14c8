"""Write paths that `$(find PACKAGE)` of a xacro made as expressions, `$(path('package://PACKAGE/...'))`.

Such a path is one of this machine; the expression is computed on each.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple


class FoundPackage(NamedTuple):
    """A package that xacro was given the folder of; `is_near` if a spec finds the same one by its name."""

    name: str
    is_near: bool


class PackagePaths:
    """The folders of packages in texts, by their paths."""

    def __init__(self, packages: Mapping[str, FoundPackage]) -> None:
        self._packages = packages
        folders = "|".join(map(re.escape, sorted(packages, key=len, reverse=True)))
        self._pattern = (
            re.compile(rf"(?:(?<=file://)|(?<![\w./-]))(?P<folder>{folders})/(?P<path>[\w.+/-]*\w)")
            if folders
            else None
        )

    def in_expressions(self, text: str) -> tuple[str, str | None]:
        """Return a text with expressions for its paths, and the first package that the spec would not find."""
        if self._pattern is None:
            return text, None
        found = [self._packages[match["folder"]] for match in self._pattern.finditer(text)]
        far = next((package.name for package in found if not package.is_near), None)
        return self._pattern.sub(self._expression, text), far

    def _expression(self, found: re.Match[str]) -> str:
        package = self._packages[found["folder"]]
        return f"$(path('package://{package.name}/{found['path']}'))" if package.is_near else found[0]


NO_PACKAGE_PATHS = PackagePaths({})
