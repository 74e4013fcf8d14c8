"""Code actions: the fixes of diagnostics, comments that ignore them, and all safe fixes of a text at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from lsprotocol import types

from linkforge_compile.analysis import Analysis, Settings, analyse_path
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.fix import Fix
from linkforge_compile.fixing import apply_safe_fixes, is_proven
from linkforge_compile.lsp.changes import MakeEdit, changes_of, edits_to
from linkforge_compile.lsp.convert import uri_of
from linkforge_compile.lsp.diagnostics import report_of
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.roots import identity
from linkforge_compile.syntax.ignore_comments import ignore_fix

FIX_ALL = "source.fixAll.linkforge"
"""The kind of the action that applies all safe fixes, for `editor.codeActionsOnSave` and its like."""

KINDS = (types.CodeActionKind.QuickFix, FIX_ALL)


def code_actions(
    document: Document, selection: types.Range, context: types.CodeActionContext, settings: Settings, make: MakeEdit
) -> list[types.CodeAction]:
    """Return the actions for a selection, of the kinds that the editor asks for.

    `make` gives their edits the form that the editor takes. Safe fixes are preferred if an analysis with these settings
    proves them. All of them at once are an action only for an editor that asks for actions of a whole text: they are
    no answer to one diagnostic.
    """
    check = _check_of(document, settings)
    actions = []
    if _is_wanted(types.CodeActionKind.QuickFix, context.only):
        selected = [one for one in _reported_in(document) if _is_in(one, document, selection)]
        actions += [
            action for one in selected for action in _quick_fixes(one, document, context.diagnostics, check, make)
        ]
    if context.only and _is_wanted(FIX_ALL, context.only) and (action := _fix_all(document, check, make)):
        actions.append(action)
    return actions


def _is_wanted(kind: str, only: Sequence[str] | None) -> bool:
    """Whether an editor asks for a kind: by itself, by one above it such as `source`, or for all."""
    return only is None or any(kind == one or kind.startswith(f"{one}.") for one in only)


def _reported_in(document: Document) -> Iterator[Diagnostic]:
    """Yield the diagnostics in a text, except those of an older version of it."""
    for one in report_of(document.analyses):
        if one.span is not None and document.holds(one.span) and one.span.file.text == document.file.text:
            yield one


def _is_in(one: Diagnostic, document: Document, selection: types.Range) -> bool:
    """Whether a diagnostic is at a selection, or touches it."""
    start, end = document.place(selection.start), document.place(selection.end)
    return one.span is not None and one.span.start <= end and start <= one.span.end


class _Checked(NamedTuple):
    """The diagnostics of all specs that read a text."""

    diagnostics: tuple[Diagnostic, ...]

    @classmethod
    def of(cls, analyses: Iterable[Analysis]) -> _Checked:
        return cls(tuple(diagnostic for one in analyses for diagnostic in one.compilation.diagnostics))


_Check: TypeAlias = Callable[[Mapping[str, str]], _Checked]


def _check_of(document: Document, settings: Settings) -> _Check:
    """Return the check of all specs that read a document, with texts in place of files."""
    roots = [one.compilation.files[0] for one in document.analyses if one.compilation.files]

    def check(texts: Mapping[str, str]) -> _Checked:
        changed = settings._replace(buffers={**settings.buffers, **texts})
        return _Checked.of(analyse_path(root, changed) for root in roots)

    return check


def _quick_fixes(
    one: Diagnostic, document: Document, shown: Iterable[types.Diagnostic], check: _Check, make: MakeEdit
) -> Iterator[types.CodeAction]:
    """Yield an action for each fix of a diagnostic, then one that ignores it; `shown` are those of the editor."""
    columns, before = document.columns, _Checked.of(document.analyses)
    its = [each for each in shown if each.code == one.code.id and one.span and each.range == columns.range(one.span)]
    for fix in one.fixes:
        is_preferred = fix.is_safe and is_proven(one, fix, before, check)
        yield _quick_fix(fix, make(changes_of(fix.edits, columns)), its, is_preferred=is_preferred)
    if comment := ignore_fix(one):
        yield _quick_fix(comment, make(changes_of(comment.edits, columns)), its)


def _quick_fix(
    fix: Fix, edit: types.WorkspaceEdit, diagnostics: Sequence[types.Diagnostic], *, is_preferred: bool = False
) -> types.CodeAction:
    kind = types.CodeActionKind.QuickFix
    return types.CodeAction(fix.title, kind, diagnostics, is_preferred=is_preferred or None, edit=edit)


def _fix_all(document: Document, check: _Check, make: MakeEdit) -> types.CodeAction | None:
    """Return the action that applies all safe fixes of a text, as `check --fix` does; None if there are none."""
    texts = apply_safe_fixes(check, lambda path: identity(path) == identity(document.path)).texts
    edits = [edit for text in texts.values() for edit in edits_to(text, document)]
    return (
        types.CodeAction("fix what is certain", FIX_ALL, edit=make({uri_of(document.path): edits})) if edits else None
    )
