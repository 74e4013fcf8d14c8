"""A file as one with all that it includes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from linkforge_compile.expand.paths import follow
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlMap


class Whole(NamedTuple):
    """A file with all that it includes laid into it.

    `ways` are the included files, each with the paths that lead to it: as the file itself writes the first, as
    the file at that path writes the second, and so on. Where one could not be had, `include` of the tree is a
    YamlFault: anything may stand in it.
    """

    file: SourceFile
    tree: YamlMap
    ways: Mapping[SourceFile, tuple[str, ...]] = MappingProxyType({})


def reached(folder: Path, way: tuple[str, ...]) -> Path:
    """Return where a way of includes leads that begins in a folder."""
    path = folder
    for step in way:
        path = follow(folder, step)
        folder = path.parent
    return path
