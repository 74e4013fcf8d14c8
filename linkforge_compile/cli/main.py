"""The entry point: argument tree, exit codes, and the promise that nobody ever sees a traceback."""

from __future__ import annotations

import atexit
import errno
import gc
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from linkforge_compile._version import __version__
from linkforge_compile.cli.exits import INTERRUPTED, OK, WRONG_USAGE, UsageError

if TYPE_CHECKING:
    import argparse

_COMMANDS = {
    "init": "begin a robot: a folder with a first spec, and what editors, git and builds want beside it",
    "compile": "compile a spec to URDF and SRDF",
    "watch": "compile a spec, and again whenever something changes that it is made from",
    "check": "tell all that is wrong with specs, writing nothing",
    "params": "list the parameters and variants of a spec",
    "expand": "print a spec as one flat file: no modules, expressions, loops or defaults left",
    "explain": "tell where a value of the finished robot comes from, or what a code means",
    "diff": "tell what differs between two robots, specs or URDFs",
    "where": "tell what in a spec wrote a line of the URDF or SRDF",
    "import": "write an existing URDF as a spec",
    "schema": "print the JSON Schema of specs, for editors",
    "deps": "list the files that a compiled robot is made from",
    "matcher": "print the problem matcher for GitHub Actions",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code."""
    words = sys.argv[1:] if arguments is None else list(arguments)
    if arguments is None:
        # The process is ours: modules and trees of values grow, hold no cycles, and go when it ends. To look through
        # them again and again is a tenth of a short command, and a quarter of a long robot.
        gc.set_threshold(100_000, 50)
        # Nor does what is left need a last look: that would be half of what Python does to end.
        atexit.register(gc.freeze)
    if words in (["--version"], ["-V"]):
        # Asked for by scripts and completions on every prompt, so it is answered before argparse is imported.
        print(f"linkforge {__version__}")
        return OK
    try:
        return _run(words)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # `linkforge compile … | head`: the reader has what it wanted.
        _silence_stdout()
        return OK
    except MemoryError:
        # Told below, where what took the memory is let go: to tell takes some.
        pass
    except Exception as fault:
        # The last stand: whatever gets here is our fault, not the user's, and is told as such.
        from linkforge_compile.cli.internal_fault import confess

        return confess(fault, words)
    # Of the machine, or of a limit that its owner set, and no error in a spec: its bounds take less than 512 MB.
    return _wrong_usage(
        _shown(" ".join(words)), "there is not enough memory; free some, or raise the limit (ulimit -v)"
    )


def _run(words: list[str]) -> int:
    if not words or words[0] not in _COMMANDS:
        return _no_command(words)
    from importlib import import_module

    name, *rest = words
    # `import` is a word of Python, and no name of a module.
    command = import_module(f"linkforge_compile.cli.commands.{name.replace('import', 'import_')}")
    parser = _parser(f"linkforge {name}", _COMMANDS[name], command.add_arguments)
    # Intermixed, so that `linkforge compile arm.robot.yaml -o build/ reach:=0.7` works as it does with ROS's tools.
    arguments = parser.parse_intermixed_args(rest)
    try:
        code: int = command.run(arguments)
    except UsageError as error:
        return _wrong_usage(name, str(error))
    except OSError as error:
        reason = _of_the_command_line(error)
        if reason is None:
            raise
        return _wrong_usage(name, reason)
    return code


def _wrong_usage(command: str, reason: str) -> int:
    from linkforge_compile.cli.telling import line_to_stderr

    line_to_stderr(f"linkforge {command}: {reason}")
    return WRONG_USAGE


def _of_the_command_line(error: OSError) -> str | None:
    """Return what is wrong with what the user named, or with where he stands; None for a fault of ours."""
    if error.errno in _NOT_TO_BE_HAD and error.filename:
        return f"'{_shown(str(error.filename))}': {error.strerror}"
    if error.filename or _stands_somewhere():
        return None
    return "the folder it is called in is gone; enter one that exists"


def _stands_somewhere() -> bool:
    """Whether there is a working folder: somebody else may have removed it."""
    from pathlib import Path

    try:
        Path.cwd()
    except FileNotFoundError:
        return False
    return True


_NOT_TO_BE_HAD = (errno.ENAMETOOLONG, errno.EACCES, errno.EPERM)
"""What the system says of a place on the command line that is no fault of ours; what a spec names is judged there."""


def _shown(name: str) -> str:
    return name if len(name) <= 80 else f"{name[:40]}…{name[-30:]}"


def _no_command(words: list[str]) -> int:
    """Answer `--help`, and tell of words that begin with no command."""
    summary = "a declarative compiler for robots: YAML specs in, URDF and SRDF out"
    parser = _parser("linkforge", summary, _add_version)
    parser.usage = "linkforge [-h] [-V] COMMAND ..."
    width = max(map(len, _COMMANDS))
    parser.epilog = "\n".join(
        (
            "commands:",
            *(f"  {name:{width}}  {summary}" for name, summary in _COMMANDS.items()),
            "",
            "`linkforge COMMAND --help` tells more. Exit codes: 0 clean, 1 errors in the spec, 2 wrong usage,",
            "70 a fault of linkforge itself.",
        )
    )
    parser.parse_known_args(words)
    if not words:
        parser.print_help(sys.stderr)
        return WRONG_USAGE
    from linkforge_compile.diagnostics.suggest import did_you_mean

    return parser.error(f"'{words[0]}' is no command{did_you_mean(words[0], _COMMANDS)}")


def _add_version(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-V", "--version", action="version", version=f"linkforge {__version__}")


def _parser(
    program: str, summary: str, add_arguments: Callable[[argparse.ArgumentParser], None]
) -> argparse.ArgumentParser:
    import argparse

    from linkforge_compile.cli.options import Once, Parser

    description = f"{summary[0].upper()}{summary[1:]}."
    parser = Parser(prog=program, description=description, formatter_class=_formatter_of_set_width)
    parser.register("action", None, Once)
    add_arguments(parser)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    return parser


def _formatter_of_set_width(prog: str) -> argparse.HelpFormatter:
    """Return what argparse asks of each new argument whether help could tell of it.

    One that looks at the width of the terminal imports `shutil` for that, which takes as long as argparse itself.
    """
    import argparse

    return argparse.HelpFormatter(prog, width=80)


def _silence_stdout() -> None:
    """Point standard output nowhere, so that the interpreter's last flush meets no closed pipe."""
    import os

    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
