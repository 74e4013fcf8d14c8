"""`linkforge matcher`: the problem matcher with which GitHub Actions shows errors of a build at their lines."""

from __future__ import annotations

import argparse

from linkforge_compile.cli import OK

_EXAMPLES = """\
It matches the text output of every command and build step of linkforge. If `linkforge check` is a separate step, use
`--format github` instead, which needs no matcher.

examples:
  linkforge matcher -o linkforge-matcher.json && echo "::add-matcher::linkforge-matcher.json"    before the build
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("-o", "--output", metavar="FILE", help="write to a file instead of standard output")
    parser.add_argument("-q", "--quiet", action="store_true", help="print errors only")


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import write_json
    from linkforge_compile.resources import matcher_file

    write_json(matcher_file().read_text("utf-8"), arguments.output, arguments)
    return OK
