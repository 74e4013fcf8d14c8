"""What a person is told when linkforge itself is at fault, and what to report is put where it can be found."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from linkforge_compile._version import __version__
from linkforge_compile.cli.exits import INTERNAL_FAULT, WRONG_USAGE


def confess(fault: Exception, words: Sequence[str]) -> int:
    """Say that this is our fault and where the report is; the traceback itself only where LINKFORGE_DEBUG asks.

    What somebody has made of our templates is his.
    """
    import traceback

    from linkforge_compile.formats.own_templates import TemplateFaultError
    from linkforge_compile.source.characters import on_one_line

    if isinstance(fault, TemplateFaultError):
        print(f"linkforge: {fault}", file=sys.stderr)
        return WRONG_USAGE
    frames = traceback.extract_tb(fault.__traceback__)
    place = "?"
    if frames:
        place = f"{frames[-1].filename.rpartition('linkforge_compile')[2].lstrip('/')}:{frames[-1].lineno}"
    trace = "".join(traceback.format_exception(fault))
    if os.environ.get("LINKFORGE_DEBUG"):
        print(trace, end="", file=sys.stderr)
    about = _about(words)
    print(
        f"linkforge: internal fault: {type(fault).__name__} at {place}: {on_one_line(str(fault))}\n"
        "This is a bug in linkforge, not in your spec. Please report it with the spec and\n"
        f"  {_saved(f'{about}{trace}') or 'what LINKFORGE_DEBUG=1 prints'}\n"
        f"{about}",
        end="",
        file=sys.stderr,
    )
    return INTERNAL_FAULT


def _about(words: Sequence[str]) -> str:
    """Return what runs where, and the command as it was typed."""
    import platform
    import shlex

    from linkforge_compile.source.characters import on_one_line

    system = f"linkforge {__version__}, Python {platform.python_version()}, {platform.platform()}"
    return f"{system}\ncommand: {on_one_line(shlex.join(('linkforge', *words)))}\n"


def _saved(report: str) -> str | None:
    """Put the report into a new temporary file and return its path; None where none can be written."""
    import tempfile

    try:
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", errors="replace", prefix="linkforge-fault-", suffix=".txt", delete=False
        ) as file:
            file.write(report)
    except OSError:
        return None
    return file.name
