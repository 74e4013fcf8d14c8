"""`linkforge schema`: the one bundled JSON Schema (draft-07), for editors; of the language, or of one repository."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import OK, UsageError
from linkforge_compile.cli.options import add_package_option, packages_of

if TYPE_CHECKING:
    import argparse

_EXAMPLES = """\
For VS Code and every editor with yaml-language-server, put this on the first line of a spec:
  # yaml-language-server: $schema=robot.schema.json
after writing the schema beside it:
  linkforge schema -o robot.schema.json

With --workspace, the names of links, joints, groups, materials and files complete where they are referred to, and the
parameters of a module under `with`; it goes to FOLDER/.linkforge/robot.schema.json unless -o says otherwise. FOLDER is
the one at or above this that has a schema, up to the top of the repository, else each below that has, else this one,
unless said. Run it again when names have changed: what is new since is not offered, and is no fault. It compiles the
specs, so a xacro that one of them uses is run, unless LINKFORGE_NO_XACRO is set.
  linkforge schema --workspace
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("-o", "--output", metavar="FILE", help="write it to a file instead of standard output")
    parser.add_argument("-q", "--quiet", action="store_true", help="say nothing when all is well")
    parser.add_argument(
        "--workspace",
        metavar="FOLDER",
        nargs="?",
        const="",
        help="with the names of all specs below it; unless said, where there is such a schema, else here",
    )
    add_package_option(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import put_json, refuse_links_out
    from linkforge_compile.schema.bundle import bundle_text

    if arguments.workspace is None:
        put_json(bundle_text(), arguments.output, quiet=arguments.quiet)
        return OK
    from linkforge_compile.cli.workspace import schema_of, workspaces_at
    from linkforge_compile.editor.robot_folder import SCHEMA

    packages = {name: Path(folder) for name, folder in packages_of(arguments).items()}
    roots = (Path(arguments.workspace),) if arguments.workspace else workspaces_at(Path(), packages)
    if not roots[0].is_dir():
        raise UsageError(f"--workspace takes a folder, found '{arguments.workspace}'")
    if arguments.output is not None and len(roots) > 1:
        raise UsageError(f"-o takes one schema, found those of {', '.join(map(str, roots))}; write --workspace FOLDER")
    for root in roots:
        if arguments.output is None:
            refuse_links_out([root / SCHEMA], [root], "-o")
        put_json(schema_of(root, packages), arguments.output or str(root / SCHEMA), quiet=arguments.quiet)
    return OK
