"""Code actions: the fixes of diagnostics, comments that ignore them, and all safe fixes of a text at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from lsprotocol import types

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.fix import Edit, Fix, without_overlaps
from linkforge_compile.diagnostics.grouping import group_at_places, ungrouped
from linkforge_compile.lsp.convert import Columns, uri_of
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.syntax.ignore_comments import ignore_fix

FIX_ALL = "source.fixAll.linkforge"
"""The kind of the action that applies all safe fixes, for `editor.codeActionsOnSave` and its like."""

KINDS = (types.CodeActionKind.QuickFix, FIX_ALL)


def code_actions(
    document: Document, selection: types.Range, context: types.CodeActionContext
) -> list[types.CodeAction]:
    """Return the actions for a selection, of the kinds that the editor asks for: the safe fixes are preferred."""
    reported = [*_reported_in(document)]
    actions = []
    if _is_wanted(types.CodeActionKind.QuickFix, context.only):
        selected = [one for one in reported if _is_in(one, document, selection)]
        actions += [action for one in selected for action in _quick_fixes(one, document.columns, context.diagnostics)]
    if _is_wanted(FIX_ALL, context.only) and (action := _fix_all(reported, document.columns)):
        actions.append(action)
    return actions


def _is_wanted(kind: str, only: Sequence[str] | None) -> bool:
    """Whether an editor asks for a kind: by itself, by one above it such as `source`, or for all."""
    return only is None or any(kind == one or kind.startswith(f"{one}.") for one in only)


def _reported_in(document: Document) -> Iterator[Diagnostic]:
    """Yield the diagnostics in a text, each once, except those of an older version of it."""
    seen = set()
    for one in (one for analysis in document.analyses for one in group_at_places(analysis.compilation.diagnostics)):
        is_here = one.span is not None and document.holds(one.span) and one.span.file.text == document.file.text
        if is_here and str(one) not in seen:
            seen.add(str(one))
            yield one


def _is_in(one: Diagnostic, document: Document, selection: types.Range) -> bool:
    """Whether a diagnostic is at a selection, or touches it."""
    start, end = document.place(selection.start), document.place(selection.end)
    return one.span is not None and one.span.start <= end and start <= one.span.end


def _quick_fixes(one: Diagnostic, columns: Columns, shown: Iterable[types.Diagnostic]) -> Iterator[types.CodeAction]:
    """Yield an action for each fix of a diagnostic, then one that ignores it; `shown` are those of the editor."""
    its = [each for each in shown if each.code == one.code.id and one.span and each.range == columns.range(one.span)]
    for fix in one.fixes:
        yield _action(fix, types.CodeActionKind.QuickFix, columns, its, is_preferred=fix.is_safe)
    if comment := ignore_fix(one):
        yield _action(comment, types.CodeActionKind.QuickFix, columns, its)


def _fix_all(reported: Iterable[Diagnostic], columns: Columns) -> types.CodeAction | None:
    """Return the action that applies all safe fixes of a text; None if there are none."""
    safe = (fix for one in ungrouped(reported) for fix in one.fixes[:1] if fix.is_safe)
    edits = tuple(edit for fix in without_overlaps(safe) for edit in fix.edits)
    return _action(Fix("fix what is certain", edits), FIX_ALL, columns) if edits else None


def _action(
    fix: Fix,
    kind: str,
    columns: Columns,
    diagnostics: Sequence[types.Diagnostic] = (),
    *,
    is_preferred: bool = False,
) -> types.CodeAction:
    return types.CodeAction(
        title=fix.title,
        kind=kind,
        diagnostics=list(diagnostics),
        is_preferred=is_preferred or None,
        edit=types.WorkspaceEdit(changes=_text_edits(fix.edits, columns)),
    )


def _text_edits(edits: Iterable[Edit], columns: Columns) -> dict[str, list[types.TextEdit]]:
    """Return edits as the protocol has them, by the URI of their file."""
    changes: dict[str, list[types.TextEdit]] = {}
    for edit in edits:
        if edit.span.file.path:
            changes.setdefault(uri_of(edit.span.file.path), []).append(
                types.TextEdit(columns.range(edit.span), edit.text)
            )
    return changes
