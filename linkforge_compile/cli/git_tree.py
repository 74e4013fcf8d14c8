"""Copies the files of a git revision into a temporary folder, without running anything that the repository configures.

Files come from `git cat-file`, which runs no hooks and no filters; `git archive`, `checkout` and `worktree` would.
"""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path, PurePosixPath
from typing import IO, NamedTuple

from linkforge_compile.cli import UsageError
from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.paths import packages_in_environment

_MAX_ENTRIES = 100_000
_MAX_LISTING_BYTES = 32 * 1024**2
_MAX_DEPTH = 100
_MAX_BYTES = 1024**3

_FOLDER, _SYMLINK, _SUBMODULE = "040000", "120000", "160000"
"""Modes of the entries of a tree."""

_INCOMPLETE = "the revision is not here as a whole; fetch it with 'git fetch --refetch'"

_GIT = ("git", "--no-pager", "--no-optional-locks", "--no-replace-objects", "-c", "core.fsmonitor=false")
"""The command, without the program that a repository may name to watch its files."""


class GitTree(NamedTuple):
    """A copy of the files of a revision: `name` is that of the revision, `top` the repository, `copy` its copy.

    `submodules` are the paths of those that are not copied.
    """

    name: str
    top: Path
    copy: Path
    submodules: frozenset[PurePosixPath]

    def path(self, path: str | Path) -> Path:
        """Return the copy of a file or folder; the path itself for one that is outside of the repository."""
        # The folder may be a link into the repository; a file that is a link is one in the copy too.
        folder, name = (path, "") if Path(path).name == ".." else (Path(path).parent, Path(path).name)
        absolute = Path(os.path.realpath(folder), name)
        return self.copy / absolute.relative_to(self.top) if absolute.is_relative_to(self.top) else Path(path)

    def path_as_typed(self, path: str) -> str:
        """Return the copy of a file; from the working directory for a relative path, as its user wrote it."""
        copy = self.path(path)
        is_copied = copy.is_relative_to(self.copy)
        return os.path.relpath(copy) if is_copied and not Path(path).is_absolute() else str(copy)

    def folder(self, path: str) -> Path:
        """Return the copy of the folder of a package; UsageError if the revision lacks it."""
        copy = self.path(path)
        if copy.is_dir():
            return copy
        raise UsageError(f"there is no folder '{path}' in revision '{self.name}'{self.why_missing(copy)}")

    def why_missing(self, copy: Path) -> str:
        """Return the end of a message about a missing copy that lies in a submodule; empty for another."""
        path = PurePosixPath(copy.relative_to(self.copy).as_posix())
        module = next((one for one in (path, *path.parents) if one in self.submodules), None)
        return f"; submodules, here '{module}', are omitted" if module else ""

    def packages(self) -> dict[str, Path]:
        """Return the copies of packages that the environment finds in the repository, by name.

        An installation with links (`colcon build --symlink-install`) belongs to the folder of its linked package.xml.
        """
        sources = {
            name: Path(os.path.realpath(folder / "package.xml")).parent
            for name, folder in packages_in_environment().items()
        }
        copies = {name: self.path(folder) for name, folder in sources.items() if folder.is_relative_to(self.top)}
        # What is built inside of the repository, and not committed, is read as it is now.
        return {name: copy for name, copy in copies.items() if copy.is_dir()}

    def shown(self, path: Path) -> str | None:
        """Return the name of a file in the copy as git shows it, `HEAD~1:robots/arm.robot.yaml`; None for another."""
        absolute = Path(os.path.abspath(path))  # noqa: PTH100 - links in the copy stay
        return (
            f"{self.name}:{absolute.relative_to(self.copy).as_posix()}" if absolute.is_relative_to(self.copy) else None
        )

    def in_words(self, text: str) -> str:
        """Return a text of a message in which copies have the names that git shows.

        In an option to write they are files of the repository.
        """
        top = os.path.relpath(self.top)
        for copy in (str(self.copy), os.path.relpath(self.copy)):
            option = re.compile(rf"(--package \S+=){re.escape(copy)}(?=/|$)")
            text = option.sub(lambda found: f"{found[1]}{top}", text)
            text = text.replace(f"{copy}/", f"{self.name}:").replace(copy, f"{self.name}:")
        return text


