"""Meshes as solids: equal to the primitives whose shape they have, and refused where they are no solid."""

import math
import struct
import subprocess
import sys
from contextlib import suppress
from typing import NoReturn

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from linkforge_compile.core import (
    Box,
    FileSystemResolver,
    Inertial,
    InertiaTensor,
    Mesh,
    RobotBuilder,
    Sphere,
    Transform,
    Vector3,
)
from linkforge_compile.core import meshes as collada_reader
from linkforge_compile.core.exceptions import RobotPhysicsError, ValidationErrorCode
from linkforge_compile.core.meshes import MeshError, MeshFault, closed, solid_in
from linkforge_compile.core.meshes.closed import bounded_solid
from linkforge_compile.core.physics import Solid, calculate_inertia, inertial_of_shapes
from tests.meshes import (
    FORMATS,
    GEOMETRY,
    block,
    collada,
    content,
    ending,
    moved,
    save,
    together,
    turned_inside_out,
    with_a_flipped_face,
    without_a_face,
)


def solid(mesh: trimesh.Trimesh, form: str = "stl") -> Solid:
    return solid_in(content(mesh, form), f"part.{ending(form)}")


def fault(data: bytes, name: str = "part.stl") -> MeshError:
    with pytest.raises(MeshError) as caught:
        solid_in(data, name)
    return caught.value


def entries(tensor: InertiaTensor) -> tuple[float, ...]:
    return (tensor.ixx, tensor.iyy, tensor.izz, tensor.ixy, tensor.ixz, tensor.iyz)


@pytest.mark.parametrize("form", FORMATS)
def test_a_meshed_box_is_the_box(form):
    part = solid(block(1, 2, 4), form)
    assert part.volume == 8
    assert part.centre == Vector3(0, 0, 0)
    assert part.size == Vector3(1, 2, 4)
    assert entries(part.inertia(12)) == pytest.approx(entries(calculate_inertia(Box(Vector3(1, 2, 4)), 12)), rel=1e-12)


@pytest.mark.parametrize("form", FORMATS)
def test_a_box_far_from_its_origin_is_as_exact(form):
    part = solid(block(0.5, 0.25, 1, at=(1024, 0, -512)), form)
    assert part.centre == Vector3(1024, 0, -512)
    assert entries(part.inertia(1)) == pytest.approx(
        entries(calculate_inertia(Box(Vector3(0.5, 0.25, 1)), 1)), rel=1e-9
    )


@pytest.mark.parametrize("form", FORMATS)
def test_a_meshed_cylinder_is_the_prism_that_its_facets_make(form):
    radius, length, facets = 0.5, 2.0, 64
    part = solid(trimesh.creation.cylinder(radius, length, sections=facets), form)
    angle = 2 * math.pi / facets
    area = facets / 2 * radius**2 * math.sin(angle)
    along = radius**2 * (2 + math.cos(angle)) / 6  # of a unit mass; the textbook's for a regular polygon
    across = along / 2 + length**2 / 12
    assert part.volume == pytest.approx(area * length, rel=1e-6)
    assert entries(part.inertia(1))[:3] == pytest.approx((across, across, along), rel=1e-6)
    assert entries(part.inertia(1))[3:] == pytest.approx((0, 0, 0), abs=1e-7)


def test_a_finely_meshed_ball_comes_near_the_sphere_from_inside():
    part, ball = solid(trimesh.creation.icosphere(subdivisions=5, radius=0.1)), Sphere(0.1)
    assert 0.999 * ball.volume() < part.volume < ball.volume()
    assert part.inertia(1).ixx == pytest.approx(calculate_inertia(ball, 1).ixx, rel=1e-3)


@pytest.mark.parametrize("form", ["stl_ascii", "obj"])
def test_names_and_comments_may_be_of_any_encoding(form):
    data = content(block(1, 2, 4), form)
    data = data.replace(b"solid", "solid Gelenkträger".encode("latin-1"), 1)
    assert solid_in(b"# \xe4\n" * (form == "obj") + data, f"part.{ending(form)}").volume == 8


