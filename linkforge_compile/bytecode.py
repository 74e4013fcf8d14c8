"""What is made of our own files and is the same in every process: kept as Python keeps its bytecode of them.

It lies at the same place, `__pycache__` beside a module or below PYTHONPYCACHEPREFIX, and obeys the same switch,
PYTHONDONTWRITEBYTECODE. Of Python's sources that it was made from it asks what Python asks, their time and size. Any
other file is read: where all times are set to one, as reproducible archives have them, a release that changes one
character of a template would otherwise go unnoticed.
"""

from __future__ import annotations

import marshal
import os
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from importlib.util import MAGIC_NUMBER, cache_from_source, source_hash
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

# Two pre-releases of Python may have one tag and two kinds of bytecode.
_FOR = f"{sys.implementation.cache_tag}-{MAGIC_NUMBER[:2].hex()}"

_HASH_BYTES = 8
"""A file begins with a hash of the rest: marshal trusts what it finds, and code with a bit that fell over may crash."""


def _stamp(files: Iterable[Path]) -> str:
    """Return what changes when one of the files does, or its name; OSError where one is not there."""
    return " ".join(f"{file.name}:{_stamp_of(file)}" for file in files)


def _stamp_of(file: Path) -> str:
    if file.suffix != ".py":
        return source_hash(file.read_bytes()).hex()
    status = file.stat()
    return f"{status.st_mtime_ns}:{status.st_size}"


def kept(module: str, name: str, files: Iterable[Path], make: Callable[[], T]) -> T:
    """Return what `make` makes of plain values or code, from the file beside a module where an earlier process left it.

    `files` are all that it is made from, the modules that make it among them. What changes while it is made is made
    again by the next process.
    """
    place = Path(cache_from_source(module)).with_name(f"{name}.{_FOR}.marshal")
    try:
        made_from = _stamp(files)
    except OSError:
        return make()  # somebody is replacing them
    content = _left(place)
    if content is not None:
        left_from, left = marshal.loads(content)
        if left_from == made_from:
            value: T = left
            return value
    made = make()
    if not sys.dont_write_bytecode:
        with suppress(OSError):
            # The type is ignored: only marshal knows which values are plain; it raises ValueError for another.
            _leave(place, marshal.dumps((made_from, made)))  # type: ignore[arg-type]
    return made


def _left(place: Path) -> bytes | None:
    """Return what an earlier process left at a place; None for nothing, and for what is not as it was left."""
    try:
        whole = place.read_bytes()
    except OSError:
        return None
    content = whole[_HASH_BYTES:]
    return content if source_hash(content) == whole[:_HASH_BYTES] else None


def _leave(place: Path, content: bytes) -> None:
    """Put a file in its place in one step, since another process may read it meanwhile."""
    place.parent.mkdir(parents=True, exist_ok=True)
    beside = place.with_name(f"{place.name}.{os.getpid()}")
    try:
        beside.write_bytes(source_hash(content) + content)
        beside.replace(place)
    finally:
        beside.unlink(missing_ok=True)
