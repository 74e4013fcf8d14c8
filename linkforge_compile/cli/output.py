"""Writing output files: all of them whole or none, and only when their bytes change."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from errno import EBUSY, EISDIR
from itertools import takewhile
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.cli.exits import UsageError
from linkforge_compile.cli.targets import file_to_write
from linkforge_compile.cli.telling import line_to_stderr
from linkforge_compile.roots import Roots, exists, identity, real_path


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


def place_of(path: Path) -> Path:
    """Return where the bytes of an output go: a link stays a link, and what it leads to is replaced."""
    place = real_path(path)
    # What is still a link leads in a circle.
    if place is None or os.path.islink(place):  # noqa: PTH114 as in `roots`
        what = f"'{path}' is a link that leads to itself, or that may not be followed"
        raise UsageError(f"{what}; write to another place")
    return Path(place)


def refuse_to_replace(made_from: Iterable[Path], outputs: Iterable[Path | None]) -> None:
    """Refuse to write over what a robot is made from, or over another output; None is standard output.

    Such are the URDF of a vendor beside a spec of the same name, and a depfile that is called as the URDF.
    """
    taken = {identity(file) for file in made_from}
    places: set[Path] = set()
    for path in outputs:
        if path is None:
            continue
        place = place_of(path)
        if str(place) in taken:
            raise UsageError(f"'{path}' would be replaced, and the robot is made from it; write to another place")
        # A device, such as /dev/null, takes whatever comes.
        if place in places and (place.is_file() or not place.exists()):
            raise UsageError(f"'{path}' would be written twice, and the second replaces the first; give each a file")
        places.add(place)


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


def write_changed(texts: Mapping[Path, str], stdout: str | None = None) -> frozenset[Path]:
    """Put each text into its file, and one to standard output; return the files that had to be written.

    UsageError where one cannot be: none is then, and those that were moved already are put back. An unchanged file
    keeps its time stamp, so that builds which depend on it stay still. The new bytes of all are written beside their
    files before each is moved over its own in one step: whoever reads one meanwhile sees the old file or the new one.

    Devices, pipes and standard output come last, for what a reader has got cannot be taken back.
    """
    places = {path: place_of(path) for path in texts}
    with without_new_folders(places.values()), ExitStack() as steps:
        every = (_New.of(path, places[path], _bytes_of(text), steps) for path, text in texts.items())
        news = sorted((new for new in every if new is not None), key=lambda one: one.beside is None)
        # Behind the only one comes nothing that could fail.
        is_kept = len(news) > 1 or stdout is not None
        for new in news:
            new.put(steps, is_kept=is_kept)
        if stdout is not None:
            write_to_stdout(stdout)
    return frozenset(new.path for new in news)


@contextmanager
def without_new_folders(places: Iterable[Path]) -> Iterator[None]:
    """Remove the folders that were made for files where that fails, as far as nothing is in them."""
    missing = {folder for place in places for folder in takewhile(lambda one: not exists(one), place.parents)}
    try:
        yield
    except BaseException:
        for folder in sorted(missing, reverse=True):
            with suppress(OSError):
                folder.rmdir()
        raise


class _New(NamedTuple):
    """The new bytes of a file that its user calls `path`, and which is `target` once links are followed.

    They stand in the file `beside` it; None for a device or pipe, where there is nothing to move in place.
    """

    path: Path
    target: Path
    content: bytes
    beside: Path | None

    @classmethod
    def of(cls, path: Path, target: Path, content: bytes, steps: ExitStack) -> _New | None:
        """Return them ready to be put, None where the file holds them already; `steps` removes what is not put."""
        with _told(path, target):
            if target.is_file() and target.read_bytes() == content:
                return None
            if target.is_dir():
                raise IsADirectoryError(EISDIR, os.strerror(EISDIR))
            # A device or pipe is such as /dev/stdout, or what a shell makes of >(…).
            is_file = target.is_file() or not target.exists()
            return cls(path, target, content, _written_beside(target, content, steps) if is_file else None)

    def put(self, steps: ExitStack, *, is_kept: bool) -> None:
        """Put them where they belong; what `is_kept` is put back where one of the `steps` behind this one fails."""
        with _told(self.path, self.target):
            if self.beside is None:
                self.target.write_bytes(self.content)
                return
            old = _second_name(self.target, self.beside, steps) if is_kept and self.target.exists() else None
            self.beside.replace(self.target)
        if is_kept:
            steps.enter_context(self._put_back_on_failure(old))

    @contextmanager
    def _put_back_on_failure(self, old: Path | None) -> Iterator[None]:
        """Put the old file back, None for there was none; a reader of standard output that has enough is no failure."""
        try:
            yield
        except (UsageError, KeyboardInterrupt) as failure:
            try:
                self.target.unlink() if old is None else old.replace(self.target)
            except OSError as error:
                why = f"'{self.path}' is new already and cannot be put back: {error.strerror}"
                raise UsageError(f"{str(failure) or 'interrupted'}; {why}") from error
            raise


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
    if error.errno == EBUSY:
        # Bytes written into it in place would be half a robot to who reads it meanwhile, and for ever if we are killed.
        return f"{error.strerror}; where this file is mounted alone, mount its folder, for a file is replaced whole"
    blocked = next((folder for folder in target.parents if folder.exists() and not folder.is_dir()), None)
    return f"'{blocked.name}' is not a folder" if blocked else str(error.strerror)


def _second_name(target: Path, beside: Path, steps: ExitStack) -> Path:
    """Return another name of a file, in its folder; of a copy where the file cannot have two."""
    name = beside.with_name(f"{beside.name}.old")
    try:
        name.hardlink_to(target)
    except OSError:
        # Some file systems have no links, and Linux makes none of a file of somebody else.
        name = _written_beside(target, target.read_bytes(), steps)
        times = target.stat()
        os.utime(name, ns=(times.st_atime_ns, times.st_mtime_ns))
    else:
        steps.callback(_remove, name)
    return name


def _written_beside(target: Path, content: bytes, steps: ExitStack) -> Path:
    """Return a new file in the folder of the target, with its permissions, that is flushed to the disk."""
    import tempfile  # which most runs, that change nothing, do not need

    target.parent.mkdir(parents=True, exist_ok=True)
    # A name may be as long as names can be, and this one is longer.
    descriptor, name = tempfile.mkstemp(prefix=f".{target.name[:40]}.", dir=target.parent)
    steps.callback(_remove, Path(name))
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
