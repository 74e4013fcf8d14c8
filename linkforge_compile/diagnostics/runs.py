"""One report of several runs over the same spec, each fault told once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from linkforge_compile.diagnostics.codes.modules import VARIANTS_BEYOND_LIMIT
from linkforge_compile.diagnostics.codes.syntax import NOTHING_TO_IGNORE
from linkforge_compile.diagnostics.diagnostic import Diagnostic, Note


def merge_reports(runs: Mapping[str, Iterable[Diagnostic]]) -> tuple[Diagnostic, ...]:
    """Return what was told in any of the runs, in reading order, with a note on what only some of them tell.

    The runs are named as after "with": "the defaults", "variant 'sim'". Each run read the files anew, so a fault is
    known by what a person sees of it: its code, its place and its words.
    """
    first: dict[tuple[str, str, str, int], Diagnostic] = {}
    told_in: dict[tuple[str, str, str, int], list[str]] = {}
    for run, diagnostics in runs.items():
        for diagnostic in diagnostics:
            key = (diagnostic.code.id, str(diagnostic.span), diagnostic.message, diagnostic.full_text_hash)
            first.setdefault(key, diagnostic)
            told_in.setdefault(key, []).append(run)
    # A comment that ignores something in one of the runs has its use.
    told = {
        key: one for key, one in first.items() if one.code is not NOTHING_TO_IGNORE or len(told_in[key]) == len(runs)
    }
    noted = (_with_note(one, told_in[key]) if len(told_in[key]) < len(runs) else one for key, one in told.items())
    return tuple(sorted(noted, key=lambda diagnostic: diagnostic.order))


def _with_note(diagnostic: Diagnostic, runs: list[str]) -> Diagnostic:
    *others, last = runs
    if diagnostic.code is VARIANTS_BEYOND_LIMIT:
        words = f"what comes after {last} is not checked"
    else:
        words = f"with {', '.join(others)} and {last}" if others else f"with {last} only"
    return replace(diagnostic, notes=(*diagnostic.notes, Note(words)))
