"""`linkforge watch`: compiles a spec, and again whenever one of its files changes."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

from linkforge_compile.cli import OK, UsageError
from linkforge_compile.cli.build import BuildRequest, compile_request, deliver, render_request
from linkforge_compile.cli.commands import compile as compile_command
from linkforge_compile.cli.reports import print_failure
from linkforge_compile.cli.watching import Watched, repeat_on_changes
from linkforge_compile.file_watcher import FileWatcher
from linkforge_compile.roots import identity

_EXAMPLES = """\
Errors are reported, and the old output remains until the next change compiles without errors. Press Ctrl-C to stop it.

examples:
  linkforge watch arm.robot.yaml -o build/
  linkforge watch arm.robot.yaml -o build/ --then 'check_urdf build/arm.urdf'
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    compile_command.add_build_arguments(parser, "the spec, NAME.robot.yaml")
    parser.usage = "linkforge watch [options] SPEC [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument("--then", metavar="COMMAND", help="a shell command to run after each compile without errors")
    parser.set_defaults(check=False)


def run(arguments: argparse.Namespace) -> int:
    request = compile_command.parse_request(arguments)
    if request.spec == "-":
        raise UsageError("takes a file, not standard input")
    # Path.is_dir raises for a name that is too long.
    if os.path.isdir(request.spec):  # noqa: PTH112
        raise UsageError(f"takes a spec, NAME.robot.yaml, found the folder '{request.spec}'")
    if arguments.then is not None and not arguments.then.strip():
        raise UsageError("--then takes a command, found nothing")
    request.targets.require_files("watch", "renews files")
    watcher = FileWatcher([Path(request.spec)])

    def build() -> Watched:
        request = compile_command.parse_request(arguments)
        exit_code = _build(request, watcher, arguments)
        if exit_code == OK and arguments.then is not None:
            _run_then(arguments)
        # Outputs that the command of --then removed need not be written again.
        outputs = [path for path in request.targets.files if path.exists()] if exit_code == OK else []
        return Watched(watcher.paths, watcher.poll, outputs)

    repeat_on_changes("watch", build, arguments)


def _build(request: BuildRequest, watcher: FileWatcher, arguments: argparse.Namespace) -> int:
    began = time.time_ns()
    compilation = compile_request(request, arguments)
    files = (*compilation.files, *compilation.unread)
    # Start before rendering, so that a file that changes meanwhile is noticed.
    watcher.track(files, began)
    try:
        return deliver([render_request(request, compilation, arguments)], arguments)
    finally:
        watcher.track((*files, *_templates(request)), began)


def _templates(request: BuildRequest) -> tuple[Path, ...]:
    """Return the templates that were read or not found, and their folder, to which the user may add one."""
    folder = request.templates
    if folder is None:
        return ()
    # If outputs are written into the folder itself, each compile changes it.
    outputs = (path for path in request.targets.paths.values() if path is not None)
    is_written = any(identity(path.parent) == identity(folder.folder) for path in outputs)
    return (*folder.files, *folder.unread, *(() if is_written else (folder.folder,)))


def _run_then(arguments: argparse.Namespace) -> None:
    import subprocess

    code = subprocess.run(arguments.then, shell=True, check=False).returncode
    if code:
        print_failure(f"'{arguments.then}' ended with exit code {code}", arguments)
