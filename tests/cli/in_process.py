"""`linkforge` as a shell runs it, in this process: a tenth of the time of a process, and the same words and exit code.

What hangs on a process of its own, such as its streams and the order of hashes, is tested by `tests.cli.test_compile`.
"""

import io
import os
import subprocess
from contextlib import ExitStack, chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from unittest import mock

from linkforge_compile.cli.main import main


def linkforge(*words: str, cwd: Path, stdin: str = "", **env: str) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder, and return what it wrote and how it ended."""
    written, told, given = (io.TextIOWrapper(io.BytesIO(text), "utf-8") for text in (b"", b"", stdin.encode()))
    around = (chdir(cwd), redirect_stdout(written), redirect_stderr(told), mock.patch("sys.stdin", given))
    with ExitStack() as stack:
        for one in (*around, mock.patch.dict(os.environ, env)):
            stack.enter_context(one)
        try:
            code: int = main(words)
        except SystemExit as end:  # of argparse
            code = end.code if isinstance(end.code, int) else 1
    return subprocess.CompletedProcess(words, code, _text(written), _text(told))


def _text(stream: io.TextIOWrapper) -> str:
    stream.flush()
    stream.seek(0)
    return stream.read()
