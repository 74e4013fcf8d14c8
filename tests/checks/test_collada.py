"""A first look at COLLADA: the box of its scene is that of all its triangles, read whole by pycollada."""

from pathlib import Path

import numpy as np
import pytest

from linkforge_compile import compile_file
from linkforge_compile.checks.bounding import ScanBudget, corners_of_scene
from linkforge_compile.checks.mesh_files import MeshScan, scan_mesh
from linkforge_compile.core.meshes.collada import collada_triangles
from tests.meshes import GEOMETRY, block, collada

MATRIX = "<matrix>0 -1 0 3  1 0 0 0  0 0 2 -1  0 0 0 1</matrix>"

SCENES = {
    "as it is": f"<node>{GEOMETRY}</node>",
    "moved, turned and scaled": f"<node><translate>1 2 3</translate><rotate>0 0 1 30</rotate>"
    f"<scale>1 2 3</scale>{GEOMETRY}</node>",
    "by a matrix in a node": f"<node>{MATRIX}<node><rotate>0.6 0.8 0 45</rotate>{GEOMETRY}</node></node>",
    "placed twice": f"<node>{GEOMETRY}</node><node><translate>9 0 0</translate>{GEOMETRY}</node>",
    "by an instance": '<node><translate>0 0 5</translate><instance_node url="#arm"/></node>',
}
LIBRARY = f'<node id="arm"><scale>2 1 1</scale>{GEOMETRY}</node>'


def box(corners: np.ndarray) -> list[list[float]]:
    return [corners.min(axis=0).tolist(), corners.max(axis=0).tolist()]


@pytest.mark.parametrize("nodes", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("asset", ["", '<unit name="centimeter" meter="0.01"/>'])
def test_the_box_is_that_of_all_triangles(nodes: str, asset: str):
    content = collada(nodes, asset, LIBRARY, block(1, 2, 4, at=(1, 0, 0)))
    read = collada_triangles(content, 1000).reshape(-1, 3)
    np.testing.assert_allclose(box(np.array(corners_of_scene(content, ScanBudget()))), box(read), rtol=1e-6, atol=1e-9)


def test_a_mesh_in_collada_is_measured_against_the_mass_of_its_link(tmp_path: Path):
    (tmp_path / "a.dae").write_bytes(collada(f"<node>{GEOMETRY}</node>", '<unit name="millimeter" meter="0.001"/>'))
    inertia = "{ixx: 1, iyy: 1, izz: 1}"
    link = f"{{visual: {{mesh: a.dae}}, collision: visual, inertial: {{mass: 70 kg, inertia: {inertia}}}}}"
    spec = tmp_path / "a.robot.yaml"
    spec.write_text(f"linkforge: 1\nname: a\nlinks: {{base: {link}}}\n")
    assert {one.code.id for one in compile_file(spec).diagnostics} == {"LF6031", "LF6032"}


def test_of_long_arrays_the_ends_are_looked_at():
    mesh = block(1, 1, 1)
    for _ in range(4):
        mesh = mesh.subdivide()
    content = collada(f"<node>{GEOMETRY}</node>", mesh=mesh)
    corners = corners_of_scene(content, ScanBudget())
    assert 0 < len(corners) < len(mesh.vertices) / 4
    known = {tuple(corner) for corner in mesh.vertices.tolist()}
    assert {*corners} <= known


@pytest.mark.parametrize(
    "content",
    [
        b"<COLLADA",
        b"<!DOCTYPE a [<!ENTITY b 'c'>]>" + collada(f"<node>{GEOMETRY}</node>").partition(b"?>")[2],
        collada('<node><instance_controller url="#part"/></node>'),
        collada(f"<node><matrix>1 0 0</matrix>{GEOMETRY}</node>"),
        collada(f"<node><translate>1 2</translate>{GEOMETRY}</node>"),
        collada('<node><instance_geometry url="#none"/></node>'),
        collada(
            '<node><instance_node url="#a"/></node>', library_nodes='<node id="a"><instance_node url="#a"/></node>'
        ),
        collada("<node/>"),
        collada(f"<node>{GEOMETRY}</node>", '<unit meter="nan"/>'),
        b'<?xml version="1.0" encoding="foo"?>' + collada(f"<node>{GEOMETRY}</node>").partition(b"?>")[2],
    ],
)
def test_of_what_cannot_be_reported_at_a_look_there_is_no_box(tmp_path: Path, content: bytes):
    (tmp_path / "a.dae").write_bytes(content)
    assert scan_mesh(tmp_path / "a.dae", ScanBudget()) == MeshScan()


def test_a_small_file_that_places_one_shape_without_end_is_left():
    # Two nodes that place the next two, twenty times: a million shapes.
    doubled = [
        f'<node id="n{one}"><instance_node url="#n{one + 1}"/><instance_node url="#n{one + 1}"/></node>'
        for one in range(20)
    ]
    library = "".join(doubled) + f'<node id="n20">{GEOMETRY}</node>'
    content = collada('<node><instance_node url="#n0"/></node>', library_nodes=library)
    budget = ScanBudget(10_000)
    assert corners_of_scene(content, budget) == ()
    # And with it what else the robot has of them.
    assert corners_of_scene(collada(f"<node>{GEOMETRY}</node>"), budget) == ()
    assert corners_of_scene(collada(f"<node>{GEOMETRY}</node>"), ScanBudget(10_000))
