"""The schema of a repository, as commands write it: telling of which specs names may be missing."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path, PurePath

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.telling import to_stderr

SCHEMA = PurePath(".linkforge", "robot.schema.json")
"""Where the schema of a repository lies in it, unless said."""


def schema_of(root: Path, packages: Mapping[str, Path]) -> str:
    """Return the schema of the specs below a folder; UsageError where there is more than a repository has."""
    from linkforge_compile.editor import TooManyFilesError, specs_below, vocabulary_of, workspace_text

    try:
        specs = specs_below(root)
    except TooManyFilesError as error:
        raise UsageError(f"there are {error} below '{root}'; --workspace takes the folder of the robots") from error
    if not specs:
        to_stderr(f"there is no spec, NAME.robot.yaml, below '{root}'\n")
    vocabularies = [vocabulary_of(spec, root, packages) for spec in specs]
    for vocabulary in vocabularies:
        if not vocabulary.is_whole:
            file = vocabulary.files[0]
            to_stderr(f"names of {file} may be missing; `linkforge check` tells why\n")
    return workspace_text(vocabularies)
