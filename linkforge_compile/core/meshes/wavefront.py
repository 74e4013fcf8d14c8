"""OBJ files, beside the library that reads them: how many triangles their faces make, and which corner is wrong."""

from __future__ import annotations

import re
from collections.abc import Iterator

_FACE = re.compile(rb"^f((?:.*\\\r?\n)*.*)", re.MULTILINE)  # a backslash continues a line
_CONTINUED = re.compile(rb"\\\r?\n")
_ZERO = re.compile(rb"\s[+-]?0+(?:[/\s]|\Z)")
_VERTEX = re.compile(rb"^v\s", re.MULTILINE)
_NUMBER = re.compile(rb"[+-]?[0-9]{1,30}")  # of more digits than any number of vertices, and read in no time


def triangles_of_faces(content: bytes, most: int) -> int:
    """Return how many triangles the faces make, n - 2 where one has n corners; beyond `most` it stops to count."""
    count = 0
    for face in _FACE.finditer(content):
        # One face may have millions of corners: no more of them are split off than tell.
        count += max(len(_CONTINUED.sub(b"", face[1]).split(None, most + 3)) - 2, 0)
        if count > most:
            break
    return count


def may_have_corner_0(content: bytes) -> bool:
    """Whether a face seems to have one: a comment behind a face may have a 0 as well."""
    return any(_ZERO.search(face[1]) for face in _FACE.finditer(content))


def wrong_corner(content: bytes) -> str | None:
    """Return what is wrong with the first corner of a face that is no vertex of the file; None where each is one.

    Corners count from 1, and backwards from -1.
    """
    count = sum(1 for _ in _VERTEX.finditer(content))
    for line, corner in _corners(content):
        if not _NUMBER.fullmatch(corner):
            return f"line {line}: '{corner[:40].decode(errors='replace')}' is no number of a vertex"
        if not 1 <= abs(int(corner)) <= count:
            return f"line {line}: the face has a vertex {int(corner)}, but the file has {count}"
    return None


def _corners(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield for each corner of each face the line at which the face begins and the number of its vertex."""
    line, before = 1, 0
    for face in _FACE.finditer(content):
        line += content.count(b"\n", before, face.start())
        before = face.start()
        for corner in _CONTINUED.sub(b"", face[1]).partition(b"#")[0].split():
            yield line, corner.partition(b"/")[0]
