"""`linkforge init`: a folder for a new robot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import OK, UsageError

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.editor.folders import RobotFolder

_EXAMPLES = """\
This writes a first spec NAME.robot.yaml, the schema for completion in editors, settings and tasks for VS Code,
.gitignore, .pre-commit-config.yaml and CMakeLists.txt. Existing files are not changed, and the lines that they lack are
printed; only the schema is updated. Files that apply to a whole package or repository are not written again in a folder
within it. Tools read the files for VS Code and .pre-commit-config.yaml only at the top level of a repository, so they
are written there.

examples:
  linkforge init my_arm               in a new folder my_arm
  linkforge init my_arm --dir .       in this one
  linkforge init my_arm --dir robots  in the folder robots of a package
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("name", metavar="NAME", help="name of the robot: letters, digits, _ and -")
    parser.add_argument("--dir", metavar="FOLDER", help="where to write (default: a new folder NAME)")
    parser.add_argument("-q", "--quiet", action="store_true", help="print errors only")


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.reports import print_line
    from linkforge_compile.editor.folders import NAME, RobotFolder

    name = arguments.name
    if not NAME.fullmatch(name):
        raise UsageError(f"NAME is letters, digits, _ and -, a letter first; found '{name}'")
    place = RobotFolder.at(Path(arguments.dir if arguments.dir is not None else name))
    status = _write_files(place, name)
    if not arguments.quiet:
        for line in (*status, *_next_steps(place, name)):
            print_line(line)
    return OK


def _write_files(place: RobotFolder, name: str) -> list[str]:
    """Write the missing files and the schema, all or none; return a line of status for each file."""
    from linkforge_compile.cli.commands.schema import workspace_schema
    from linkforge_compile.cli.output import (
        refuse_links_out,
        remove_new_folders_on_error,
        resolve_output,
        write_changed,
        write_if_changed,
    )
    from linkforge_compile.editor.folders import SCHEMA

    files, schema = place.files(name), place.workspace / SCHEMA
    new = {path: text for path, text in files.items() if not (path.exists() or path.is_symlink())}
    refuse_links_out((*new, schema), place.folders, "--dir")
    with remove_new_folders_on_error(map(resolve_output, (*new, schema))):
        written = write_changed(new)
        try:
            # The user did not ask to run the xacro files of other robots in the workspace.
            is_new = write_if_changed(schema, workspace_schema(place.workspace, {}, runs_xacro=False))
        except BaseException:
            for path in written:
                path.unlink()
            raise
    status = [f"wrote {path}" if path in written else f"kept {path}, which is there already" for path in files]
    return [*status, f"wrote {schema}" if is_new else f"{schema} is up to date"]


def _next_steps(place: RobotFolder, name: str) -> list[str]:
    """Return the commands to run next, and the lines to add to files that were kept."""
    enter = [] if place.folder.resolve() == Path.cwd() else [f"  cd {place.folder}"]
    lines = [
        "",
        "next:",
        *enter,
        f"  linkforge compile {name}.robot.yaml -o build/",
        "  linkforge schema --workspace         when names have changed, so that editors offer them",
        "",
        "docs/editors.md sets up the language server, which needs no schema and shows what `linkforge check` reports:",
        "  pip install 'linkforge-compile[lsp]'",
    ]
    for path, missing in place.missing(name).items():
        lines += ["", f"put into {path}:", *(f"  {line}" for line in missing)]
    return lines
