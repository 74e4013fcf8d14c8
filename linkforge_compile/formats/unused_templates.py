"""Finds files that stand where a user's templates go before ours, and that nothing uses."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from jinja2 import TemplateError
from jinja2.loaders import split_template_path
from jinja2.meta import find_referenced_templates

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.formats import UNUSED_TEMPLATE
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.formats.sandbox import FolderEnvironment
from linkforge_compile.formats.template_loader import FolderLoader, OutsideError, UnreadableError
from linkforge_compile.source import SourceFile

_MOST_FILES = 1000
"""Files of a folder that are looked at."""


def find_unused(environment: FolderEnvironment, loader: FolderLoader, ours: frozenset[str]) -> Iterator[Diagnostic]:
    """Yield a warning at each file that replaces none of our templates, and that no template includes.

    `ours` are the paths of the packaged templates. Yields none where the name of an included template is computed.
    """
    found = {
        path.relative_to(loader.folder).as_posix(): path
        for place in sorted({name.partition("/")[0] for name in ours}, reverse=True)
        for path in sorted(islice((loader.folder / place).rglob("*"), _MOST_FILES))
        if path.is_file()
    }
    strange = {name: path for name, path in found.items() if name not in ours and _is_template(name, ours)}
    used = _included(environment, loader) if strange else set()
    for name, path in strange.items():
        if None not in used and name not in used:
            place = SourceFile(str(path), "", path).whole
            yield UNUSED_TEMPLATE.at(place, name=name, near=ours)


def _is_template(name: str, ours: frozenset[str]) -> bool:
    return name.endswith(".j2") or nearest(name, ours) is not None


def _included(environment: FolderEnvironment, loader: FolderLoader) -> set[str | None]:
    """Return the names of all templates that those of the folder include; None for one that is computed."""
    used: set[str | None] = set()
    for path in islice(loader.folder.rglob("*.j2"), _MOST_FILES):
        try:
            included = find_referenced_templates(environment.parse(loader.read(path)))
            used |= {name and "/".join(split_template_path(name)) for name in included}
        except (OutsideError, UnreadableError, TemplateError):
            continue  # nothing that was rendered uses it
    return used
