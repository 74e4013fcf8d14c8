"""STL files by their first bytes and their length: whether one is binary, and why one cannot be read."""

from __future__ import annotations

HEADER, TRIANGLE = 84, 50
"""The sizes of the header and of a triangle of a binary file [bytes]."""

_MOST_TRIANGLES = 1 << 24
"""More than any file has: a larger number at its place is something else."""


def count_triangles(start: bytes) -> int:
    """Return how many triangles the header of a binary file states."""
    return int.from_bytes(start[80:HEADER], "little")


def is_binary(start: bytes, length: int) -> bool:
    """Whether a file has the length that its header states, which a file of text may begin with as well."""
    return len(start) >= HEADER and length == HEADER + TRIANGLE * count_triangles(start)


def is_text(start: bytes) -> bool:
    """Whether a file begins as one of text; binary ones may begin with `solid` as well, but have a zero soon."""
    return start.lstrip().lower().startswith(b"solid") and b"\0" not in start


def cut_off(start: bytes, length: int) -> str | None:
    """Return after how many triangles a binary file ends too early; None for any other file."""
    count = count_triangles(start)
    if is_text(start) or not HEADER <= length < HEADER + TRIANGLE * count or count >= _MOST_TRIANGLES:
        return None
    return f"the file ends before its data does, after {(length - HEADER) // TRIANGLE:,} of {count:,} triangles"


def fault_of(start: bytes, length: int) -> str | None:
    """Return why a file is no STL that can be read; None if it may be one."""
    if is_binary(start, length) or is_text(start):
        return None
    neither = "its length is not that of a binary STL file, nor does it begin with 'solid' as an ASCII one"
    return cut_off(start, length) or neither
