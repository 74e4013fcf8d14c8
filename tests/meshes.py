"""Writes mesh files for tests, such as CAD tools export, and faulty ones."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import trimesh
from trimesh import Trimesh

FORMATS = ("stl", "stl_ascii", "obj", "dae")


def moved(mesh: Trimesh, *xyz: float) -> Trimesh:
    copy = mesh.copy()
    copy.apply_translation(xyz)
    return copy


def block(*size: float, at: Sequence[float] = (0, 0, 0)) -> Trimesh:
    return moved(trimesh.creation.box(size), *at)


def turned_inside_out(mesh: Trimesh) -> Trimesh:
    copy = mesh.copy()
    copy.invert()
    return copy


def together(*meshes: Trimesh) -> Trimesh:
    return trimesh.util.concatenate(meshes)


def without_a_face(mesh: Trimesh) -> Trimesh:
    copy = mesh.copy()
    copy.update_faces(np.arange(len(copy.faces)) != 0)
    return copy


def with_a_flipped_face(mesh: Trimesh) -> Trimesh:
    copy = mesh.copy()
    copy.faces[0] = copy.faces[0][::-1]
    return copy


def content(mesh: Trimesh, form: str) -> bytes:
    """Return the content of a mesh file in one of FORMATS."""
    if form == "dae":
        return collada(f"<node>{GEOMETRY}</node>", mesh=mesh)
    written = mesh.export(file_type=form, include_normals=False) if form == "obj" else mesh.export(file_type=form)
    return written.encode() if isinstance(written, str) else written


def ending(form: str) -> str:
    return form.removesuffix("_ascii")


def save(mesh: Trimesh, path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content(mesh, path.suffix[1:].lower()))
    return path


GEOMETRY = '<instance_geometry url="#part"/>'


def collada(nodes: str, asset: str = "", library_nodes: str = "", mesh: Trimesh | None = None) -> bytes:
    """Return a COLLADA file with a mesh as the geometry `part` (default: a cube of edge 2), and a scene of nodes."""
    mesh = mesh or block(2, 2, 2)
    positions = " ".join(map(repr, mesh.vertices.ravel().tolist()))
    indices = " ".join(map(str, mesh.faces.ravel()))
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset>{asset}</asset>
  <library_images><image id="lost"><init_from>nowhere.png</init_from></image></library_images>
  <library_geometries><geometry id="part"><mesh>
    <source id="corners">
      <float_array id="numbers" count="{mesh.vertices.size}">{positions}</float_array>
      <technique_common><accessor source="#numbers" count="{len(mesh.vertices)}" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common>
    </source>
    <vertices id="vertices"><input semantic="POSITION" source="#corners"/></vertices>
    <triangles count="{len(mesh.faces)}">
      <input semantic="VERTEX" source="#vertices" offset="0"/><p>{indices}</p>
    </triangles>
  </mesh></geometry></library_geometries>
  <library_nodes>{library_nodes}</library_nodes>
  <library_visual_scenes><visual_scene id="scene">{nodes}</visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>""".encode()
