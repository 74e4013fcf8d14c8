"""Read files of limited size."""

from __future__ import annotations

import os
from pathlib import Path

from linkforge_compile.source.characters import UnreadableError, text_of


class TooLargeError(UnreadableError):
    """The file at the path is above the size limit."""


def read_text(path: Path, limit: int, *, only_regular: bool) -> str | None:
    """Return the text of a file, XML in the encoding that it declares; otherwise as `read_bytes`."""
    content = read_bytes(path, limit, only_regular=only_regular)
    return None if content is None else text_of(content)


def read_bytes(path: Path, limit: int, *, only_regular: bool) -> bytes | None:
    """Return the content of a file, None if there is none.

    `only_regular` rejects pipes and terminals, on which reading would block. Raises UnreadableError for a folder and
    the like, TooLargeError above `limit` bytes, of which no more are read.
    """
    try:
        if path.is_dir():
            raise UnreadableError("it is a folder")
        if only_regular and path.exists() and not path.is_file():
            raise UnreadableError("it is not a regular file")
        with path.open("rb") as stream:
            # read(n) allocates n bytes, so ask for no more than the file has; a pipe or /proc reports size 0.
            content = stream.read(min(os.fstat(stream.fileno()).st_size or limit, limit) + 1)
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        raise UnreadableError((error.strerror or type(error).__name__).lower()) from error
    except MemoryError as error:
        raise TooLargeError("it does not fit into memory") from error
    except ValueError as error:  # a NUL in the name
        raise UnreadableError(str(error)) from error
    if len(content) > limit:
        raise TooLargeError(f"it is larger than {limit // 1024**2} MiB")
    return content
