"""Runs `linkforge` in this process, which takes a tenth of the time of a new one.

`tests.cli.test_compile` also tests what needs a process of its own, such as its streams and the order of hashes.
"""

import io
import os
import subprocess
from contextlib import ExitStack, chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from unittest import mock

from linkforge_compile.cli.main import main


def linkforge(*words: str, cwd: Path, stdin: str = "", **env: str) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder; return its output and exit code."""
    stdout, stderr, given = (io.TextIOWrapper(io.BytesIO(text), "utf-8") for text in (b"", b"", stdin.encode()))
    contexts = (chdir(cwd), redirect_stdout(stdout), redirect_stderr(stderr), mock.patch("sys.stdin", given))
    with ExitStack() as stack:
        for context in (*contexts, mock.patch.dict(os.environ, env)):
            stack.enter_context(context)
        try:
            code: int = main(words)
        except SystemExit as end:  # of argparse
            code = end.code if isinstance(end.code, int) else 1
    return subprocess.CompletedProcess(words, code, _text(stdout), _text(stderr))


def _text(stream: io.TextIOWrapper) -> str:
    stream.flush()
    stream.seek(0)
    return stream.read()
