"""Edits of files as the protocol has them: with the versions of the open texts if the editor compares these."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from difflib import SequenceMatcher
from itertools import accumulate
from typing import TypeAlias

from lsprotocol import types

from linkforge_compile.diagnostics.fix import Edit
from linkforge_compile.lsp.convert import Columns, path_of, uri_of
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.roots import identity

Changes: TypeAlias = Mapping[str, Sequence[types.TextEdit]]
"""The edits of files by their URIs."""

MakeEdit: TypeAlias = Callable[[Changes], types.WorkspaceEdit]
"""`workspace_edit` for an editor and the texts that are open in it."""


def changes_of(edits: Iterable[Edit], columns: Columns) -> Changes:
    """Return edits by the URIs of their files."""
    changes: dict[str, list[types.TextEdit]] = {}
    for edit in edits:
        if path := edit.span.file.path:
            changes.setdefault(uri_of(path), []).append(types.TextEdit(columns.range(edit.span), edit.text))
    return changes


def edits_to(text: str, document: Document) -> list[types.TextEdit]:
    """Return the edits that make another text of a document, of changed lines only: cursors on others stay."""
    file = document.file
    before, after = file.counted.splitlines(keepends=True), text.removeprefix("\ufeff").splitlines(keepends=True)
    starts = [0, *accumulate(map(len, before))]
    changes = SequenceMatcher(None, before, after).get_opcodes()
    return [
        types.TextEdit(document.columns.range(file.between(starts[begin], starts[end])), "".join(after[first:last]))
        for change, begin, end, first, last in changes
        if change != "equal"
    ]


def workspace_edit(
    changes: Changes, versions: Mapping[str, int | None], client: types.ClientCapabilities
) -> types.WorkspaceEdit:
    """Return changes for an editor; `versions` are those of the texts that are open in it, by real path."""
    abilities = client.workspace.workspace_edit if client.workspace else None
    if not (abilities and abilities.document_changes):
        return types.WorkspaceEdit(changes=changes)
    return types.WorkspaceEdit(
        document_changes=[
            types.TextDocumentEdit(
                types.OptionalVersionedTextDocumentIdentifier(uri, versions.get(identity(path_of(uri) or ""))), listed
            )
            for uri, listed in changes.items()
        ]
    )
