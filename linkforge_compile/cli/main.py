"""The entry point of `linkforge`: chooses the command, parses its arguments and turns errors into exit codes."""

from __future__ import annotations

import atexit
import errno
import gc
import os
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from linkforge_compile._version import __version__
from linkforge_compile.cli import INTERNAL_FAULT, INTERRUPTED, OK, WRONG_USAGE, UsageError

if TYPE_CHECKING:
    import argparse
    from types import ModuleType

    from linkforge_compile.cli.options import Parser

COMMANDS_BY_TASK = {
    "start": {
        "init": "create a folder for a new robot, with a first spec and files for editors, git and builds",
        "compile": "compile a spec to URDF, SRDF and other formats",
        "check": "report all errors and warnings of specs, without writing anything",
        "view": "show a robot in the browser, live, or write a page or a picture of it",
    },
    "write a spec": {
        "watch": "compile a spec, and again whenever one of its files changes",
        "format": "format the white space of specs",
        "params": "list the parameters and variants of a spec",
        "explain": "explain where a value of the finished robot comes from, or what a diagnostic means",
        "where": "find the place in a spec that a line of an output comes from",
        "expand": "print a spec as one flat file, without modules, expressions, loops and defaults",
        "collisions": "find the pairs of links that need no collision check, by sampling",
    },
    "look at a robot": {
        "tree": "print the kinematic tree of a robot: links, joints, ranges and masses",
        "graph": "draw the links and joints of a robot, with its modules as boxes: SVG, Graphviz or Mermaid",
        "info": "print the key figures of a robot: mass, reach, size, meshes, sensors, groups, parameters",
        "sweep": "compile one spec with many values: grids, random samples, tables; on all processors or a cluster",
    },
    "existing robots": {
        "import": "convert an existing URDF to a spec",
        "migrate": "translate a xacro to specs, with a module for each macro, proved to be the same robot",
        "diff": "compare two robots, specs or URDFs",
    },
    "builds": {
        "formats": "list the output formats, and which parts of a robot each keeps and omits",
        "deps": "list the files that a robot is compiled from",
        "doctor": "print what is installed, which packages are found, and why a package:// is not found",
        "matcher": "print the problem matcher for GitHub Actions",
    },
    "editors and shells": {
        "schema": "print the JSON Schema of specs, for editors",
        "lsp": "start the language server, as editors do",
        "completion": "print the completion script for bash, zsh or fish",
    },
}
"""The commands with their summaries, as `linkforge --help` groups them."""

COMMANDS = {name: summary for commands in COMMANDS_BY_TASK.values() for name, summary in commands.items()}
"""Each command with its summary; the module of the same name in `cli.commands` has `add_arguments` and `run`."""

_SUMMARY = "a declarative compiler for robots: YAML specs in; URDF, SRDF and other formats out"

_FIRST_STEPS = """\
Start with one of these:
  linkforge init my_arm                            a folder for a new robot, with a first spec
  linkforge import arm.urdf -o arm.robot.yaml      the spec of an existing URDF
  linkforge migrate arm.urdf.xacro -o robots/      the specs of an existing xacro

and then
  linkforge check arm.robot.yaml                   report its errors and warnings
  linkforge view arm.robot.yaml                    show it in the browser, and update it with each change
  linkforge compile arm.robot.yaml -o build/       write its URDF, and its SRDF if it has one

`linkforge --help` lists all commands; `linkforge COMMAND --help` describes one, with examples. `linkforge doctor` shows
what is installed, and `linkforge explain CODE` what a diagnostic means. The documentation is in the folder docs of the
sources; start with docs/tutorial.md.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command, with the process's own arguments for None, and return its exit code."""
    words = sys.argv[1:] if arguments is None else list(arguments)
    if arguments is None:
        _require_utf8()
        # In a process of our own almost nothing becomes cyclic garbage; looking for it takes a quarter of a long
        # compile, and looking once more at exit takes half of the time that Python needs to end.
        gc.set_threshold(100_000, 50)
        atexit.register(gc.freeze)
    if words in (["--version"], ["-V"]):
        # Scripts and shell prompts ask for the version often: answer without importing argparse.
        print(f"linkforge {__version__}")
        return OK
    if arguments is None and "_ARGCOMPLETE" in os.environ:  # a shell asks how a line may go on
        from linkforge_compile.cli.completion import complete

        complete(COMMANDS, _parser_of)
    try:
        return _run(words)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:  # as in `linkforge compile … | head`
        # Redirected, so that the final flush does not meet the closed pipe.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return OK
    except MemoryError:
        pass  # reported below, once the frames that hold the memory are released
    except Exception as error:
        return _report_crash(error, words)  # whatever arrives here is a bug in linkforge
    # The limits of a spec keep a compile below 512 MB, so this is about the machine, not about the spec.
    reason = "there is not enough memory; free some, or raise the limit (ulimit -v)"
    return _report_usage_error(_shorten(" ".join(words)), reason)


def _require_utf8() -> None:
    """Start this process again in Python's UTF-8 mode where names of files would be ASCII (PEP 540)."""
    # As under LC_ALL=C with PYTHONUTF8=0: `é.robot.yaml` would be another name in outputs, and `use: é.yaml` no file.
    if sys.getfilesystemencoding() == "ascii":
        os.execv(sys.executable, [sys.executable, "-X", "utf8", *sys.orig_argv[1:]])


