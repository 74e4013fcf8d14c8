"""`linkforge formats`: the output formats, their options, and what each keeps and loses of a robot."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence

from linkforge_compile import formats
from linkforge_compile.cli import OK, UsageError
from linkforge_compile.formats import Format

_EXAMPLES = """\
Formats marked `default` are written to a folder unless others are requested with --format. Parts that a format omits
are reported at their place in the spec; with `linkforge compile --strict`, nothing is written in that case.

examples:
  linkforge formats             all formats
  linkforge formats mjcf        one of them
  linkforge formats --json      for tools
"""

_WIDTH = 110


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("names", metavar="NAME", nargs="*", help="only this format")
    parser.add_argument("--json", action="store_true", help="as JSON, for tools")


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import write_to_stdout

    chosen = [_named(name) for name in arguments.names] or formats.FORMATS
    paragraphs = ("".join(f"{row}\n" for row in _rows(one)) for one in chosen)
    write_to_stdout(_json_text(chosen) if arguments.json else "\n".join(paragraphs))
    return OK


def _named(name: str) -> Format:
    try:
        return formats.format_named(name)
    except ValueError as error:
        raise UsageError(str(error)) from None


def _rows(one: Format) -> Iterator[str]:
    yield f"{one.name}: {one.description}" + (" (default)" if one.is_default else "")
    yield from _wrapped("file", ", ".join(f"NAME{one.suffix}/{file}" for file in one.files) or f"NAME{one.suffix}")
    yield from _wrapped("keeps", one.keeps)
    yield from _wrapped("loses", one.loses)
    for option in one.options:
        choices = "" if option.is_flag else f" {'|'.join(option.choices)}"
        yield from _wrapped("option", f"--{option.name}{choices}: {option.help}")


def _wrapped(title: str, text: str) -> Iterator[str]:
    from textwrap import wrap

    yield from wrap(text, _WIDTH, initial_indent=f"  {title:8}", subsequent_indent=" " * 10, break_on_hyphens=False)


def _json_text(chosen: Sequence[Format]) -> str:
    from linkforge_compile.cli.output import json_text

    document = [
        {
            "name": one.name,
            "suffix": one.suffix,
            "files": one.files,
            "share_folder": one.share_folder,
            "relative_paths": one.has_relative_paths,
            "description": one.description,
            "default": one.is_default,
            "keeps": one.keeps,
            "loses": one.loses,
            "options": [option._asdict() for option in one.options],
        }
        for one in chosen
    ]
    return json_text(document)
