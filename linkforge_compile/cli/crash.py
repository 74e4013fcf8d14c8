"""Reports a bug in linkforge: a short message for the user, and a file with the traceback to send."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from linkforge_compile._version import __version__
from linkforge_compile.cli.exits import INTERNAL_FAULT, WRONG_USAGE


def report_crash(error: Exception, words: Sequence[str]) -> int:
    """Print what happened and where the report is saved; print the traceback only if LINKFORGE_DEBUG is set.

    An error in an edited copy of linkforge's own templates is reported as that. Return the exit code.
    """
    import traceback

    from linkforge_compile.formats.own_templates import TemplateFaultError
    from linkforge_compile.source.characters import on_one_line

    if isinstance(error, TemplateFaultError):
        print(f"linkforge: {error}", file=sys.stderr)
        return WRONG_USAGE
    frames = traceback.extract_tb(error.__traceback__)
    place = "?"
    if frames:
        place = f"{frames[-1].filename.rpartition('linkforge_compile')[2].lstrip('/')}:{frames[-1].lineno}"
    trace = "".join(traceback.format_exception(error))
    if os.environ.get("LINKFORGE_DEBUG"):
        print(trace, end="", file=sys.stderr)
    about = _describe_run(words)
    print(
        f"linkforge: internal fault: {type(error).__name__} at {place}: {on_one_line(str(error))}\n"
        "This is a bug in linkforge, not in your spec. Please report it with the spec and\n"
        f"  {_save(f'{about}{trace}') or 'what LINKFORGE_DEBUG=1 prints'}\n"
        f"{about}",
        end="",
        file=sys.stderr,
    )
    return INTERNAL_FAULT


def _describe_run(words: Sequence[str]) -> str:
    """Return the versions, the platform and the command line."""
    import platform
    import shlex

    from linkforge_compile.source.characters import on_one_line

    system = f"linkforge {__version__}, Python {platform.python_version()}, {platform.platform()}"
    return f"{system}\ncommand: {on_one_line(shlex.join(('linkforge', *words)))}\n"


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
