"""From the content of a mesh file to the solid that it bounds: trimesh and pycollada read, closed.py integrates."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.exceptions import RobotPhysicsError, ValidationErrorCode
from linkforge_compile.core.meshes.faults import MeshError, MeshFault
from linkforge_compile.core.models.geometry import Geometry, Mesh

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from linkforge_compile.core.resolver import IResourceResolver
    from linkforge_compile.core.solid import Solid

    Triangles: TypeAlias = NDArray[np.float64]  # shape (triangles, 3 corners, 3 coordinates)

MAX_TRIANGLES = 400_000
"""A mesh of this size takes less than ten seconds and 512 MB."""

# The sizes of the header and of a triangle of a binary STL file [bytes].
_HEADER, _TRIANGLE = 84, 50

_LFS_POINTER = b"version https://git-lfs"

_FACE = re.compile(rb"^f((?:.*\\\r?\n)*.*)", re.MULTILINE)  # a backslash continues a line
_CONTINUED = re.compile(rb"\\\r?\n")
_ZERO = re.compile(rb"\s[+-]?0+(?:[/\s]|\Z)")
_VERTEX = re.compile(rb"^v\s", re.MULTILINE)
_NUMBER = re.compile(rb"[+-]?[0-9]{1,30}")  # more digits than any vertex has, and few enough for int()


def solids_of(geometries: Iterable[Geometry], resolver: IResourceResolver) -> dict[Mesh, Solid]:
    """Return each mesh among shapes as a solid in its own frame [m], scaled.

    Raises:
        RobotPhysicsError: NOT_FOUND for a file that cannot be read, the code of a MeshError for one without a solid.

    """
    return {mesh: _solid_of(mesh, resolver).scaled(mesh.scale) for mesh in geometries if isinstance(mesh, Mesh)}


def _solid_of(mesh: Mesh, resolver: IResourceResolver) -> Solid:
    try:
        path = resolver.resolve(mesh.resource)
        return solid_in(path.read_bytes(), path.name)
    except OSError as error:
        code, reason = ValidationErrorCode.NOT_FOUND, error.strerror or "there is no such file"
    except MeshError as error:
        code, reason = error.code, error.message
    message = f"the inertia of mesh '{mesh.resource}' cannot be computed: {reason}; state mass and inertia"
    raise RobotPhysicsError(code, message, target="Mesh", value=mesh.resource)


def solid_in(content: bytes, name: str, *, times: int = 1) -> Solid:
    """Return the solid that a mesh bounds, in the units and the frame of its file; `name` ends in .stl, .obj or .dae.

    Several bodies are one solid; where they overlap, the common part counts for each. The numbers of a COLLADA file are
    converted to metres by its unit, and its axes are kept whatever its `up_axis` is: so does RViz, for which most
    meshes of URDFs were made. The mesh may have `times` MAX_TRIANGLES.

    Raises:
        MeshError: The file cannot be read, or does not hold a solid. Nothing is repaired.

    """
    ending = name.lower().rpartition(".")[2]
    if ending not in _READERS:
        raise MeshError(MeshFault.NO_FORMAT, "its name must end in .stl, .obj or .dae")
    if not content.strip():
        raise MeshError(MeshFault.EMPTY, "the file is empty")
    if content.startswith(_LFS_POINTER):
        raise MeshError(MeshFault.UNREADABLE, "it is a pointer of Git LFS; run 'git lfs pull'")
    try:
        from linkforge_compile.core.meshes.closed import bounded_solid

        triangles = _read(content, ending, MAX_TRIANGLES * times)
        _refuse_more(len(triangles), MAX_TRIANGLES * times)
        return bounded_solid(triangles)
    except ModuleNotFoundError as error:
        raise MeshError(MeshFault.NO_LIBRARY, (error.name or "trimesh").partition(".")[0]) from error
    except MemoryError as error:
        raise MeshError(MeshFault.TOO_LARGE, "it does not fit into memory") from error


def _read(content: bytes, ending: str, limit: int) -> Triangles:
    try:
        with warnings.catch_warnings():
            # Warnings of the libraries about a file, or about one another, are nothing that a user can act on.
            warnings.simplefilter("ignore")
            return _READERS[ending](content, limit)
    except (MeshError, ModuleNotFoundError, MemoryError):
        raise
    except Exception as error:  # three libraries raise anything for a broken file
        reason = " ".join(str(error).split())[:200]
        raise MeshError(MeshFault.UNREADABLE, reason or type(error).__name__) from error


def _refuse_more(triangles: int, limit: int) -> None:
    if triangles > limit:
        raise MeshError(MeshFault.TOO_LARGE, f"it has more than {limit:,} triangles")


def _read_stl(content: bytes, limit: int) -> Triangles:
    size = len(content)
    is_binary = size >= _HEADER and size == _HEADER + _TRIANGLE * int.from_bytes(content[80:84], "little")
    # trimesh needs several times the size of the triangles, so they are counted before, here and for OBJ.
    _refuse_more((size - _HEADER) // _TRIANGLE if is_binary else content.count(b"vertex") // 3, limit)
    if is_binary:
        return _read_by_trimesh(content, "stl")
    if not content.lstrip().lower().startswith(b"solid"):
        reason = "its length is not that of a binary STL file, nor does it begin with 'solid' as an ASCII one"
        raise MeshError(MeshFault.UNREADABLE, reason)
    return _read_by_trimesh(_utf8(content), "stl")


def _read_obj(content: bytes, limit: int) -> Triangles:
    _refuse_more(_count_triangles(content, limit), limit)
    # trimesh reads a corner 0 as the last vertex. A comment after a face may have a 0 as well.
    may_have_corner_0 = any(_ZERO.search(face[1]) for face in _FACE.finditer(content))
    if may_have_corner_0 and (wrong := _find_wrong_corner(content)):
        raise MeshError(MeshFault.UNREADABLE, wrong)
    try:
        return _read_by_trimesh(_utf8(content), "obj")
    except (IndexError, ValueError, OverflowError) as error:
        if wrong := _find_wrong_corner(content):
            raise MeshError(MeshFault.UNREADABLE, wrong) from error
        raise


def _count_triangles(content: bytes, limit: int) -> int:
    """Return how many triangles the faces of an OBJ file make, n - 2 for one of n corners; counts to the limit only."""
    count = 0
    for face in _FACE.finditer(content):
        # One face may have millions of corners.
        count += max(len(_CONTINUED.sub(b"", face[1]).split(None, limit + 3)) - 2, 0)
        if count > limit:
            break
    return count


def _find_wrong_corner(content: bytes) -> str | None:
    """Return what is wrong with the first corner of a face in an OBJ file that is no vertex; None if each is one.

    Corners count from 1, and backwards from -1.
    """
    count = sum(1 for _ in _VERTEX.finditer(content))
    for line, corner in _corners(content):
        if not _NUMBER.fullmatch(corner):
            return f"line {line}: '{corner[:40].decode(errors='replace')}' is no number of a vertex"
        if not 1 <= abs(int(corner)) <= count:
            return f"line {line}: the face has a vertex {int(corner)}, but the file has {count}"
    return None


def _corners(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield for each corner of each face the line at which the face begins and the number of its vertex."""
    line, before = 1, 0
    for face in _FACE.finditer(content):
        line += content.count(b"\n", before, face.start())
        before = face.start()
        for corner in _CONTINUED.sub(b"", face[1]).partition(b"#")[0].split():
            yield line, corner.partition(b"/")[0]


def _utf8(content: bytes) -> bytes:
    """Return text of any encoding as UTF-8: its numbers stay, and names and comments do not matter here."""
    return content.decode("utf-8", errors="replace").encode()


def _read_by_trimesh(content: bytes, file_type: str) -> Triangles:
    import logging
    from io import BytesIO

    import numpy as np
    import trimesh

    # Without a handler, Python writes the log's warnings to standard error, of normals and the like.
    if not (log := logging.getLogger("trimesh")).handlers:
        log.addHandler(logging.NullHandler())
    scene = trimesh.load_scene(BytesIO(content), file_type=file_type, process=False, skip_materials=True)
    parts = [part.triangles for part in scene.geometry.values() if isinstance(part, trimesh.Trimesh)]
    return np.concatenate([np.zeros((0, 3, 3)), *parts])


def _read_collada(content: bytes, limit: int) -> Triangles:
    from linkforge_compile.core.meshes.collada import collada_triangles

    return collada_triangles(content, limit)


_READERS: dict[str, Callable[[bytes, int], Triangles]] = {"stl": _read_stl, "obj": _read_obj, "dae": _read_collada}