def _run(words: list[str]) -> int:
    if not words or words[0] not in COMMANDS:
        return _run_without_command(words)
    name, *rest = words
    # Intermixed, so that `linkforge compile arm.robot.yaml -o build/ reach:=0.7` works as with ROS's tools.
    arguments = _parser_of(name).parse_words(rest)
    try:
        code: int = _module_of(name).run(arguments)
    except UsageError as error:
        return _report_usage_error(name, str(error))
    except OSError as error:
        reason = _usage_error_of(error)
        if reason is None:
            raise
        return _report_usage_error(name, reason)
    return code


def _module_of(command: str) -> ModuleType:
    from importlib import import_module

    # `import` is a keyword of Python, so its module is `import_`.
    return import_module(f"linkforge_compile.cli.commands.{command.replace('import', 'import_')}")


def _parser_of(command: str) -> Parser:
    return _make_parser(f"linkforge {command}", COMMANDS[command], _module_of(command).add_arguments)


def _run_without_command(words: list[str]) -> int:
    """Say what to do first, handle options such as `--help`, or report an unknown command."""
    if not words:
        print(f"linkforge {__version__}: {_SUMMARY}.\n\n{_FIRST_STEPS}", end="")
        return OK
    version = f"linkforge {__version__}"
    parser = _make_parser(
        "linkforge", _SUMMARY, lambda it: it.add_argument("-V", "--version", action="version", version=version)
    )
    parser.usage = "linkforge [-h] [-V] COMMAND ..."
    width = max(map(len, COMMANDS))
    lines = []
    for task, commands in COMMANDS_BY_TASK.items():
        lines += [f"{task}:", *(f"  {name:{width}}  {summary}" for name, summary in commands.items()), ""]
    lines += [
        "`linkforge COMMAND --help` describes a command. Exit codes: 0 no errors, 1 errors in the spec, 2 wrong usage,",
        "70 a bug in linkforge.",
    ]
    parser.epilog = "\n".join(lines)
    parser.parse_known_args(words)
    from linkforge_compile.diagnostics.suggest import did_you_mean

    return parser.error(f"'{words[0]}' is not a command{did_you_mean(words[0], COMMANDS)}")


def _make_parser(program: str, summary: str, add_arguments: Callable[[argparse.ArgumentParser], object]) -> Parser:
    from argparse import RawDescriptionHelpFormatter

    from linkforge_compile.cli.options import Parser, StoreOnce

    description = f"{summary[0].upper()}{summary[1:]}."
    # Without abbreviations: a script that writes `--form` would break with the next option of that beginning.
    parser = Parser(
        prog=program, description=description, formatter_class=RawDescriptionHelpFormatter, allow_abbrev=False
    )
    parser.register("action", None, StoreOnce)
    add_arguments(parser)
    return parser


def _report_usage_error(command: str, reason: str) -> int:
    from linkforge_compile.cli.reports import print_line

    print_line(f"linkforge {command}: {reason}")
    return WRONG_USAGE


def _usage_error_of(error: OSError) -> str | None:
    """Return the message for a system error that the command line caused; None for a bug of linkforge."""
    if error.errno in (errno.ENAMETOOLONG, errno.EACCES, errno.EPERM) and error.filename:
        return f"'{_shorten(str(error.filename))}': {error.strerror}"
    try:
        if not error.filename:
            os.getcwd()  # noqa: PTH109
    except FileNotFoundError:
        return "the folder it is called in is gone; enter one that exists"
    return None


def _shorten(name: str) -> str:
    return name if len(name) <= 80 else f"{name[:40]}…{name[-30:]}"


def _report_crash(error: Exception, words: Sequence[str]) -> int:
    """Print what happened and where the report is saved; print the traceback only if LINKFORGE_DEBUG is set.

    An error in an edited copy of linkforge's own templates is reported as that. Return the exit code.
    """
    import platform
    import shlex
    import traceback

    from linkforge_compile.cli.reports import write_to_stderr
    from linkforge_compile.formats.environment import TemplateFaultError
    from linkforge_compile.source.characters import on_one_line

    if isinstance(error, TemplateFaultError):
        write_to_stderr(f"linkforge: {error}\n")
        return WRONG_USAGE
    frames = traceback.extract_tb(error.__traceback__)
    place = "?"
    if frames:
        place = f"{frames[-1].filename.rpartition('linkforge_compile')[2].lstrip('/')}:{frames[-1].lineno}"
    trace = "".join(traceback.format_exception(error))
    if os.environ.get("LINKFORGE_DEBUG"):
        write_to_stderr(trace)
    system = f"linkforge {__version__}, Python {platform.python_version()}, {platform.platform()}"
    about = f"{system}\ncommand: {on_one_line(shlex.join(('linkforge', *words)))}\n"
    write_to_stderr(
        f"linkforge: internal fault: {type(error).__name__} at {place}: {on_one_line(str(error))}\n"
        "This is a bug in linkforge, not in your spec. Please report it with the spec and\n"
        f"  {_save(f'{about}{trace}') or 'what LINKFORGE_DEBUG=1 prints'}\n"
        f"{about}"
    )
    return INTERNAL_FAULT


def _save(report: str) -> str | None:
    """Write the report to a new temporary file and return its path; None if that fails."""
    import tempfile

    try:
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", errors="replace", prefix="linkforge-fault-", suffix=".txt", delete=False
        ) as file:
            file.write(report)
    except OSError:
        return None
    return file.name
