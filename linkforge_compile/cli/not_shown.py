"""Warnings about files of a robot that the viewer does not show."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import TYPE_CHECKING

from linkforge_compile.cli.reports import print_status
from linkforge_compile.cli.specs import count

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.view.files import MissingFile


def report_not_shown(missing: Iterable[MissingFile], arguments: argparse.Namespace) -> None:
    """Print a line for each reason, with the place of the first file."""
    by_reason: dict[str, list[MissingFile]] = defaultdict(list)
    for one in missing:
        by_reason[one.reason].append(one)
    for reason, (first, *others) in by_reason.items():
        place = f"{first.use.place}: " if first.use.place else ""
        what = f"'{first.resource}' and {count(len(others), 'other file')} are" if others else f"'{first.resource}' is"
        print_status(f"{place}warning: {what} not shown: {reason}", arguments)
