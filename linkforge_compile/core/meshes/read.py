"""From the content of a mesh file to the solid that it bounds."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.meshes.faults import MeshError, MeshFault

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from linkforge_compile.core.solid import Solid

    Triangles: TypeAlias = NDArray[np.float64]  # shape (triangles, 3 corners, 3 coordinates)

MAX_TRIANGLES = 400_000
"""What is computed of so many takes less than ten seconds and 512 MB."""

# Of a binary STL file [bytes].
_HEADER, _TRIANGLE = 84, 50

_LFS_POINTER = b"version https://git-lfs"


def solid_in(content: bytes, name: str, *, times: int = 1) -> Solid:
    """Return the solid that a mesh bounds, in the units and the frame of its file; `name` ends in .stl, .obj or .dae.

    Several bodies are one solid; where they overlap, the common part counts for each. A COLLADA file says in what
    unit its numbers are, so they become metres, and its axes are those of its numbers whatever `up_axis` says:
    so does RViz, for which most meshes of URDFs were made. It may have `times` MAX_TRIANGLES.

    Raises:
        MeshError: The file cannot be read or what it holds is no solid. Nothing is mended.

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
        _require_few(len(triangles), MAX_TRIANGLES * times)
        return bounded_solid(triangles)
    except ModuleNotFoundError as error:
        raise MeshError(MeshFault.NO_LIBRARY, (error.name or "trimesh").partition(".")[0]) from error
    except MemoryError as error:
        raise MeshError(MeshFault.TOO_LARGE, "it does not fit into memory") from error


def _read(content: bytes, ending: str, most: int) -> Triangles:
    try:
        with warnings.catch_warnings():
            # What the libraries think of a file, or of each other, is nothing that its user could act on.
            warnings.simplefilter("ignore")
            return _READERS[ending](content, most)
    except (MeshError, ModuleNotFoundError, MemoryError):
        raise
    except Exception as error:  # a stranger's file may bring parsers of three libraries to anything
        reason = " ".join(str(error).split())[:200]
        raise MeshError(MeshFault.UNREADABLE, reason or type(error).__name__) from error


def _require_few(triangles: int, most: int) -> None:
    if triangles > most:
        raise MeshError(MeshFault.TOO_LARGE, f"it has more than {most:,} triangles")


def _stl(content: bytes, most: int) -> Triangles:
    # Counted before a library makes several times their size of them, here and in an OBJ file.
    _require_few(_triangles_of_stl(content), most)
    if _is_binary_stl(content):
        return _by_trimesh(content, "stl")
    if not content.lstrip().lower().startswith(b"solid"):
        reason = "its length is not that of a binary STL file, nor does it begin with 'solid' as an ASCII one"
        raise MeshError(MeshFault.UNREADABLE, reason)
    return _by_trimesh(_utf8(content), "stl")


def _is_binary_stl(content: bytes) -> bool:
    return len(content) >= _HEADER and len(content) == _HEADER + _TRIANGLE * int.from_bytes(content[80:84], "little")


def _triangles_of_stl(content: bytes) -> int:
    return (len(content) - _HEADER) // _TRIANGLE if _is_binary_stl(content) else content.count(b"vertex") // 3


def _obj(content: bytes, most: int) -> Triangles:
    from linkforge_compile.core.meshes.wavefront import may_have_corner_0, triangles_of_faces, wrong_corner

    _require_few(triangles_of_faces(content, most), most)
    # The library takes a corner 0 for the last vertex.
    if may_have_corner_0(content) and (wrong := wrong_corner(content)):
        raise MeshError(MeshFault.UNREADABLE, wrong)
    try:
        return _by_trimesh(_utf8(content), "obj")
    except (IndexError, ValueError, OverflowError) as error:
        if wrong := wrong_corner(content):
            raise MeshError(MeshFault.UNREADABLE, wrong) from error
        raise


def _utf8(content: bytes) -> bytes:
    """Return text of whatever encoding as UTF-8: its numbers stay, and names and comments do not matter here."""
    return content.decode("utf-8", errors="replace").encode()


def _by_trimesh(content: bytes, file_type: str) -> Triangles:
    import logging
    from io import BytesIO

    import numpy as np
    import trimesh

    # Else Python writes its warnings to standard error, of normals and the like that we do not read.
    if not (log := logging.getLogger("trimesh")).handlers:
        log.addHandler(logging.NullHandler())
    scene = trimesh.load_scene(BytesIO(content), file_type=file_type, process=False, skip_materials=True)
    parts = [part.triangles for part in scene.geometry.values() if isinstance(part, trimesh.Trimesh)]
    return np.concatenate([np.zeros((0, 3, 3)), *parts])


def _collada(content: bytes, most: int) -> Triangles:
    from linkforge_compile.core.meshes.collada import collada_triangles

    return collada_triangles(content, most)


_READERS: dict[str, Callable[[bytes, int], Triangles]] = {"stl": _stl, "obj": _obj, "dae": _collada}
