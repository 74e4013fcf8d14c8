"""Folders of the two robots of `linkforge diff`: where one has a copy or another version, paths in it are the same."""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.diff_sides import Side
from linkforge_compile.paths import packages_in_environment
from linkforge_compile.roots import as_walked

if TYPE_CHECKING:
    from linkforge_compile.core import Robot


def in_common_folders(sides: Sequence[Side], robots: tuple[Robot, Robot], arguments: Namespace) -> tuple[Robot, Robot]:
    """Return the robots with the same absolute path for a file that both have, in a revision or in a package.

    That is its path for the robot after, with links resolved. The content of files is not compared.
    """
    from linkforge_compile.compare import with_folders

    before, after = sides
    packages_after, packages_before = after.all_packages(arguments), before.all_packages(arguments)
    real = {name: os.path.realpath(folder) for name, folder in packages_after.items()}
    are = {path: real[name] for name, folder in packages_after.items() for path in _spellings(folder)}
    common = {name: folder for name, folder in packages_before.items() if name in real}
    were = {path: real[name] for name, folder in common.items() for path in _spellings(folder)}
    if before.tree is not None:
        top, installed = before.tree.top, packages_in_environment()
        # A text may have the path of a link to the repository, and that of an installed package.
        were |= {str(before.tree.copy): str(top)}
        are |= {str(folder): str(top) for folder in Path(after.file).absolute().parents if _is_same(folder, top)}
        are |= {
            str(installed[name]): str(top / copy.relative_to(before.tree.copy))
            for name, copy in before.tree.packages().items()
        }
    return with_folders(robots[0], were), with_folders(robots[1], are)


def _spellings(folder: str) -> Iterator[str]:
    """Yield the paths that a text may have for the folder of a package."""
    absolute = Path(folder).absolute()
    yield from map(str, (absolute, as_walked(absolute), os.path.realpath(folder)))


def _is_same(folder: Path, other: Path) -> bool:
    return os.path.realpath(folder) == str(other)
