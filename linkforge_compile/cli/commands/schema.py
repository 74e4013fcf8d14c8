"""`linkforge schema`: the one bundled JSON Schema (draft-07), for editors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import OK

if TYPE_CHECKING:
    import argparse

_EXAMPLES = """\
For VS Code and every editor with yaml-language-server, put this on the first line of a spec:
  # yaml-language-server: $schema=robot.schema.json
after writing the schema beside it:
  linkforge schema -o robot.schema.json
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("-o", "--output", metavar="FILE", help="write it to a file instead of standard output")
    parser.add_argument("-q", "--quiet", action="store_true", help="say nothing when all is well")


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import put_json
    from linkforge_compile.schema import bundle_text

    put_json(bundle_text(), arguments.output, quiet=arguments.quiet)
    return OK
