"""Answers a shell that asks how a command line may go on, through argcomplete."""

from __future__ import annotations

import argparse
import os
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import PurePath

from argcomplete.finders import CompletionFinder
from argcomplete.lexers import split_line

from linkforge_compile.cli.completion.candidates import Candidates
from linkforge_compile.cli.options import Parser

PATIENCE = 3.0
"""Time after which nothing is completed [s], because a shell waits for the answer."""


def complete(commands: Mapping[str, str], parser_of: Callable[[str], Parser]) -> None:
    """Print the completions of the line that a shell passes in environment variables, and end the process.

    `commands` has the summary of each command. A faulty spec completes nothing, and so does one that needs more time
    than PATIENCE.
    """
    # Reading a spec may block inside a library, so an exception would be late.
    timer = threading.Timer(PATIENCE, os._exit, [1])
    timer.daemon = True
    timer.start()
    words = split_line(os.environ["COMP_LINE"], int(os.environ["COMP_POINT"]))[3]  # those before the cursor's
    start = _start_of_command(words, commands)
    name, *given = words[start + 1 :] or [""]
    if not name:
        os.environ["_ARGCOMPLETE"] = str(start + 1)
        _Finder()(_parser_of_commands(commands), always_complete_options=False)
    elif name in commands:
        # argcomplete omits the words before the one that it takes for the program, here the command.
        os.environ["_ARGCOMPLETE"] = str(start + 2)
        candidates = Candidates(name, _parse(parser_of(name), given))
        _Finder()(parser_of(name), always_complete_options=False, default_completer=candidates)
    os._exit(1)


def _start_of_command(words: Sequence[str], commands: Mapping[str, str]) -> int:
    """Return the place of `linkforge` in a line, which may have other commands: `cd robots && linkforge check`."""
    # zsh passes all of the line.
    found = [place for place, word in enumerate(words) if PurePath(word).name == "linkforge"]
    used = [place for place in found if words[place + 1 : place + 2] and words[place + 1] in commands]
    return (used or found or [0])[-1]


def _parser_of_commands(commands: Mapping[str, str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("linkforge")
    parser.add_argument("-V", "--version", action="version", help="print the version")
    names = parser.add_subparsers()
    for name, summary in commands.items():
        names.add_parser(name, help=summary)
    return parser


def _parse(parser: Parser, words: Sequence[str]) -> argparse.Namespace:
    """Parse the words before the cursor, as far as they make sense."""
    # The last word may be an option whose value is at the cursor.
    for given in (words, words[:-1], ()):
        try:
            return parser.parse_words(given)
        except SystemExit:
            continue
    return argparse.Namespace()


class _Finder(CompletionFinder):
    """Completes positional words after options too, as our parser accepts them."""

    def collect_completions(
        self, active_parsers: list[argparse.ArgumentParser], parsed_args: argparse.Namespace, cword_prefix: str
    ) -> list[str]:
        parser = active_parsers[-1]
        # After `compile SPEC -o FOLDER`, argcomplete sees no argument that takes a further word.
        if not parser.active_actions:  # type: ignore[attr-defined]
            parser.active_actions = parser._get_positional_actions()  # type: ignore[attr-defined]
        return super().collect_completions(active_parsers, parsed_args, cword_prefix)
