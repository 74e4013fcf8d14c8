"""Rename a part, or a name of expressions, in all specs of a workspace that use it, or refuse with the reason.

A module's link is renamed in the module and, with its prefixes, in the specs that use it. The result is compiled before
it is offered: the robots may differ in the name of the part only.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path

from linkforge_compile.analysis import Analysis, Settings, analyse_path
from linkforge_compile.diagnostics.fix import Edit, apply_edits
from linkforge_compile.lsp.occurrences import Occurrences
from linkforge_compile.lsp.rename_proof import Compiled, prove
from linkforge_compile.lsp.renaming import RefusedError, Renaming, computed_name, find_renaming, places_by_file
from linkforge_compile.lsp.workspace import Document, find_users, is_part
from linkforge_compile.roots import identity
from linkforge_compile.source import Position, Span
from linkforge_compile.syntax import has_expression

_PLAIN_NAME = re.compile(r"[^\s'\"$(){}\[\],:#&*!|>%@`]+")
"""A name that YAML reads the same with and without quotes, wherever it is written."""

_EXPRESSION_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def rename(
    document: Document, at: Position, new: str, settings: Settings, folders: Collection[Path]
) -> tuple[Edit, ...] | None:
    """Return the edits that give the part at a position another name; None if there is no part.

    `folders` are those of the workspace, in which specs are that use the files to edit.

    Raises:
        RefusedError: it cannot be renamed, or the robots would differ in more than the name.

    """
    specs = _Specs(document, settings)
    while (target := find_renaming(document, at, [one.occurrences for one in specs.compiled])) is not None:
        span, renaming = target
        places = places_by_file(renaming)
        if not specs.add_users(places, folders):
            break
    else:
        return None
    local = _local_name(new, span.text or "", renaming)
    if renaming.is_of_expressions and not _EXPRESSION_NAME.fullmatch(local):
        raise RefusedError(f"'{local}' is not a name that expressions can use: use letters, digits and '_'")
    edits = {path: [Edit(place, local) for place in listed] for path, listed in places.items()}
    texts = {path: apply_edits(listed[0].span.file, listed) for path, listed in edits.items()}
    for one in specs.compiled:
        prove(one, renaming, local, texts, specs.defaults)
    return tuple(edit for listed in edits.values() for edit in listed)


class _Specs:
    """The specs that read the files to edit, each compiled with its defaults and with each of its variants."""

    def __init__(self, document: Document, settings: Settings) -> None:
        self._settings = settings
        self._searched = {identity(document.path)}  # the document comes with the specs that use it
        self.defaults: dict[str, Compiled] = {}
        """Each with its defaults, by its real path."""
        self.compiled: list[Compiled] = []
        for analysis in document.analyses:
            self._add(analysis)

    def add_users(self, files: Mapping[str, Iterable[Span]], folders: Collection[Path]) -> bool:
        """Add files, by their real paths, and the specs that use them; return whether there are more than before."""
        before = len(self.compiled)
        for real in files.keys() - self._searched:
            self._searched.add(real)
            for analysis in (*self._alone(Path(real)), *find_users(Path(real), folders, self._settings).values()):
                self._add(analysis)
        return len(self.compiled) > before

    def _alone(self, path: Path) -> Iterator[Analysis]:
        """Yield the analysis of a module by itself, unless it is one only with what uses it."""
        if identity(path) not in self.defaults:
            analysis = analyse_path(path, self._settings)
            if not is_part(analysis) and not analysis.compilation.has_errors:
                yield analysis

    def _add(self, analysis: Analysis) -> None:
        path = analysis.spec.file.path if analysis.spec else None
        if analysis.spec is None or path is None or identity(path) in self.defaults:
            return
        self.defaults[identity(path)] = one = Compiled(path, self._settings, Occurrences(analysis))
        self.compiled.append(one)
        for variant in analysis.spec.tree.section("variants"):
            settings = self._settings._replace(variant=variant)
            self.compiled.append(Compiled(path, settings, Occurrences(analyse_path(path, settings))))


def _local_name(new: str, text: str, renaming: Renaming) -> str:
    """Return what takes the place of the name in the text at the position, for which the user writes a new one."""
    before, _, after = text.rpartition(renaming.name)
    if not new.startswith(before):
        made = next((one for one in renaming.occurrences if one.is_declaration and one.is_computed), None)
        if made and not has_expression(text):
            raise RefusedError(f"{computed_name(made)}; a new one must begin with '{before}'")
        raise RefusedError(f"the new name must begin with '{before}', the prefix of the module")
    if not new.endswith(after):
        raise RefusedError(f"the new name must end with '{after}', as the joint is named after its frame or module")
    local = new[len(before) : len(new) - len(after)]
    if not _PLAIN_NAME.fullmatch(local):
        raise RefusedError(f"'{new}' is not a name that can be written without quotes")
    return local
