"""The text of a file, read with bounds and care: its name may come from a stranger's spec."""

from __future__ import annotations

import os
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from pathlib import Path

from linkforge_compile.limits import MAX_FILE_BYTES


class UnreadableError(Exception):
    """There is something at the path, and no text that could be a spec; says why, and of which byte if of one."""

    def __init__(self, reason: str, undecoded: UnicodeDecodeError | None = None) -> None:
        self.undecoded = undecoded
        super().__init__(reason)


class TooLargeError(UnreadableError):
    """There is a file at the path, and it is larger than anybody should read."""


def file_text(path: Path, *, only_regular: bool) -> str | None:
    """Return the text of a file, None where there is none; raise UnreadableError for what is no UTF-8 text.

    `only_regular` refuses pipes and terminals, for which a reader would wait.
    """
    content = file_bytes(path, MAX_FILE_BYTES, only_regular=only_regular)
    return None if content is None else utf8_text(content)


def utf8_text(content: bytes) -> str:
    """Return the content of a file as text; raise UnreadableError for what is none in UTF-8."""
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        if content.startswith((BOM_UTF16_LE, BOM_UTF16_BE)):
            raise UnreadableError("it is UTF-16, as PowerShell writes; save it as UTF-8") from error
        line = error.object.count(b"\n", 0, error.start) + 1
        reason = f"it is not UTF-8: line {line} has the byte {error.object[error.start]:#04x}; save it as UTF-8"
        raise UnreadableError(reason, error) from error


def file_bytes(path: Path, limit: int, *, only_regular: bool) -> bytes | None:
    """Return what is in a file, None where there is none; raise UnreadableError for what has no content.

    Raises TooLargeError beyond `limit` bytes, of which no more are read.
    """
    try:
        if path.is_dir():
            raise UnreadableError("it is a folder")
        if only_regular and path.exists() and not path.is_file():
            raise UnreadableError("it is no regular file")
        with path.open("rb") as stream:
            # Python makes room for all that is asked for. What is no file on a disk has no size, or says 0.
            content = stream.read(min(os.fstat(stream.fileno()).st_size or limit, limit) + 1)
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        raise UnreadableError((error.strerror or type(error).__name__).lower()) from error
    except MemoryError as error:
        raise TooLargeError("it does not fit into memory") from error
    except ValueError as error:
        # A name with a NUL in it, which no file can have.
        raise UnreadableError(str(error)) from error
    if len(content) > limit:
        raise TooLargeError(f"it is larger than {limit // 1024**2} MiB")
    return content