def test_several_bodies_are_one_solid():
    part = solid(together(block(2, 2, 2, at=(3, 0, 0)), block(2, 2, 2, at=(-3, 0, 0))))
    body = inertial_of_shapes([(Box(Vector3(2, 2, 2)), Transform(Vector3(side, 0, 0))) for side in (3, -3)], density=1)
    assert (part.volume, part.centre) == (body.mass, body.origin.xyz)
    assert entries(part.inertia(body.mass)) == pytest.approx(entries(body.inertia))


def test_bodies_that_touch_along_an_edge_are_two():
    assert solid(together(block(2, 2, 2), block(2, 2, 2, at=(2, 2, 0)))).volume == 16


def test_a_body_that_faces_inwards_inside_another_is_a_hollow():
    part = solid(together(block(4, 4, 4), turned_inside_out(block(2, 2, 2, at=(0.5, 0, 0)))))
    assert part.volume == 64 - 8
    assert part.centre.x == pytest.approx(-0.5 * 8 / 56)


@given(
    scale=st.tuples(*[st.sampled_from([-2.0, -1.0, -0.01, 0.01, 0.5, 1.0, 3.0])] * 3),
    size=st.tuples(*[st.floats(0.5, 5)] * 3),
    at=st.tuples(*[st.floats(-10, 10)] * 3),
)
@settings(max_examples=20, deadline=None)
def test_a_scaled_solid_is_the_solid_of_the_scaled_mesh(scale, size, at):
    wedge = trimesh.creation.extrude_triangulation([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], 1.0)
    wedge.apply_scale(size)
    wedge.apply_translation(at)
    factors = Vector3(*scale)
    scaled = wedge.copy()
    scaled.apply_transform(np.diag([*scale, 1.0]))  # trimesh turns the faces around where it mirrors
    ours, theirs = bounded_solid(wedge.triangles).scaled(factors), bounded_solid(scaled.triangles)
    assert ours.volume == pytest.approx(theirs.volume, rel=1e-9)
    assert tuple(ours.centre) == pytest.approx(tuple(theirs.centre), abs=1e-9)
    assert entries(ours.inertia(1)) == pytest.approx(entries(theirs.inertia(1)), abs=1e-9 * max(theirs.size) ** 2)
    assert tuple(ours.size) == pytest.approx(tuple(theirs.size), abs=1e-9)


def test_a_scale_that_leaves_no_volume_is_refused():
    with pytest.raises(RobotPhysicsError, match="takes the volume of the mesh to 0"):
        solid(block(1, 1, 1)).scaled(Vector3(1e-200, 1e-200, 1))


def test_a_mesh_and_a_primitive_weigh_together_as_two_primitives():
    pose = Transform(Vector3(1, 2, 3), Vector3(0.3, -0.4, 0.5))
    mesh = Mesh("part.stl", Vector3(0.5, 1, 1))
    shapes = [(mesh, pose), (Sphere(0.5), Transform(Vector3(0, 0, 1)))]
    as_box = [(Box(Vector3(0.5, 2, 3)), pose), shapes[1]]
    solids = {mesh: solid(block(1, 2, 3)).scaled(mesh.scale)}
    for quantity in ({"mass": 5.0}, {"density": 700.0}):
        assert_same(inertial_of_shapes(shapes, **quantity, meshes=solids), inertial_of_shapes(as_box, **quantity))


def test_the_pose_of_a_mesh_moves_and_turns_its_centre():
    mesh = Mesh("part.stl")
    quarter = Transform(Vector3(0, 0, 1), Vector3(0, 0, math.pi / 2))
    body = inertial_of_shapes([(mesh, quarter)], mass=1, meshes={mesh: solid(block(1, 2, 3, at=(4, 0, 0)))})
    assert tuple(body.origin.xyz) == pytest.approx((0, 4, 1))
    assert entries(body.inertia) == pytest.approx(entries(calculate_inertia(Box(Vector3(2, 1, 3)), 1)), abs=1e-12)


def assert_same(left: Inertial, right: Inertial) -> None:
    assert left.mass == pytest.approx(right.mass)
    assert tuple(left.origin.xyz) == pytest.approx(tuple(right.origin.xyz))
    assert entries(left.inertia) == pytest.approx(entries(right.inertia))


# What is no solid


def test_a_hole_is_reported_with_its_size_and_place():
    error = fault(content(without_a_face(block(2, 2, 2)), "stl"))
    assert (error.fault, error.code) == (MeshFault.OPEN, ValidationErrorCode.MESH_BOUNDARY_EDGE)
    assert error.message.startswith("3 of its 18 edges are open, the first at [")


