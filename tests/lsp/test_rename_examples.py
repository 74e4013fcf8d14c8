"""Parts of the examples, renamed and back: the same texts, and robots that differ in the name alone."""

import os
import random
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from pygls.workspace import PositionCodec

from linkforge_compile import render
from linkforge_compile.analysis import analyse_path
from linkforge_compile.diagnostics.fix import Edit, apply_edits
from linkforge_compile.lsp.convert import Columns
from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.lsp.occurrences import Occurrences
from linkforge_compile.lsp.rename import rename
from linkforge_compile.lsp.renaming import RefusedError, renamed_at
from linkforge_compile.lsp.workspace import Document, Workspace, find_users
from linkforge_compile.roots import identity
from linkforge_compile.source import SourceFile
from tests.conftest import ROOT

EXAMPLES = ROOT / "examples"
NEW = "_renamed"
SPECS = sorted(EXAMPLES.rglob("*.robot.yaml"))
ALL = bool(os.environ.get("LINKFORGE_RENAME_ALL"))
"""Whether every part of every example is renamed (a minute), not a few of each (always the same)."""


def document_of(path: Path, texts: Mapping[Path, str]) -> tuple[Document, Workspace]:
    """Return a spec with the specs that read it, and the workspace with some texts open."""
    workspace = Workspace()
    for file, text in {path: path.read_text(), **texts}.items():
        workspace.put(file, 1, text)
    workspace.keep(path, analyse_path(path, workspace.settings()))
    document = workspace.document(path, Columns(PositionCodec()))
    assert document is not None
    users = find_users(path, (EXAMPLES,), workspace.settings())
    return document._replace(analyses=(*document.analyses, *users.values())), workspace


def declared_in(document: Document) -> list[Occurrence]:
    """Return the parts that a file declares, each place once, without the names of expressions."""
    assert document.analysis is not None
    own = (one for one in Occurrences(document.analysis).all if one.is_declaration and document.holds(one.span))
    return [one for one in {str(one.span): one for one in own}.values() if not one.scope]


def edited(edits: Sequence[Edit] | None) -> dict[Path, str]:
    """Return the texts of the files that edits change."""
    assert edits
    by_file: dict[SourceFile, list[Edit]] = {}
    for one in edits:
        by_file.setdefault(one.span.file, []).append(one)
    return {Path(identity(file.path or "")): apply_edits(file, listed) for file, listed in by_file.items()}


def outputs(document: Document) -> list[str]:
    """Return what planners, controllers and simulators read of each robot."""
    robots = [analysis.compilation.robot for analysis in document.analyses]
    found = []
    for robot in robots:
        assert robot is not None
        formats = ("urdf", "srdf", *(["ros2_controllers"] if robot.controllers else []))
        found += [render(robot, one) for one in formats]
    return found


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.name)
def test_a_part_renamed_and_back_is_the_same(path: Path):
    document, workspace = document_of(path, {})
    parts = declared_in(document)
    for one in parts if ALL else random.Random(path.name).sample(parts, min(2, len(parts))):
        target = renamed_or_refused(document, one, workspace)
        if target is None:
            continue
        old, texts = target
        changed, changed_workspace = document_of(path, texts)
        for before, after in zip(outputs(document), outputs(changed), strict=True):
            assert after.replace(NEW, "") == before
        assert any(NEW in text for text in outputs(changed)) or one.kind == "module" or one.suffix
        back = rename(changed, one.span.start, old, changed_workspace.settings(), (EXAMPLES,))
        assert edited(back) == {file: file.read_text() for file in texts}


def renamed_or_refused(
    document: Document, one: Occurrence, workspace: Workspace
) -> tuple[str, Mapping[Path, str]] | None:
    """Return the old name and the texts after a rename; None if that is refused with a reason."""
    try:
        target = renamed_at(document, one.span.start)
        assert target is not None
        old = target[0].text or ""
        suffix = target[1].suffix(one)
        new = old.removesuffix(suffix) + NEW + suffix if old.endswith(suffix) and not one.suffix else old + NEW
        return old, edited(rename(document, one.span.start, new, workspace.settings(), (EXAMPLES,)))
    except RefusedError as error:
        reason = str(error)
    assert "would differ" not in reason or one.kind == "module"
    assert " may be the " not in reason or "initial_keyframe: standing" in reason
    return None