@contextmanager
def copied_tree(revision: str, spec: str) -> Iterator[GitTree]:
    """Copy the files of a revision of the repository that holds a spec; remove the copy at the end.

    Submodules are omitted. UsageError without git, a repository or the revision, and for a spec that it lacks.
    """
    folder = Path(spec).parent
    if not folder.is_dir():
        raise UsageError(f"there is no folder '{folder}'")
    if not revision or revision.startswith("-"):
        raise UsageError(f"--git takes a revision, such as HEAD~1 or a branch, found '{revision}'")
    top = Path(os.path.realpath(_git(folder, "rev-parse", "--show-toplevel").removesuffix("\n")))
    try:
        tree = _git(folder, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{tree}}").strip()
    except UsageError:
        raise UsageError(f"the repository '{top}' has no revision '{revision}'") from None
    with tempfile.TemporaryDirectory(prefix="linkforge-git-") as name:
        entries = _entries(top, tree)
        submodules = frozenset(entry.path for entry in entries if entry.mode == _SUBMODULE)
        copy = GitTree(revision, top, Path(os.path.realpath(name)), submodules)
        try:
            _copy(top, entries, copy.copy)
        except OSError as error:
            raise UsageError(f"cannot copy revision '{revision}' to '{name}': {error.strerror}") from error
        # The top of a repository ends the search for files that a spec may read.
        (copy.copy / ".git").mkdir()
        _require_file(copy, spec)
        yield copy


def _require_file(tree: GitTree, spec: str) -> None:
    path = tree.path(spec)
    if path.is_file():
        return
    if path.is_dir():
        raise UsageError(f"'{spec}' is a folder in revision '{tree.name}'; name a file in it")
    if path.is_symlink():
        target = os.readlink(path)  # noqa: PTH115 - as written
        raise UsageError(f"'{spec}' is a link to '{target}', which revision '{tree.name}' lacks")
    if why := tree.why_missing(path):
        raise UsageError(f"'{spec}' is not in revision '{tree.name}'{why}")
    others = [one for one in sorted(tree.copy.rglob("*")) if one.name == path.name and one.is_file()]
    moved = f"; there is '{others[0].relative_to(tree.copy).as_posix()}'" if others else ""
    near = moved or did_you_mean(path.name, [other.name for other in path.parent.glob("*") if other.is_file()])
    raise UsageError(f"'{spec}' is not in revision '{tree.name}'{near}")


class _Entry(NamedTuple):
    mode: str
    object: str
    path: PurePosixPath


def _copy(top: Path, entries: Iterable[_Entry], target: Path) -> None:
    """Write the files of a tree below a folder, then its links, so that no file is written through one."""
    contents = [entry for entry in entries if entry.mode not in (_FOLDER, _SUBMODULE)]
    links: list[tuple[Path, bytes]] = []
    for entry, content in zip(contents, _contents(top, [entry.object for entry in contents]), strict=True):
        path = target / entry.path
        if entry.mode == _SYMLINK:
            links.append((path, content))
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    for path, content in links:
        # Where case does not matter, the folder `D` of a link may be the link `d`.
        if os.path.realpath(path.parent) != str(path.parent):
            raise _forbidden(path.relative_to(target).as_posix())
        path.parent.mkdir(parents=True, exist_ok=True)
        path.symlink_to(os.fsdecode(content))


def _entries(top: Path, tree: str) -> list[_Entry]:
    """Return the files and folders of a tree; UsageError for too many, and for a path that occurs twice.

    A folder that is a link as well occurs twice; only a forged tree has one.
    """
    # With -t, because a tree may have any number of folders and no file.
    with _streamed(top, "ls-tree", "-r", "-t", "-z", "--full-tree", tree) as process:
        assert process.stdout is not None
        listing = process.stdout.read(_MAX_LISTING_BYTES + 1)
        if listing.count(b"\0") > _MAX_ENTRIES or len(listing) > _MAX_LISTING_BYTES:
            limit = f"{_MAX_ENTRIES:,} files and folders, or {_MAX_LISTING_BYTES // 1024**2} MiB of their names"
            raise UsageError(f"the revision has more than {limit}")
        if process.wait():
            raise UsageError(_INCOMPLETE)
    entries: dict[PurePosixPath, _Entry] = {}
    for line in os.fsdecode(listing).split("\0")[:-1]:
        entry = _entry(line)
        if entries.setdefault(entry.path, entry) is not entry:
            raise _forbidden(str(entry.path))
    return [*entries.values()]


