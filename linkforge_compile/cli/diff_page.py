"""The page of `linkforge diff --html`: both robots over each other, with what differs in colours."""

from __future__ import annotations

import argparse
import tempfile
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import UsageError
from linkforge_compile.cli.reports import print_status
from linkforge_compile.cli.targets import file_to_write

if TYPE_CHECKING:
    from linkforge_compile.compare import Difference, RemovedName
    from linkforge_compile.core.models.robot import Robot


def require_html(arguments: argparse.Namespace) -> None:
    """UsageError for options of the page without it, and for -o with another ending."""
    if arguments.output is None:
        return
    if not arguments.html:
        raise UsageError("-o is for --html; the text and --json are written to standard output")
    path = file_to_write(arguments.output)
    if path is not None and path.suffix.lower() not in {".html", ".htm"}:
        raise UsageError(f"-o takes a file that ends in .html, found '{arguments.output}'")


def write_page(
    robots: tuple[Robot, Robot],
    labels: tuple[str, str],
    differences: Sequence[Difference],
    removed: Sequence[RemovedName],
    arguments: argparse.Namespace,
) -> None:
    """Write the page to the file of -o, or to a temporary one that is opened in the browser."""
    from linkforge_compile.cli.output import write_document
    from linkforge_compile.view.comparison import make_comparison
    from linkforge_compile.view.html import NoPageError, html_of

    scene, files = make_comparison(*robots, labels, differences, removed)
    try:
        html = html_of(scene, files)
    except NoPageError as error:
        raise UsageError(str(error)) from error
    if arguments.output is not None:
        write_document(html, file_to_write(arguments.output), arguments)
        return
    # It stays, since the browser reads it after this command has ended.
    path = Path(tempfile.mkdtemp(prefix="linkforge-diff-"), "diff.html")
    path.write_text(html, "utf-8")
    print_status(f"wrote {path}", arguments)
    if not webbrowser.open(path.as_uri()):
        print_status("no browser is found to open it; write it to a file with -o FILE.html", arguments)
