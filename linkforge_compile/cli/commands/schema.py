"""`linkforge schema`: a JSON Schema (draft-07) for editors, of the language or with the names of a repository."""

from __future__ import annotations

import argparse
import posixpath
from collections.abc import Iterable, Mapping
from pathlib import Path

from linkforge_compile.cli import OK, UsageError
from linkforge_compile.cli.options import add_package_option, packages_of
from linkforge_compile.cli.reports import print_line

_EXAMPLES = """\
For VS Code and every editor with yaml-language-server, put this line at the top of a spec in the folder of the schema:
  # yaml-language-server: $schema=robot.schema.json

With --workspace, editors also complete the names of links, joints, groups, materials and files, and the parameters of a
module under `with`. Unless -o is given, the schema is written to FOLDER/.linkforge/robot.schema.json. Without FOLDER,
that is the folder at or above this one, within the repository, that has such a schema; or else each folder below that
has one; or else this folder. Run it again when names have changed; until then, new names are valid but not completed.
It compiles the specs, which runs the xacro files that they use, unless LINKFORGE_NO_XACRO is set.

examples:
  linkforge schema -o robot.schema.json    the keys of the language
  linkforge schema --workspace             with the names of all specs below
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("-o", "--output", metavar="FILE", help="write to a file instead of standard output")
    parser.add_argument("-q", "--quiet", action="store_true", help="print errors only")
    parser.add_argument(
        "--workspace",
        metavar="FOLDER",
        nargs="?",
        const="",
        help="add the names of all specs below FOLDER (default: the folder that has such a schema, else this one)",
    )
    add_package_option(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import refuse_links_out, write_json
    from linkforge_compile.editor.bundle import bundle_text

    if arguments.workspace is None:
        write_json(bundle_text(), arguments.output, arguments)
        return OK
    from linkforge_compile.editor.folders import SCHEMA

    packages = {name: Path(folder) for name, folder in packages_of(arguments).items()}
    roots = (Path(arguments.workspace),) if arguments.workspace else _workspaces(Path(), packages)
    if not roots[0].is_dir():
        raise UsageError(f"--workspace takes a folder, found '{arguments.workspace}'")
    if arguments.output is not None and len(roots) > 1:
        raise UsageError(f"-o takes one schema, found those of {', '.join(map(str, roots))}; write --workspace FOLDER")
    for root in roots:
        if arguments.output is None:
            refuse_links_out([root / SCHEMA], [root], "-o")
        write_json(workspace_schema(root, packages), arguments.output or str(root / SCHEMA), arguments)
    return OK


def workspace_schema(root: Path, packages: Mapping[str, Path], *, runs_xacro: bool = True) -> str:
    """Return the schema of the specs below a folder, and warn on standard error about names that may be missing.

    UsageError if there is no spec, or more than a repository has.
    """
    from linkforge_compile.editor import read_vocabulary, without_parts, workspace_text
    from linkforge_compile.editor.folders import schemas_below

    specs = _find_specs(root, packages)
    for folder in schemas_below(root, specs):
        print_line(f"'{folder}' has its own schema; `linkforge schema --workspace {folder}` updates it")
    vocabularies = without_parts(read_vocabulary(spec, root, packages, runs_xacro=runs_xacro) for spec in specs)
    remedy = "`linkforge check` shows why" if runs_xacro else "`linkforge schema --workspace` may find them"
    for vocabulary in vocabularies:
        if not vocabulary.is_whole:
            print_line(f"names of {root / vocabulary.files[0]} may be missing; {remedy}")
    _warn_unnamed({file for vocabulary in vocabularies for file in vocabulary.files[1:]}, root)
    return workspace_text(vocabularies)


def _warn_unnamed(included: Iterable[str], root: Path) -> None:
    """Warn about included files of which no editor knows that the schema is theirs."""
    from linkforge_compile.editor.folders import SCHEMA, has_editor_schema

    for file in sorted(included):
        if not file.startswith("../") and not has_editor_schema(root / file):
            schema = posixpath.relpath(SCHEMA.as_posix(), posixpath.dirname(file) or ".")
            remedy = f"begin it with '# yaml-language-server: $schema={schema}', or call it NAME.robot.yaml"
            print_line(f"'{root / file}' has no schema in editors; {remedy}")


def _workspaces(here: Path, packages: Mapping[str, Path]) -> tuple[Path, ...]:
    """Return the folder at or above this one that has a schema, else those below that have one, else this one."""
    from linkforge_compile.editor.folders import SCHEMA, schemas_below, workspace_of

    root = workspace_of(here)
    if (root / SCHEMA).is_file():
        return (root,)
    # `workspace_schema` warns about files that are skipped.
    return schemas_below(here, _find_specs(here, packages, warns=False)) or (root,)


def _find_specs(root: Path, packages: Mapping[str, Path], *, warns: bool = True) -> tuple[Path, ...]:
    from linkforge_compile.editor import TooManyFilesError, find_specs
    from linkforge_compile.roots import Roots

    try:
        roots = Roots.around(root, packages.values())
        unread, outside = (_warn_unread, _warn_outside) if warns else (None, None)
        specs = find_specs(root, roots=roots, unread=unread, outside=outside)
    except TooManyFilesError as error:
        raise UsageError(f"there are {error} below '{root}'; name the folder of the robots") from error
    if not specs:
        raise UsageError(f"there is no spec, NAME.robot.yaml, below '{root}'; name the folder of the robots")
    return specs


def _warn_unread(error: OSError) -> None:
    print_line(f"'{error.filename}' cannot be read: {(error.strerror or '').lower()}; names may be missing")


def _warn_outside(link: Path) -> None:
    what = f"the link '{link}' leads out of the folders that may be read, and is not opened"
    print_line(f"{what}; names may be missing")
