"""COLLADA scenes: the triangles of every geometry where its nodes place it, in metres.

pycollada reads the document. trimesh's reader of scenes is not used: of 263 files of real robots it gives the same
triangles for 183, others in the last digits or in another order for 79, none for one, and it has no limit on nodes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from io import BytesIO
from typing import TYPE_CHECKING, Any, TypeAlias

import collada
import numpy as np
from collada.polylist import Polylist
from collada.scene import GeometryNode, Node
from collada.triangleset import TriangleSet
from lxml import etree

from linkforge_compile.core.meshes.faults import MeshError, MeshFault
from linkforge_compile.source.xml_tree import safe_parser

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers: TypeAlias = NDArray[np.float64]

MAX_NODES = 100_000

# Appearance and movement: a broken texture is no reason to refuse a shape.
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


def collada_triangles(content: bytes, limit: int) -> Numbers:
    """Return the corners of all triangles of the scene [m], of shape (triangles, 3, 3); at most `limit` of them.

    Nodes place what they hold, `<unit meter>` scales all of it, `<up_axis>` turns nothing.

    Raises:
        MeshError: TOO_LARGE, or UNREADABLE for a document type and for a shape that depends on bones.
        Exception: Any exception of pycollada or lxml for a broken file.

    """
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
    shapes: dict[int, Numbers] = {}
    parts, count = [np.zeros((0, 3, 3))], 0
    for geometry, matrix in _placed(scene.nodes if scene else ()):
        if id(geometry) not in shapes:
            shapes[id(geometry)] = _triangles(geometry)
        part = shapes[id(geometry)]
        count += len(part)
        if count > limit:
            raise MeshError(MeshFault.TOO_LARGE, f"it has more than {limit:,} triangles")
        parts.append(_moved(part, matrix))
    return np.concatenate(parts) * unit


def _unit(root: Any) -> float:  # an element of lxml, whose class its stubs keep private
    """Return how many metres one unit of the file is, 1 by default."""
    node = root.find("{*}asset/{*}unit")
    unit = float(node.get("meter", "1")) if node is not None else 1.0
    if not (math.isfinite(unit) and unit > 0):
        raise MeshError(MeshFault.UNREADABLE, f"its unit of {unit} metres is none")
    return unit


def _placed(nodes: Any) -> Iterator[tuple[Any, Numbers]]:  # pycollada has no types
    """Yield every geometry of a scene, as often as it is placed, with the matrix that takes it to the scene's frame.

    A file of few lines may nest nodes without end, so they are counted.
    """
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


def _triangles(geometry: Any) -> Numbers:
    """Return the triangles of a geometry in its own frame; lines have none."""
    parts = [np.zeros((0, 3, 3))]
    for primitive in geometry.primitives:
        faces = primitive.triangleset() if isinstance(primitive, Polylist) else primitive
        if isinstance(faces, TriangleSet) and faces.vertex is not None:
            parts.append(faces.vertex.astype(np.float64)[faces.vertex_index])
    return np.concatenate(parts)


def _moved(triangles: Numbers, matrix: Numbers) -> Numbers:
    turn, shift = matrix[:3, :3], matrix[:3, 3]
    moved: Numbers = triangles @ turn.T + shift
    # A mirror reverses the order of the corners, and with it inside and outside.
    return moved[:, ::-1] if np.linalg.det(turn) < 0 else moved
