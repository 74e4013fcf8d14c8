"""The text of a file, read with bounds and care: its name may come from a stranger's spec."""

from __future__ import annotations

from pathlib import Path

MAX_BYTES = 16 * 1024 * 1024


class UnreadableError(Exception):
    """There is something at the path, and no text that could be a spec; says why."""


def file_text(path: Path, *, only_regular: bool) -> str | None:
    """Return the text of a file, None where there is none; raise UnreadableError for what is no UTF-8 text.

    `only_regular` refuses pipes and terminals, for which a reader would wait.
    """
    if path.is_dir():
        raise UnreadableError("it is a folder")
    if only_regular and path.exists() and not path.is_file():
        raise UnreadableError("it is no regular file")
    try:
        with path.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        raise UnreadableError((error.strerror or type(error).__name__).lower()) from error
    if len(content) > MAX_BYTES:
        raise UnreadableError(f"it is larger than {MAX_BYTES // 1024**2} MiB")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise UnreadableError(f"it is not UTF-8: line {line} has the byte {content[error.start]:#04x}") from error
