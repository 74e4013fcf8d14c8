"""`linkforge matcher`: what GitHub Actions needs to show the errors of a build at their lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.cli.exits import OK

if TYPE_CHECKING:
    import argparse

_EXAMPLES = """\
It reads the text that every command and every build step of linkforge prints. In a step before the build:
  linkforge matcher -o linkforge-matcher.json
  echo "::add-matcher::linkforge-matcher.json"
Where `linkforge check` is a step of its own, `--format github` needs no matcher.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("-o", "--output", metavar="FILE", help="write it to a file instead of standard output")
    parser.add_argument("-q", "--quiet", action="store_true", help="say nothing when all is well")


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import put_json
    from linkforge_compile.resources import matcher_file

    put_json(matcher_file().read_text("utf-8"), arguments.output, quiet=arguments.quiet)
    return OK
