"""Writing output files: whole or not at all, and only when their bytes change."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.cli.telling import line_to_stderr


def write_to_stdout(text: str) -> None:
    """Write text to standard output as UTF-8 with line ends as they are; UsageError where it cannot be written."""
    try:
        if sys.stdout is None:
            raise UsageError("cannot write to standard output: it is closed")
        sys.stdout.buffer.write(_bytes_of(text))
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise UsageError(f"cannot write to standard output: {error.strerror}") from error


def put_json(text: str, output: str | None, *, quiet: bool) -> None:
    """Write JSON to the file of `-o`, None or `-` for standard output; UsageError for a file of another kind.

    What was done is said to standard error unless that is to be `quiet`.
    """
    file = file_to_write(output)
    if file is None:
        write_to_stdout(text)
    elif file.suffix != ".json":
        raise UsageError(f"-o takes a file that ends in .json, found '{output}'")
    else:
        is_new = write_if_changed(file, text)
        if not quiet:
            line_to_stderr(f"wrote {output}" if is_new else f"{output} is up to date")


def refuse_to_replace(made_from: Iterable[Path], outputs: Iterable[Path]) -> None:
    """Refuse to write over what a robot is made from, as the URDF of a vendor beside a spec of the same name."""
    taken = {file.resolve() for file in made_from}
    for path in outputs:
        if path.resolve() in taken:
            raise UsageError(f"'{path}' would be replaced, and the robot is made from it; write to another place")


def write_if_changed(path: Path, text: str) -> bool:
    """Put `text` into the file and return whether it had to be written; UsageError where that cannot be done.

    An unchanged file keeps its time stamp, so that builds which depend on it stay still. The new bytes are
    written beside it and moved over it in one step: whoever reads meanwhile sees the old file or the new one.
    """
    new = _bytes_of(text)
    # A link stays a link: what it points to is replaced.
    target = Path(os.path.realpath(path))
    try:
        if target.is_file() and target.read_bytes() == new:
            return False
        if target.exists() and not target.is_file():
            # A device or pipe, such as /dev/stdout or what a shell makes of >(…): there is nothing to move in place.
            target.write_bytes(new)
            return True
        target.parent.mkdir(parents=True, exist_ok=True)
        _replace(target, new)
    except OSError as error:
        raise UsageError(f"cannot write '{path}': {_reason(error, target)}") from error
    return True


def _bytes_of(text: str) -> bytes:
    """Return a text in UTF-8, with the bytes of names of files that are no UTF-8 spelled out, as JSON does it."""
    return text.encode("utf-8", "backslashreplace")


def _reason(error: OSError, target: Path) -> str:
    blocked = next((folder for folder in target.parents if folder.exists() and not folder.is_dir()), None)
    return f"'{blocked.name}' is not a folder" if blocked else str(error.strerror)


def _replace(target: Path, new: bytes) -> None:
    import tempfile  # which most runs, that change nothing, do not need

    # A name may be as long as names can be, and this one is longer.
    descriptor, beside = tempfile.mkstemp(prefix=f".{target.name[:40]}.", dir=target.parent)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(new)
            file.flush()
            os.fsync(file.fileno())
        Path(beside).chmod(_mode_of(target))
        Path(beside).replace(target)
    except BaseException:
        with suppress(OSError):
            Path(beside).unlink()
        raise


def _mode_of(target: Path) -> int:
    """Return the file's permissions, those of a new file where there is none: mkstemp's are for the owner only."""
    if target.exists():
        return target.stat().st_mode & 0o7777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
