"""`linkforge init`: a folder to begin a robot in."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import OK, UsageError

if TYPE_CHECKING:
    import argparse

_EXAMPLES = """\
Writes NAME.robot.yaml, which compiles, the schema by which editors complete it, settings of VS Code, .gitignore,
.pre-commit-config.yaml and CMakeLists.txt. What is there already is kept as it is.

examples:
  linkforge init my_arm               in a new folder my_arm
  linkforge init my_arm --dir .       in this one
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("name", metavar="NAME", help="name of the robot: letters, digits, _ and -")
    parser.add_argument("--dir", metavar="FOLDER", help="where to write; a new folder NAME unless said")
    parser.add_argument("-q", "--quiet", action="store_true", help="do not tell what was written, nor what to do next")


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.telling import to_stderr
    from linkforge_compile.editor.robot_folder import NAME, robot_files

    name = arguments.name
    if not NAME.fullmatch(name):
        raise UsageError(f"NAME is letters, digits, _ and -, a letter first; found '{name}'")
    folder = Path(arguments.dir if arguments.dir is not None else name)
    told = [_written(folder / path, text) for path, text in robot_files(name).items()]
    told.append(_schema(folder))
    if not arguments.quiet:
        to_stderr("".join(f"{line}\n" for line in (*told, *_next(folder, name))))
    return OK


def _written(path: Path, text: str) -> str:
    """Write a file that is not there yet; say what was done."""
    from linkforge_compile.cli.output import write_if_changed

    if path.exists() or path.is_symlink():
        return f"kept {path}, which is there already"
    write_if_changed(path, text)
    return f"wrote {path}"


def _schema(folder: Path) -> str:
    from linkforge_compile.cli.workspace import SCHEMA, schema_of

    path = folder / SCHEMA
    return f"kept {path}, which is there already" if path.exists() else _written(path, schema_of(folder, {}))


def _next(folder: Path, name: str) -> list[str]:
    """Return what one would do now, as one would type it."""
    enter = [] if folder.resolve() == Path.cwd() else [f"  cd {folder}"]
    return [
        "",
        "next:",
        *enter,
        f"  linkforge compile {name}.robot.yaml -o build/",
        "  linkforge schema --workspace         when names have changed, so that editors offer them",
    ]
