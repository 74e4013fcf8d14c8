"""Write paths that `$(find PACKAGE)` of a xacro made as expressions, `$(path('package://PACKAGE/...'))`.

Such a path is one of this machine; the expression is computed on each.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.roots import Roots, exists


class FoundPackage(NamedTuple):
    """A package that xacro was given the folder of; `near` is that of the same name for a spec, None for none."""

    name: str
    near: Path | None


class PackagePaths:
    """The folders of packages in texts, by their paths; another copy of a package is searched within `roots`."""

    def __init__(self, packages: Mapping[str, FoundPackage], roots: Roots) -> None:
        self._packages, self._roots = packages, roots
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
        far = (self._packages[match["folder"]] for match in self._pattern.finditer(text) if not self._is_near(match))
        return self._pattern.sub(self._expression, text), next((package.name for package in far), None)

    def _is_near(self, found: re.Match[str]) -> bool:
        """Whether a spec finds the file by the name of its package, perhaps in the sources of an installed one."""
        near = self._packages[found["folder"]].near
        if near is None or str(near) == found["folder"]:
            return near is not None
        file = near / found["path"]
        return self._roots.hold(file) and exists(file)

    def _expression(self, found: re.Match[str]) -> str:
        name = self._packages[found["folder"]].name
        return f"$(path('package://{name}/{found['path']}'))" if self._is_near(found) else found[0]


NO_PACKAGE_PATHS = PackagePaths({}, Roots())
