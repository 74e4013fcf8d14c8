"""Paths of the data files: inside the package in an installed wheel, in the repository in a checkout."""

from __future__ import annotations

from collections.abc import Collection
from functools import cache
from pathlib import Path

OF_COMMANDS = ("init", "overview")
"""The folders of templates for commands other than `compile`."""


@cache
def data_folder() -> Path:
    """Return the folder that holds `schemas` and `templates`."""
    return _packed() if _packed().is_dir() else _packed().parents[1]


def schemas_folder() -> Path:
    return data_folder() / "schemas"


def linked_schema_file() -> Path:
    """Return the file with all schemas in one, which building a wheel creates; a checkout has none."""
    return _packed() / "linked_schema.json"


def templates_folder() -> Path:
    return data_folder() / "templates"


def format_templates(formats: Collection[str] = ()) -> list[Path]:
    """Return the templates of formats, sorted, those of all for none: all but those of other commands."""
    folder = templates_folder()
    by_format = ((path.relative_to(folder).parts[0], path) for path in sorted(folder.rglob("*.j2")))
    return [path for name, path in by_format if (name in formats if formats else name not in OF_COMMANDS)]


def compiled_templates_folder() -> Path:
    """Return the folder of compiled templates, which building a wheel creates; a checkout has none."""
    return _packed() / "compiled_templates"


def compiler_files(formats: Collection[str] = ()) -> tuple[Path, ...]:
    """Return the files of linkforge on which its output depends: the templates of formats and the version."""
    return (*format_templates(formats), Path(__file__).with_name("_version.py"))


def manual_folder() -> Path:
    """Return the folder with a page for each diagnostic code, such as LF4102.md."""
    return _packed() / "diagnostics" if _packed().is_dir() else data_folder() / "docs" / "diagnostics"


def view_page_file() -> Path:
    """Return the page of the viewer; a checkout has one once npm has built it."""
    name = "view.html"
    return _packed() / name if _packed().is_dir() else Path(__file__).parent / "view" / "page" / "out" / name


def matcher_file() -> Path:
    """Return the problem matcher of GitHub Actions."""
    name = "linkforge-matcher.json"
    return _packed() / name if _packed().is_dir() else data_folder() / ".github" / name


def _packed() -> Path:
    return Path(__file__).resolve().parent / "_data"  # colcon links the package into its build folder
