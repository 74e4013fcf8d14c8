"""Where the parts of a robot were written, as comments say it: by files and lines, on every machine the same."""

from __future__ import annotations

import os
from pathlib import Path

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.provenance import Kind, Provenance, outward
from linkforge_compile.syntax import read


def written_at(span: Span) -> Provenance:
    """Return the link of a value that is written at a place, in the `defaults` of its file or elsewhere."""
    return Provenance(Kind.DEFAULT if is_default(span) else Kind.WRITTEN, span)


def is_default(place: Span) -> bool:
    """Whether a place lies in the `defaults` of its file; the file is read again, for `explain` has few places."""
    tree = read(place.file, Diagnostics()) if "defaults" in place.file.text else None
    section = tree.get("defaults") if tree else None
    return section is not None and place.lies_in(section.span)


def origin_of(source: SourceRef, folder: Path | None) -> str:
    """Return `arm.robot.yaml:12, used at robot.robot.yaml:30`; paths are those from the compiled file's folder."""
    links = outward(source.span, source.trail) or ()
    return ", ".join((_place(source.span, folder), *(f"{link.key} at {_place(link.span, folder)}" for link in links)))


def _place(span: Span, folder: Path | None) -> str:
    return f"{_name(span, folder)}:{span.line}"


def _name(span: Span, folder: Path | None) -> str:
    """Return how a file is reached from the folder; its bare name where that would tell of the machine."""
    path = span.file.path
    if path is None or folder is None:
        return Path(span.file.name).name
    whole, start = path.absolute(), folder.absolute()
    try:
        shared = os.path.commonpath((whole, start))
    except ValueError:  # two drives of Windows
        return path.name
    return path.name if Path(shared) == Path(whole.anchor) else Path(os.path.relpath(whole, start)).as_posix()
