"""Read the bytes and the text of a file of limited size; an untrusted spec may have chosen its name."""

from __future__ import annotations

import os
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from pathlib import Path

from linkforge_compile.limits import MAX_FILE_BYTES
from linkforge_compile.source.characters import EncodingError, begins_xml, xml_text


class UnreadableError(Exception):
    """There is something at the path that cannot be read as text; `undecoded` has the byte at fault, if any."""

    def __init__(self, reason: str, undecoded: UnicodeDecodeError | None = None) -> None:
        self.undecoded = undecoded
        super().__init__(reason)


class TooLargeError(UnreadableError):
    """The file at the path is above the size limit."""


def read_utf8(path: Path, *, only_regular: bool) -> str | None:
    """Return the text of a UTF-8 file, None if there is no file.

    `only_regular` rejects pipes and terminals, on which reading would block. Raises UnreadableError.
    """
    content = read_bytes(path, MAX_FILE_BYTES, only_regular=only_regular)
    return None if content is None else _decode_utf8(content)


def read_xml(path: Path, *, only_regular: bool) -> str | None:
    """Return the text of an XML file in the encoding that it declares, None if there is no file."""
    content = read_bytes(path, MAX_FILE_BYTES, only_regular=only_regular)
    return None if content is None else _decode_xml(content)


def read_spec(path: Path, *, only_regular: bool) -> str | None:
    """Return the text of a spec, which is UTF-8, or of XML that was passed as one; None if there is no file."""
    content = read_bytes(path, MAX_FILE_BYTES, only_regular=only_regular)
    if content is None:
        return None
    return _decode_xml(content) if begins_xml(content) else _decode_utf8(content)


def read_bytes(path: Path, limit: int, *, only_regular: bool) -> bytes | None:
    """Return the content of a file, None if there is none.

    Raises UnreadableError for a folder and the like, TooLargeError above `limit` bytes, of which no more are read.
    """
    try:
        if path.is_dir():
            raise UnreadableError("it is a folder")
        if only_regular and path.exists() and not path.is_file():
            raise UnreadableError("it is no regular file")
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


def _decode_utf8(content: bytes) -> str:
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        if content.startswith((BOM_UTF16_LE, BOM_UTF16_BE)):
            raise UnreadableError("it is UTF-16, as PowerShell writes; save it as UTF-8") from error
        line = error.object.count(b"\n", 0, error.start) + 1
        reason = f"it is not UTF-8: line {line} has the byte {error.object[error.start]:#04x}; save it as UTF-8"
        raise UnreadableError(reason, error) from error


def _decode_xml(content: bytes) -> str:
    try:
        return xml_text(content)
    except EncodingError as error:
        raise UnreadableError(str(error), error.undecoded) from error
