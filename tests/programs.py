"""Finds the external programs that the tests run."""

import os
import shutil
import sys
from pathlib import Path

import pytest

HEEDING = "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler)"
COMMAND = "from linkforge_compile.cli.main import main; sys.exit(main(sys.argv[1:]))"


def interruptible(*words: str) -> list[str]:
    """Return the command line of `linkforge WORDS` that heeds SIGINT.

    A shell that runs the tests in its background has them, and what they start, ignore the signal.
    """
    return [sys.executable, "-c", f"{HEEDING}; {COMMAND}", *words]


def program(name: str) -> str:
    """Return the path of a program; skip the test if it is absent, or fail in CI, which has all of them."""
    # pip installs some beside the interpreter, whose folder need not be on the PATH.
    found = shutil.which(name) or shutil.which(name, path=str(Path(sys.executable).parent))
    if found is None and os.environ.get("LINKFORGE_REQUIRE_SHARED"):
        pytest.fail(f"there is no program '{name}'")
    if found is None:
        pytest.skip(f"there is no program '{name}'")
    return found