def _entry(line: str) -> _Entry:
    """Parse a line of `git ls-tree`; UsageError for a path that leads elsewhere, which only a forged tree has."""
    facts, _, name = line.partition("\t")
    mode, _, object_ = facts.split(" ")
    path = PurePosixPath(name)
    is_elsewhere = path.is_absolute() or {"..", ".git"} & {part.lower() for part in path.parts}
    if is_elsewhere or os.path.splitdrive(name)[0] or len(path.parts) > _MAX_DEPTH:
        raise _forbidden(name)
    return _Entry(mode, object_, path)


def _forbidden(name: str) -> UsageError:
    return UsageError(f"the revision has a file that may not be written, '{name[:200]}'")


def _contents(top: Path, objects: Sequence[str]) -> Iterator[bytes]:
    """Yield the content of each object, as it is stored; UsageError if all together are too large."""
    # From a file, because a pipe that git does not read yet would block.
    with tempfile.TemporaryFile() as names:
        names.write("".join(f"{one}\n" for one in objects).encode())
        names.seek(0)
        with _streamed(top, "cat-file", "--batch", stdin=names) as process:
            assert process.stdout is not None
            yield from _read_batch(process.stdout, len(objects))


@contextmanager
def _streamed(top: Path, *words: str, stdin: IO[bytes] | None = None) -> Iterator[subprocess.Popen[bytes]]:
    """Run a command of git whose output is read while it runs; end it when enough is read."""
    null = subprocess.DEVNULL
    command, given = [*_GIT, "-C", str(top), *words], null if stdin is None else stdin
    with subprocess.Popen(command, stdin=given, stdout=subprocess.PIPE, stderr=null, env=_environment()) as process:
        try:
            yield process
        finally:
            process.kill()


def _read_batch(stream: IO[bytes], count: int) -> Iterator[bytes]:
    left = _MAX_BYTES
    for _ in range(count):
        # `OBJECT blob SIZE`, the content and a line feed; `OBJECT missing` in a partial clone.
        header = stream.readline().split()
        if len(header) != 3:
            raise UsageError(_INCOMPLETE)
        left -= (size := int(header[2]))
        if left < 0:
            raise UsageError(f"the files of the revision are larger than {_MAX_BYTES // 1024**3} GiB")
        yield stream.read(size)
        stream.read(1)


def _git(folder: Path, *words: str) -> str:
    """Return what a command of git prints; UsageError with the reason if it fails."""
    command = [*_GIT, "-C", str(folder), *words]
    try:
        run = subprocess.run(command, capture_output=True, check=False, stdin=subprocess.DEVNULL, env=_environment())
    except FileNotFoundError:
        raise UsageError("--git needs the command 'git', which is not on the PATH") from None
    if run.returncode:
        reason = os.fsdecode(run.stderr).strip().partition("\n")[0].removeprefix("fatal: ")
        raise UsageError(f"cannot read the git repository of '{folder}': {reason}")
    return os.fsdecode(run.stdout)


def _environment() -> dict[str, str]:
    """Return the environment, in which a partial clone cannot fetch, by a program that the repository may name.

    A hook of git has variables that name its own repository, instead of the one around the spec.
    """
    kept = {name: value for name, value in os.environ.items() if name not in _local_variables()}
    return {**kept, "GIT_ALLOW_PROTOCOL": "none"}


@cache
def _local_variables() -> frozenset[str]:
    """Return the names of the variables by which git finds a repository."""
    command = ("git", "rev-parse", "--local-env-vars")
    run = subprocess.run(command, capture_output=True, check=False, stdin=subprocess.DEVNULL)
    return frozenset(os.fsdecode(run.stdout).split())
