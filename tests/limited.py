"""Runs `linkforge` in processes with little memory and time, forked from one that has imported it already."""

import multiprocessing
import os
import resource
import sys
from pathlib import Path
from subprocess import CompletedProcess
from tempfile import TemporaryDirectory

from linkforge_compile.cli.main import main

MEMORY = 512 * 1024**2
SECONDS = 10  # of work: another's load on the machine is not the file's doing
LONGEST_WAIT = 300

_CONTEXT = multiprocessing.get_context("forkserver")
_CONTEXT.set_forkserver_preload([__name__, "linkforge_compile.cli.commands.check", "linkforge_compile.pipeline"])


def run(*words: str, folder: Path) -> CompletedProcess[str]:
    """Run a command in a folder; return its output and exit code, which is negative where a signal ended it."""
    with TemporaryDirectory() as outputs:
        process = _CONTEXT.Process(target=_run, args=(words, folder, outputs))
        process.start()
        process.join(LONGEST_WAIT)
        assert process.exitcode is not None, f"no end within {LONGEST_WAIT} seconds"
        texts = [Path(outputs, name).read_text("utf-8") for name in ("1", "2")]
    return CompletedProcess(words, process.exitcode, *texts)


def _run(words: tuple[str, ...], folder: Path, outputs: str) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    os.chdir(folder)
    for number in (1, 2):
        os.dup2(os.open(Path(outputs, str(number)), os.O_WRONLY | os.O_CREAT), number)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    sys.argv[1:] = words
    sys.exit(main())
