"""Meshes as solid bodies: triangles, read by trimesh or pycollada, and the solid that they bound.

Read only where an inertia is to be computed from a mesh, or collisions are sampled; needs the extra `mesh`.

COLLADA is not read by trimesh: of 263 files of real robots it gives the same triangles as pycollada for 183, others in
the last digits or in another order for 79, none for one, and it has no limit on nodes.
"""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Callable, Iterable, Iterator
from io import BytesIO
from typing import TYPE_CHECKING, Any, TypeAlias

from linkforge_compile.core.exceptions import MeshError, MeshFault, RobotPhysicsError, ValidationErrorCode
from linkforge_compile.core.meshes.stl import HEADER, TRIANGLE, fault_of, is_binary
from linkforge_compile.core.models.geometry import Geometry, Mesh

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from linkforge_compile.core.physics import Solid
    from linkforge_compile.core.resolver import IResourceResolver

    Triangles: TypeAlias = NDArray[np.float64]  # shape (triangles, 3 corners, 3 coordinates)


MAX_TRIANGLES = 400_000
"""A mesh of this size takes less than ten seconds and 512 MB."""

MAX_BYTES = 128 * 1024 * 1024
"""The largest file of a mesh that is read."""

MAX_NODES = 100_000
"""The nodes of a scene of COLLADA: a file of few lines may nest them without end."""

LFS_POINTER = b"version https://git-lfs"
"""How a file begins that Git LFS left where it fetched nothing."""

IS_LFS_POINTER = "it is a pointer of Git LFS; run 'git lfs pull'"

_NO_MEMORY = "it does not fit into memory"

_FACE = re.compile(rb"^f((?:.*\\\r?\n)*.*)", re.MULTILINE)  # a backslash continues a line
_CONTINUED = re.compile(rb"\\\r?\n")
_ZERO = re.compile(rb"\s[+-]?0+(?:[/\s]|\Z)")
_VERTEX = re.compile(rb"^v\s", re.MULTILINE)
_NUMBER = re.compile(rb"[+-]?[0-9]{1,30}")  # more digits than any vertex has, and few enough for int()

# Appearance and movement in COLLADA: a broken texture is no reason to refuse a shape.
_IGNORED = (
    "asset",
    "extra",
    "bind_material",
    "instance_camera",
    "instance_light",
    "library_animation_clips",
    "library_animations",
    "library_cameras",
    "library_controllers",
    "library_effects",
    "library_images",
    "library_lights",
    "library_materials",
    "library_physics_materials",
    "library_physics_models",
    "library_physics_scenes",
)


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
    """Return the solid that a mesh bounds, in the frame of its file; `name` ends in .stl, .obj or .dae.

    Several bodies are one solid; where they overlap, the common part counts for each. The numbers of a COLLADA file are
    converted to metres by its unit, and its axes are kept whatever its `up_axis` is: so does RViz, for which most
    meshes of URDFs were made. The mesh may have `times` MAX_TRIANGLES.

    Raises:
        MeshError: The file cannot be read, or does not hold a solid. Nothing is repaired.

    """
    try:
        from linkforge_compile.core.meshes.closed import bounded_solid

        return bounded_solid(triangles_in(content, name, times=times))
    except ModuleNotFoundError as error:
        raise _no_library(error) from error
    except MemoryError as error:
        raise MeshError(MeshFault.TOO_LARGE, _NO_MEMORY) from error


def triangles_in(content: bytes, name: str, *, times: int = 1) -> Triangles:
    """Return the corners of a mesh's triangles, as (triangles, 3, 3), in the frame of its file; see `solid_in`.

    No other file is opened, whatever the mesh names.

    Raises:
        MeshError: The file cannot be read, or has more than `times` MAX_TRIANGLES.

    """
    ending = name.lower().rpartition(".")[2]
    if ending not in _READERS:
        raise MeshError(MeshFault.NO_FORMAT, "its name must end in .stl, .obj or .dae")
    if not content.strip():
        raise MeshError(MeshFault.EMPTY, "the file is empty")
    if content.startswith(LFS_POINTER):
        raise MeshError(MeshFault.UNREADABLE, IS_LFS_POINTER)
    try:
        triangles = _read(content, ending, MAX_TRIANGLES * times)
    except ModuleNotFoundError as error:
        raise _no_library(error) from error
    except MemoryError as error:
        raise MeshError(MeshFault.TOO_LARGE, _NO_MEMORY) from error
    _refuse_more(len(triangles), MAX_TRIANGLES * times)
    return triangles


