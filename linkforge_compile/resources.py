"""Finds schemas/ and templates/: inside the package in a wheel, at the top of the repository in a checkout."""

from __future__ import annotations

from functools import cache
from pathlib import Path


@cache
def data_folder() -> Path:
    """Return the folder that holds `schemas` and `templates`."""
    package = Path(__file__).parent
    packed = package / "_data"
    return packed if packed.is_dir() else package.parent


def schemas_folder() -> Path:
    return data_folder() / "schemas"


def templates_folder() -> Path:
    return data_folder() / "templates"
