"""The schema of a repository, as commands write it: telling of which specs names may be missing."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.telling import line_to_stderr


def workspaces_at(here: Path, packages: Mapping[str, Path]) -> tuple[Path, ...]:
    """Return the folders whose schema is meant in one: that at or above it, else those below it, else itself."""
    from linkforge_compile.editor.robot_folder import SCHEMA, schemas_below, workspace_of

    root = workspace_of(here)
    if (root / SCHEMA).is_file():
        return (root,)
    # What is left out is told by who reads them.
    return schemas_below(here, _specs(here, packages, is_told=False)) or (root,)


def schema_of(root: Path, packages: Mapping[str, Path], *, runs_xacro: bool = True) -> str:
    """Return the schema of the specs below a folder; UsageError for none, or more than a repository has."""
    from linkforge_compile.editor import vocabulary_of, without_parts, workspace_text
    from linkforge_compile.editor.robot_folder import schemas_below

    specs = _specs(root, packages)
    for folder in schemas_below(root, specs):
        line_to_stderr(f"'{folder}' has a schema of its own; `linkforge schema --workspace {folder}` renews it")
    vocabularies = without_parts(vocabulary_of(spec, root, packages, runs_xacro=runs_xacro) for spec in specs)
    remedy = "`linkforge check` tells why" if runs_xacro else "`linkforge schema --workspace` may find them"
    for vocabulary in vocabularies:
        if not vocabulary.is_whole:
            line_to_stderr(f"names of {root / vocabulary.files[0]} may be missing; {remedy}")
    return workspace_text(vocabularies)


def _tell_unread(error: OSError) -> None:
    line_to_stderr(f"'{error.filename}' cannot be read: {(error.strerror or '').lower()}; names may be missing")


def _tell_outside(link: Path) -> None:
    what = f"the link '{link}' leads out of the folders that may be read, and is not opened"
    line_to_stderr(f"{what}; names may be missing")


def _specs(root: Path, packages: Mapping[str, Path], *, is_told: bool = True) -> tuple[Path, ...]:
    from linkforge_compile.editor import TooManyFilesError, specs_below
    from linkforge_compile.roots import Roots

    try:
        roots = Roots.around(root, packages.values())
        unread, outside = (_tell_unread, _tell_outside) if is_told else (None, None)
        specs = specs_below(root, roots=roots, unread=unread, outside=outside)
    except TooManyFilesError as error:
        raise UsageError(f"there are {error} below '{root}'; name the folder of the robots") from error
    if not specs:
        raise UsageError(f"there is no spec, NAME.robot.yaml, below '{root}'; name the folder of the robots")
    return specs
