"""Writing output files: all of them whole or none, and only when their bytes change."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from errno import EISDIR
from pathlib import Path

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.cli.telling import line_to_stderr
from linkforge_compile.named_tuple import NamedTuple
from linkforge_compile.roots import Roots, identity


def write_to_stdout(text: str) -> None:
    """Write text to standard output as UTF-8 with line ends as they are; UsageError where it cannot be written."""
    try:
        if sys.stdout is None:
            raise UsageError("cannot write to standard output: it is closed")
        unwritten = memoryview(_bytes_of(text))
        while unwritten:
            # Without a buffer, as PYTHONUNBUFFERED has it, a disk that fills up takes a part and says only how much.
            unwritten = unwritten[sys.stdout.buffer.write(unwritten) :]
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


def refuse_links_out(outputs: Iterable[Path], folders: Iterable[Path], option: str) -> None:
    """Refuse to write where nobody said, through links that a stranger's repository may have laid in the folders."""
    roots = Roots(tuple(Path(identity(folder)) for folder in folders))
    for output in outputs:
        if not roots.hold(output):
            what = f"'{output}' is behind a link that leads out of its folder"
            raise UsageError(f"{what}; remove the link, or write elsewhere with {option}")


def write_if_changed(path: Path, text: str) -> bool:
    """Put `text` into the file as `write_changed` does; return whether it had to be written."""
    return bool(write_changed({path: text}))


def write_changed(texts: Mapping[Path, str]) -> frozenset[Path]:
    """Put each text into its file; return those that had to be written. UsageError where one cannot be: none is then.

    An unchanged file keeps its time stamp, so that builds which depend on it stay still. The new bytes of all are
    written beside their files before each is moved over its own in one step: whoever reads one meanwhile sees the
    old file or the new one.
    """
    with ExitStack() as leftovers:
        every = (_New.of(path, _bytes_of(text), leftovers) for path, text in texts.items())
        news = [new for new in every if new is not None]
        # A move hardly ever fails, but what reads a pipe may be gone.
        for new in sorted(news, key=lambda one: one.beside is not None):
            new.put()
    return frozenset(new.path for new in news)


class _New(NamedTuple):
    """The new bytes of a file that its user calls `path`, and which is `target` once links are followed.

    They stand in the file `beside` it; None for a device or pipe, where there is nothing to move in place.
    """

    path: Path
    target: Path
    content: bytes
    beside: Path | None

    @classmethod
    def of(cls, path: Path, content: bytes, leftovers: ExitStack) -> _New | None:
        """Return them ready to be put, None where the file holds them already; `leftovers` removes what is not put."""
        # A link stays a link: what it points to is replaced.
        target = Path(os.path.realpath(path))
        with _told(path, target):
            if target.is_file() and target.read_bytes() == content:
                return None
            if target.is_dir():
                raise IsADirectoryError(EISDIR, os.strerror(EISDIR))
            # A device or pipe is such as /dev/stdout, or what a shell makes of >(…).
            is_file = target.is_file() or not target.exists()
            return cls(path, target, content, _written_beside(target, content, leftovers) if is_file else None)

    def put(self) -> None:
        with _told(self.path, self.target):
            if self.beside is None:
                self.target.write_bytes(self.content)
            else:
                self.beside.replace(self.target)


@contextmanager
def _told(path: Path, target: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise UsageError(f"cannot write '{path}': {_reason(error, target)}") from error


def _bytes_of(text: str) -> bytes:
    """Return a text in UTF-8, with the bytes of names of files that are no UTF-8 spelled out, as JSON does it."""
    return text.encode("utf-8", "backslashreplace")


def _reason(error: OSError, target: Path) -> str:
    blocked = next((folder for folder in target.parents if folder.exists() and not folder.is_dir()), None)
    return f"'{blocked.name}' is not a folder" if blocked else str(error.strerror)


def _written_beside(target: Path, content: bytes, leftovers: ExitStack) -> Path:
    """Return a new file in the folder of the target, with its permissions, that is flushed to the disk."""
    import tempfile  # which most runs, that change nothing, do not need

    target.parent.mkdir(parents=True, exist_ok=True)
    # A name may be as long as names can be, and this one is longer.
    descriptor, name = tempfile.mkstemp(prefix=f".{target.name[:40]}.", dir=target.parent)
    leftovers.callback(_remove, Path(name))
    with os.fdopen(descriptor, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    Path(name).chmod(_mode_of(target))
    return Path(name)


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()


def _mode_of(target: Path) -> int:
    """Return the file's permissions, those of a new file where there is none: mkstemp's are for the owner only."""
    if target.exists():
        return target.stat().st_mode & 0o7777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
