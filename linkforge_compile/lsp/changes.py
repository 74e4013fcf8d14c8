"""Edits of files as the protocol has them: with the versions of the open texts if the editor compares these."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from lsprotocol import types

from linkforge_compile.diagnostics.fix import Edit
from linkforge_compile.lsp.convert import Columns, uri_of
from linkforge_compile.roots import identity


def workspace_edit(
    edits: Iterable[Edit], versions: Mapping[str, int | None], columns: Columns, client: types.ClientCapabilities
) -> types.WorkspaceEdit:
    """Return edits for an editor; `versions` are those of the texts that are open in it, by real path."""
    changes: dict[str, list[types.TextEdit]] = {}
    version_of: dict[str, int | None] = {}
    for edit in edits:
        if path := edit.span.file.path:
            changes.setdefault(uri_of(path), []).append(types.TextEdit(columns.range(edit.span), edit.text))
            version_of[uri_of(path)] = versions.get(identity(path))
    abilities = client.workspace.workspace_edit if client.workspace else None
    if not (abilities and abilities.document_changes):
        return types.WorkspaceEdit(changes=changes)
    documents = {
        uri: types.OptionalVersionedTextDocumentIdentifier(uri, version) for uri, version in version_of.items()
    }
    return types.WorkspaceEdit(
        document_changes=[types.TextDocumentEdit(documents[uri], listed) for uri, listed in changes.items()]
    )