def _no_library(error: ModuleNotFoundError) -> MeshError:
    return MeshError(MeshFault.NO_LIBRARY, (error.name or "trimesh").partition(".")[0])


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
    start, size = content[:HEADER], len(content)
    has_bytes = is_binary(start, size)
    # trimesh needs several times the size of the triangles, so they are counted before, here and for OBJ.
    _refuse_more((size - HEADER) // TRIANGLE if has_bytes else content.count(b"vertex") // 3, limit)
    if fault := fault_of(start, size):
        raise MeshError(MeshFault.UNREADABLE, fault)
    return _read_by_trimesh(content if has_bytes else _utf8(content), "stl")


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
    """Return how many triangles the faces of an OBJ file make, n - 2 of n corners; stop at the limit."""
    count = 0
    for face in _FACE.finditer(content):
        # One face may have millions of corners.
        count += max(len(_CONTINUED.sub(b"", face[1]).split(None, limit + 3)) - 2, 0)
        if count > limit:
            break
    return count


def _find_wrong_corner(content: bytes) -> str | None:
    """Return what is wrong with the first corner of a face in an OBJ file that is no vertex, or None.

    Corners count from 1, and backwards from -1.
    """
    count = sum(1 for _ in _VERTEX.finditer(content))
    for line, corner in _corners(content):
        if not _NUMBER.fullmatch(corner):
            return f"line {line}: '{corner[:40].decode(errors='replace')}' is not a vertex coordinate"
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

    import numpy as np
    import trimesh

    # Without a handler, Python writes the log's warnings to standard error, of normals and the like.
    if not (log := logging.getLogger("trimesh")).handlers:
        log.addHandler(logging.NullHandler())
    scene = trimesh.load_scene(BytesIO(content), file_type=file_type, process=False, skip_materials=True)
    parts = [part.triangles for part in scene.geometry.values() if isinstance(part, trimesh.Trimesh)]
    return np.concatenate([np.zeros((0, 3, 3)), *parts])


def collada_triangles(content: bytes, limit: int) -> Triangles:
    """Return the corners of all triangles of the scene [m], at most `limit`, as (triangles, 3, 3).

    Nodes place what they hold, `<unit meter>` scales all of it, `<up_axis>` turns nothing.

    Raises:
        MeshError: TOO_LARGE, or UNREADABLE for a document type and for a shape that depends on bones.
        Exception: Any exception of pycollada or lxml for a broken file.

    """
    import collada
    import numpy as np
    from lxml import etree

    from linkforge_compile.source.xml_tree import safe_parser

    # Entities stay unresolved, and the limits of libxml2 stay on.
    root = etree.fromstring(content, safe_parser(remove_comments=True))
    if root.getroottree().docinfo.internalDTD is not None:
        reason = "it has a document type, whose entities can read other files; delete it"
        raise MeshError(MeshFault.UNREADABLE, reason)
    if root.find(".//{*}instance_controller") is not None:
        raise MeshError(MeshFault.UNREADABLE, "its scene has an 'instance_controller', whose shape is not fixed")
    unit = _unit(root)
    etree.strip_elements(root, *(f"{{*}}{tag}" for tag in _IGNORED), with_tail=False)
    scene = collada.Collada(BytesIO(etree.tostring(root))).scene
    shapes: dict[int, Triangles] = {}
    parts, count = [np.zeros((0, 3, 3))], 0
    for geometry, matrix in _placed(scene.nodes if scene else ()):
        if id(geometry) not in shapes:
            shapes[id(geometry)] = _triangles(geometry)
        part = shapes[id(geometry)]
        count += len(part)
        _refuse_more(count, limit)
        turn, shift = matrix[:3, :3], matrix[:3, 3]
        moved = part @ turn.T + shift
        # A mirror reverses the order of the corners, and with it inside and outside.
        parts.append(moved[:, ::-1] if np.linalg.det(turn) < 0 else moved)
    return np.concatenate(parts) * unit


def _unit(root: Any) -> float:  # an element of lxml, whose class its stubs keep private
    """Return how many metres one unit of the file is, 1 by default."""
    node = root.find("{*}asset/{*}unit")
    unit = float(node.get("meter", "1")) if node is not None else 1.0
    if not (math.isfinite(unit) and unit > 0):
        raise MeshError(MeshFault.UNREADABLE, f"its unit of {unit} metres is none")
    return unit


def _placed(nodes: Any) -> Iterator[tuple[Any, Triangles]]:  # pycollada has no types
    """Yield every geometry of a scene, as often as it is placed, with its matrix to the scene's frame."""
    import numpy as np
    from collada.scene import GeometryNode, Node

    waiting = [(node, np.identity(4)) for node in nodes]
    visited = 0
    while waiting:
        visited += 1
        if visited + len(waiting) > MAX_NODES:
            raise MeshError(MeshFault.TOO_LARGE, f"its scene has more than {MAX_NODES:,} nodes")
        node, around = waiting.pop()
        if isinstance(node, GeometryNode):
            yield node.geometry, around
        elif isinstance(node, Node):
            matrix = around @ node.matrix
            waiting.extend((child, matrix) for child in node.children)


def _triangles(geometry: Any) -> Triangles:
    """Return the triangles of a geometry in its own frame; lines have none."""
    import numpy as np
    from collada.polylist import Polylist
    from collada.triangleset import TriangleSet

    parts = [np.zeros((0, 3, 3))]
    for primitive in geometry.primitives:
        faces = primitive.triangleset() if isinstance(primitive, Polylist) else primitive
        if isinstance(faces, TriangleSet) and faces.vertex is not None:
            parts.append(faces.vertex.astype(np.float64)[faces.vertex_index])
    return np.concatenate(parts)


_READERS: dict[str, Callable[[bytes, int], Triangles]] = {
    "stl": _read_stl,
    "obj": _read_obj,
    "dae": collada_triangles,
}
