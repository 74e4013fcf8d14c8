"""Finds schemas/, templates/ and the manual: inside the package in a wheel, in the repository in a checkout."""

from __future__ import annotations

from functools import cache
from pathlib import Path


@cache
def data_folder() -> Path:
    """Return the folder that holds `schemas` and `templates`."""
    return _packed() if _packed().is_dir() else _packed().parents[1]


def schemas_folder() -> Path:
    return data_folder() / "schemas"


def linked_schema_file() -> Path:
    """Return the file of all schemas as one, which is made when a wheel is built; a checkout has none."""
    return _packed() / "linked_schema.json"


def templates_folder() -> Path:
    return data_folder() / "templates"


def compiled_templates_folder() -> Path:
    """Return the folder of the templates that were compiled when the wheel was built; a checkout has none."""
    return _packed() / "compiled_templates"


def compiler_files() -> tuple[Path, ...]:
    """Return what of linkforge itself its output depends on: the templates, and the version, which an update renews."""
    templates = (path for format_ in ("srdf", "urdf") for path in sorted((templates_folder() / format_).rglob("*.j2")))
    return (*templates, Path(__file__).with_name("_version.py"))


def manual_folder() -> Path:
    """Return the folder with one page a diagnostic, LF4102.md; in a checkout it is among the docs."""
    return _packed() / "diagnostics" if _packed().is_dir() else data_folder() / "docs" / "diagnostics"


def matcher_file() -> Path:
    """Return the problem matcher, which GitHub's own tools expect under `.github` in a repository."""
    name = "linkforge-matcher.json"
    return _packed() / name if _packed().is_dir() else data_folder() / ".github" / name


def _packed() -> Path:
    return Path(__file__).parent / "_data"