def test_a_hole_is_reported_with_its_body():
    mesh = together(block(2, 2, 2), without_a_face(block(2, 2, 2, at=(5, 0, 0))), block(2, 2, 2, at=(9, 0, 0)))
    assert (
        "3 of its 54 edges are open, in 1 of its 3 bodies, the first at ["
        in fault(content(mesh, "obj"), "a.obj").message
    )


@pytest.mark.parametrize(
    ("mesh", "kind", "message"),
    [
        (with_a_flipped_face(block(2, 2, 2)), MeshFault.TWISTED, "3 of its 18 edges are run the same way by both"),
        (turned_inside_out(block(2, 2, 2)), MeshFault.INSIDE_OUT, "its triangles face inwards"),
        (
            together(block(2, 2, 2), turned_inside_out(block(1, 1, 1, at=(3, 0, 0)))),
            MeshFault.INSIDE_OUT,
            "1 of its 2 bodies face inwards without being a hollow of another",
        ),
        (block(2, 2, 0), MeshFault.FLAT, "it encloses no volume"),
        (block(2, 0, 0), MeshFault.FLAT, "no triangle of it has a surface"),
        (block(0, 0, 0), MeshFault.FLAT, "all its corners are one point"),
        (moved(block(1, 1, 1), 1e60, 0, 0), MeshFault.UNREADABLE, "it has coordinates that no shape has"),
    ],
)
def test_what_is_no_solid_is_refused(mesh, kind, message):
    error = fault(content(mesh, "obj"), "part.obj")
    assert error.fault is kind
    assert error.message.startswith(message)


@pytest.mark.parametrize(
    ("data", "name", "kind"),
    [
        (b"", "part.stl", MeshFault.EMPTY),
        (b"solid part\nendsolid part\n", "part.stl", MeshFault.EMPTY),
        (b"\0" * 84, "part.stl", MeshFault.EMPTY),
        (b"\0" * 80 + b"\xff\xff\xff\xff" + b"\0" * 50, "part.stl", MeshFault.UNREADABLE),
        (b"solid\n" + b"vertex 1 2\n" * 2 + b"endsolid", "part.stl", MeshFault.UNREADABLE),
        (b"\0" * 80 + struct.pack("<I12fH", 1, *[math.nan] * 12, 0), "part.stl", MeshFault.UNREADABLE),
        (b"", "part.obj", MeshFault.EMPTY),
        (b"v 0 0 0\nv 1 0 0\n", "part.obj", MeshFault.EMPTY),
        (b"v 0 0 0\nf 1 2 3\n", "part.obj", MeshFault.UNREADABLE),
        (b"v 0 0 0\nf -9 x 3\n", "part.obj", MeshFault.UNREADABLE),
        (b"", "part.dae", MeshFault.EMPTY),
        (b"<COLLADA>", "part.dae", MeshFault.UNREADABLE),
        (b"PK\x03\x04", "part.dae", MeshFault.UNREADABLE),
        (collada('<node><instance_geometry url="#lost"/></node>'), "part.dae", MeshFault.UNREADABLE),
        (collada('<node><instance_controller url="#skin"/></node>'), "part.dae", MeshFault.UNREADABLE),
        (collada(GEOMETRY, asset='<unit meter="0"/>'), "part.dae", MeshFault.UNREADABLE),
        (collada("<node/>"), "part.dae", MeshFault.EMPTY),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "part.stl", MeshFault.UNREADABLE),
        (b"ply\n", "part.ply", MeshFault.NO_FORMAT),
        (b"", "part", MeshFault.NO_FORMAT),
    ],
)
def test_what_cannot_be_read_is_refused(data, name, kind):
    assert fault(data, name).fault is kind


@given(data=st.binary(max_size=300), kind=st.sampled_from(["stl", "obj", "dae"]))
@settings(max_examples=60, deadline=None)
def test_no_content_is_worse_than_refused(data, kind):
    fault(data, f"part.{kind}")


