"""`linkforge schema`: the one bundled JSON Schema (draft-07), for editors."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import OK, UsageError

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


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import write_if_changed, write_to_stdout
    from linkforge_compile.schema import bundle_text

    text = bundle_text()
    if arguments.output is None:
        write_to_stdout(text)
    elif not arguments.output.endswith(".json"):
        raise UsageError(f"-o takes a file that ends in .json, found '{arguments.output}'")
    elif write_if_changed(Path(arguments.output), text):
        print(f"wrote {arguments.output}", file=sys.stderr)
    else:
        print(f"{arguments.output} is up to date", file=sys.stderr)
    return OK
