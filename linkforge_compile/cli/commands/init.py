"""`linkforge init`: a folder to begin a robot in."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import OK, UsageError

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.editor.robot_folder import RobotFolder

_EXAMPLES = """\
Writes NAME.robot.yaml, which compiles, the schema by which editors complete it, settings of VS Code, .gitignore,
.pre-commit-config.yaml and CMakeLists.txt. What is there already is kept as it is, and what it lacks is told; only the
schema is renewed. A folder within a package or repository gets no second one of what stands once at its top; what is
read only at the top of a repository, settings of VS Code and .pre-commit-config.yaml, goes there.

examples:
  linkforge init my_arm               in a new folder my_arm
  linkforge init my_arm --dir .       in this one
  linkforge init my_arm --dir robots  in the folder robots of a package
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("name", metavar="NAME", help="name of the robot: letters, digits, _ and -")
    parser.add_argument("--dir", metavar="FOLDER", help="where to write; a new folder NAME unless said")
    parser.add_argument("-q", "--quiet", action="store_true", help="do not tell what was written, nor what to do next")


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.telling import line_to_stderr
    from linkforge_compile.editor.robot_folder import NAME, RobotFolder

    name = arguments.name
    if not NAME.fullmatch(name):
        raise UsageError(f"NAME is letters, digits, _ and -, a letter first; found '{name}'")
    place = RobotFolder.at(Path(arguments.dir if arguments.dir is not None else name))
    told = _written(place, name)
    if not arguments.quiet:
        for line in (*told, *_next(place, name)):
            line_to_stderr(line)
    return OK


def _written(place: RobotFolder, name: str) -> list[str]:
    """Write what is not there yet and the schema, all or nothing; say what was done."""
    from linkforge_compile.cli.output import (
        place_of,
        refuse_links_out,
        without_new_folders,
        write_changed,
        write_if_changed,
    )
    from linkforge_compile.cli.workspace import schema_of
    from linkforge_compile.editor.robot_folder import SCHEMA

    files, schema = place.files(name), place.workspace / SCHEMA
    new = {path: text for path, text in files.items() if not (path.exists() or path.is_symlink())}
    refuse_links_out((*new, schema), place.folders, "--dir")
    with without_new_folders(map(place_of, (*new, schema))):
        written = write_changed(new)
        try:
            # A first folder is no leave to run what is in the others.
            is_new = write_if_changed(schema, schema_of(place.workspace, {}, runs_xacro=False))
        except BaseException:
            for path in written:
                path.unlink()
            raise
    told = [f"wrote {path}" if path in written else f"kept {path}, which is there already" for path in files]
    return [*told, f"wrote {schema}" if is_new else f"{schema} is up to date"]


def _next(place: RobotFolder, name: str) -> list[str]:
    """Return what one would do now, as one would type it."""
    enter = [] if place.folder.resolve() == Path.cwd() else [f"  cd {place.folder}"]
    lines = [
        "",
        "next:",
        *enter,
        f"  linkforge compile {name}.robot.yaml -o build/",
        "  linkforge schema --workspace         when names have changed, so that editors offer them",
    ]
    for path, missed in place.missing(name).items():
        lines += ["", f"put into {path}:", *(f"  {line}" for line in missed)]
    return lines