@given(kind=st.sampled_from(["stl_ascii", "obj", "dae"]), cut=st.floats(0, 0.9), junk=st.binary(max_size=8))
@settings(max_examples=30, deadline=None)
def test_a_damaged_file_is_refused_or_still_a_solid(kind, cut, junk):
    whole = content(block(1, 2, 3), kind)
    at = int(len(whole) * cut)
    with suppress(MeshError):
        assert solid_in(whole[:at] + junk + whole[at:], f"part.{ending(kind)}").volume > 0


def test_nothing_is_printed_of_a_broken_file():
    run = """if True:
        from linkforge_compile.core.meshes import solid_in
        try:
            solid_in(b"solid\\nfacet normal x y z\\nvertex 0 0 0\\nvertex 1 0 0\\nvertex 0 1 0\\nendsolid", "part.stl")
        except Exception as error:
            print(error.message)
    """
    done = subprocess.run([sys.executable, "-c", run], capture_output=True, text=True, check=True)
    assert (done.stderr, done.stdout) == ("", "3 of its 3 edges are open, the first at [0 0 0]\n")


def test_entities_of_xml_do_not_grow():
    bomb = b"<!DOCTYPE x [<!ENTITY a '" + b"1 " * 1000 + b"'>"
    for name, inner in zip(b"bcdefgh", b"abcdefg", strict=True):
        bomb += b"<!ENTITY %c '%s'>" % (name, b"&%c;" % inner * 100)
    data = collada(GEOMETRY).replace(b"?>", b"?>" + bomb + b"]>", 1).replace(b'count="24">', b'count="24">&h;')
    assert fault(data, "part.dae").fault is MeshFault.UNREADABLE


def test_a_document_type_is_refused_as_one():
    data = collada(f"<node>{GEOMETRY}</node>").replace(b"?>", b"?><!DOCTYPE x [<!ENTITY s SYSTEM 'secret'>]>", 1)
    for text in (data, data.replace(b'count="24">', b'count="24">&s;')):
        assert fault(text, "part.dae").message.startswith("it has a document type")


def test_nodes_in_nodes_are_counted():
    doubled = "".join(
        f'<node id="n{depth}"><instance_node url="#n{depth - 1}"/><instance_node url="#n{depth - 1}"/></node>'
        for depth in range(1, 40)
    )
    data = collada('<node><instance_node url="#n39"/></node>', library_nodes=f'<node id="n0"/>{doubled}')
    assert fault(data, "part.dae").message == f"its scene has more than {collada_reader.MAX_NODES:,} nodes"


def test_triangles_are_counted(monkeypatch):
    monkeypatch.setattr("linkforge_compile.core.meshes.MAX_TRIANGLES", 20)
    for form in FORMATS:
        assert solid(block(1, 1, 1), form).volume == 1
        name, two = f"part.{ending(form)}", content(together(block(1, 1, 1), block(1, 1, 1, at=(2, 0, 0))), form)
        error = fault(two, name)
        assert (error.fault, error.message) == (MeshFault.TOO_LARGE, "it has more than 20 triangles")
        assert solid_in(two, name, times=2).volume == 2


def test_what_memory_is_too_small_for_is_a_fault_of_the_mesh(monkeypatch):
    def without_memory(_: object) -> NoReturn:
        raise MemoryError

    monkeypatch.setattr(closed, "bounded_solid", without_memory)
    error = fault(content(block(1, 1, 1), "stl"), "part.stl")
    assert (error.fault, error.message) == (MeshFault.TOO_LARGE, "it does not fit into memory")


@pytest.mark.parametrize("face", [b"f" + b" 1 2 3" * 8, b"f 1" + b" \\\n 2/1 3//4" * 11])
def test_triangles_of_a_polygon_are_counted_before_they_are_made(face, monkeypatch):
    monkeypatch.setattr("linkforge_compile.core.meshes.MAX_TRIANGLES", 20)
    monkeypatch.setattr("trimesh.load_scene", None)
    error = fault(b"v 0 0 0\n" * 3 + face, "part.obj")
    assert (error.fault, error.message) == (MeshFault.TOO_LARGE, "it has more than 20 triangles")


