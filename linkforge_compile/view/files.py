"""The files that a robot's shapes are drawn from: meshes, and the materials, textures and buffers that they name.

Each is read within the folders that the compile may read, and is known by a digest of its content. What cannot be shown
is listed with the reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from linkforge_compile.core.meshes import IS_LFS_POINTER, LFS_POINTER
from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.link import Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.formats.mesh_paths import mesh_paths, places_of_files, texture_paths
from linkforge_compile.shape_files import ShapeFiles
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.characters import UnreadableError
from linkforge_compile.source.read_file import TooLargeError, read_bytes
from linkforge_compile.view.named_files import KINDS, MESHES, TEXTURES, named_files

MAX_BYTES = 128 * 1024 * 1024
"""The largest file that is shown."""

MAX_ALL_BYTES = 256 * 1024 * 1024
"""The limit of the size of all files of a robot together; browsers cannot open a larger page."""

MAX_NAMED = 1000
"""The most files that the meshes and materials of a robot may name."""

_DIGITS = 32


class File(NamedTuple):
    """A file with its kind, such as `stl`; `uses` has the digests of the files that it names, by their names in it."""

    name: str
    kind: str
    content: bytes
    uses: Mapping[str, str] = MappingProxyType({})


class Use(NamedTuple):
    """The shapes that name a file: how they write it, their links, and the first place."""

    resource: str
    links: Sequence[str]
    place: Span | None


class MissingFile(NamedTuple):
    """A file that is not shown, as it is written, with the reason and the shapes that have it."""

    resource: str
    reason: str
    use: Use


class RobotFiles(NamedTuple):
    """The files of a robot by digest, the digests of those that its shapes name, and those that are missing.

    `users` has the shapes that name a file, by its digest. `paths` are those of all files on which these depend; some
    may not exist.
    """

    files: Mapping[str, File] = MappingProxyType({})
    digests: Mapping[str, str] = MappingProxyType({})
    users: Mapping[str, Use] = MappingProxyType({})
    missing: Sequence[MissingFile] = ()
    paths: Sequence[Path] = ()


class _Wanted(NamedTuple):
    """A file that shapes name: the kinds that it may have, the links of the shapes, and the first place."""

    kinds: frozenset[str]
    links: dict[str, None]
    place: Span | None


def collect_files(robot: Robot, most: int | None = None) -> RobotFiles:
    """Read the meshes and textures of a robot, and the files that they name; `most` bytes, None for MAX_ALL_BYTES."""
    reader = _Reader(robot, MAX_ALL_BYTES if most is None else most)
    digests, users, missing = dict[str, str](), dict[str, Use](), list[MissingFile]()
    for resource, wanted in _wanted_files(robot).items():
        use = Use(resource, tuple(wanted.links), wanted.place)
        try:
            digests[resource] = reader.read(resource, wanted.kinds)
            users.setdefault(digests[resource], use)
        except UnreadableError as error:
            missing.append(MissingFile(resource, str(error), use))
        missing += (MissingFile(f"{name} in {resource}", reason, use) for name, reason in reader.take_faults())
    paths = dict.fromkeys((*reader.paths, *places_of_files(robot, (*mesh_paths(robot), *texture_paths(robot)))))
    return RobotFiles(reader.files, digests, users, missing, tuple(paths))


def not_reported(missing: Iterable[MissingFile], diagnostics: Iterable[Diagnostic]) -> list[MissingFile]:
    """Return the files without a diagnostic; one may be about several files of a folder and name only the first."""
    missing = tuple(missing)
    places = {place for one in diagnostics for place in (one.span, *(note.span for note in one.notes))}
    reported = {_kind_of_fault(one) for one in missing if one.use.place in places}
    return [one for one in missing if _kind_of_fault(one) not in reported]


def _kind_of_fault(missing: MissingFile) -> tuple[str, str]:
    return missing.resource.rpartition("/")[0], missing.reason


def _wanted_files(robot: Robot) -> dict[str, _Wanted]:
    wanted: dict[str, _Wanted] = {}
    for link in robot.links:
        for shape in link.shapes:
            if isinstance(shape.geometry, Mesh):
                place = _place(shape.geometry.source, "file")
                wanted.setdefault(shape.geometry.resource, _Wanted(MESHES, {}, place)).links[link.name] = None
            if isinstance(shape, Visual) and shape.material and shape.material.texture:
                place = _place(shape.material.source, "texture")
                wanted.setdefault(shape.material.texture, _Wanted(TEXTURES, {}, place)).links[link.name] = None
    return wanted


def _place(source: SourceRef | None, key: str) -> Span | None:
    return source.at(key) if source else None


class _Reader:
    """Reads each file of a robot once."""

    def __init__(self, robot: Robot, most: int) -> None:
        self._finder = ShapeFiles(robot)
        self._digests: dict[Path, str] = {}
        self._faults: list[tuple[str, str]] = []
        self._left = most
        self._named = 0
        self.files: dict[str, File] = {}
        self.paths: list[Path] = []

    def take_faults(self) -> list[tuple[str, str]]:
        """Return the missing files that were named by files read since the last call, with the reasons."""
        faults, self._faults = self._faults, []
        return faults

    def read(self, resource: str, kinds: frozenset[str], folder: Path | None = None) -> str:
        """Return the digest of a file; UnreadableError with the reason if it cannot be shown.

        `folder` is that of the file that names it, None for one that the robot names.
        """
        kind = kind_of(resource)
        if kind not in kinds:
            raise UnreadableError(f"the viewer does not show .{kind}, only .{', .'.join(sorted(kinds))}")
        is_beside = folder is not None and "://" not in resource
        path = self._finder.beside(folder, resource) if folder and is_beside else self._finder.find(resource)
        if path not in self._digests:
            self.paths.append(path)
            self._digests[path] = self._add(path, kind)
        return self._digests[path]

    def _add(self, path: Path, kind: str) -> str:
        content = self._content(path)
        uses = dict(self._named_in(path, kind, content))
        # Two files with the same content may name different files, by the same name in their own folders.
        parts = (kind, *(part for pair in sorted(uses.items()) for part in pair))
        digest = sha256("\0".join(parts).encode("utf-8", "surrogateescape") + b"\0" + content).hexdigest()[:_DIGITS]
        self.files.setdefault(digest, File(path.name, kind, content, uses))
        return digest

    def _content(self, path: Path) -> bytes:
        try:
            content = read_bytes(path, min(MAX_BYTES, self._left), only_regular=True)
        except TooLargeError as error:
            if self._left >= MAX_BYTES:
                raise
            together = f"all files of the robot are larger than {MAX_ALL_BYTES // 1024**2} MiB together"
            raise UnreadableError(together) from error
        if content is None:
            raise UnreadableError("the file is not found")
        if not content.strip():
            raise UnreadableError("it is empty")
        if content.startswith(LFS_POINTER):
            raise UnreadableError(IS_LFS_POINTER)
        self._left -= len(content)
        return content

    def _named_in(self, path: Path, kind: str, content: bytes) -> Iterator[tuple[str, str]]:
        """Yield the files that a file names, by their names in it, with their digests."""
        for name, place, kinds in named_files(kind, content):
            self._named += 1
            if self._named > MAX_NAMED:
                self._faults.append((name, f"its meshes and materials name more than {MAX_NAMED:,} files"))
                return
            try:
                yield name, self.read(place, kinds, path.parent)
            except UnreadableError as error:
                self._faults.append((name, str(error)))


def kind_of(resource: str) -> str:
    """Return the ending of a file's name in lower case, without the dot."""
    ending = resource.lower().rpartition(".")[2]
    return KINDS.get(ending, ending)