@pytest.mark.parametrize(
    ("face", "expected"),
    [
        (b"f 1 2 99999999999999", "line 5: the face has a vertex 99999999999999, but the file has 3"),
        (b"f 1/1 -0/1 2/1", "line 5: the face has a vertex 0, but the file has 3"),
        (b"f 1 2 \\\n000", "line 5: the face has a vertex 0, but the file has 3"),
        (b"f 1/1 -4/1 2/1", "line 5: the face has a vertex -4, but the file has 3"),
        (b"f 1 2 x", "line 5: 'x' is not a vertex coordinate"),
        (b"f 1 2 3 1 " + b"9" * 5000, f"line 5: '{'9' * 40}' is not a vertex coordinate"),
    ],
)
def test_a_corner_without_a_vertex_is_reported_with_its_line(face, expected):
    assert fault(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + face + b"\n", "part.obj").message == expected


def test_hollows_are_counted(monkeypatch):
    monkeypatch.setattr(closed, "_MAX_HOLLOW_CHECKS", 20)
    error = fault(content(together(block(4, 4, 4), turned_inside_out(block(1, 1, 1))), "stl"))
    assert (error.fault, error.message) == (MeshFault.TOO_LARGE, "it has 1 hollows and 24 triangles")


@pytest.mark.parametrize(("form", "package"), [("stl", "trimesh"), ("dae", "trimesh"), ("dae", "collada")])
def test_a_missing_package_is_named(monkeypatch, form, package):
    data = content(block(1, 1, 1), form)
    for module in [name for name in sys.modules if name.startswith("linkforge_compile.core.meshes.c")]:
        monkeypatch.delitem(sys.modules, module)
    for module in [package, *(name for name in sys.modules if name.startswith(f"{package}."))]:
        monkeypatch.setitem(sys.modules, module, None)
    error = fault(data, f"part.{form}")
    assert (error.fault, error.message) == (MeshFault.NO_LIBRARY, package)


# COLLADA


def test_the_unit_of_a_collada_file_is_applied():
    part = solid_in(collada(f"<node>{GEOMETRY}</node>", asset='<unit name="millimeter" meter="0.001"/>'), "part.dae")
    assert part.volume == pytest.approx(8e-9)


def test_the_axes_of_a_collada_file_are_those_of_its_numbers():
    node = f"<node><scale>1 2 3</scale>{GEOMETRY}</node>"
    sizes = {solid_in(collada(node, asset=f"<up_axis>{up}</up_axis>"), "part.dae").size for up in ("Y_UP", "Z_UP")}
    assert sizes == {Vector3(2, 4, 6)}


def test_nodes_place_what_they_hold_as_often_as_they_hold_it():
    twice = (
        f"<node><translate>10 0 0</translate><node><scale>1 1 2</scale>{GEOMETRY}</node></node><node>{GEOMETRY}</node>"
    )
    part = solid_in(collada(twice), "part.dae")
    assert part.volume == pytest.approx(16 + 8)
    assert part.centre.x == pytest.approx(10 * 16 / 24)


def test_a_mirrored_node_is_no_inside_out_body():
    part = solid_in(collada(f"<node><scale>-1 1 1</scale>{GEOMETRY}</node>"), "part.dae")
    assert part.volume == pytest.approx(8)


# Robots built in Python


def built(folder, *shapes: Mesh | Sphere):
    robot = RobotBuilder("arm")
    robot.robot.resource_resolver = FileSystemResolver([folder])
    link = robot.link("base")
    for shape in shapes:
        link.collision(shape)
    return link.mass(8.0).build().link("base")


def test_the_builder_computes_the_inertia_of_a_mesh(tmp_path):
    path = save(block(2, 2, 2), tmp_path / "cube.stl")
    assert built(tmp_path, Mesh(str(path))).inertia.ixx == pytest.approx(8 * 8 / 12)
    halves = built(tmp_path, Mesh(str(path), Vector3(1, 1, -1)), Mesh(str(path)))
    assert (halves.mass, halves.inertia.ixx) == pytest.approx((8, 8 * 8 / 12))


def test_the_builder_refuses_what_is_no_solid(tmp_path):
    path = save(without_a_face(block(2, 2, 2)), tmp_path / "open.stl")
    with pytest.raises(RobotPhysicsError, match=r"open\.stl' cannot be computed: 3 of its 18 edges are open"):
        built(tmp_path, Mesh(str(path)))
    with pytest.raises(RobotPhysicsError, match="there is no such file") as caught:
        built(tmp_path, Mesh("lost.stl"))
    assert caught.value.code is ValidationErrorCode.NOT_FOUND
