import math
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile import compile_text
from linkforge_compile.checks.bounding import bounding_volume
from linkforge_compile.core import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    InertiaTensor,
    Link,
    Mesh,
    Robot,
    Sphere,
    Transform,
    Vector3,
    Visual,
)
from linkforge_compile.core.physics import inertial_of_shapes
from linkforge_compile.diagnostics.fix import apply_edits
from linkforge_compile.units import parse_quantity
from tests.checks.robots import fixed, messages_of

BEAM = Box(Vector3(0.3, 0.04, 0.04))
SLANTED = Transform(rpy=Vector3(0.3, 0.0, math.pi / 4))


def of(inertial: Inertial, geometry: Geometry = BEAM, pose: Transform = SLANTED) -> Robot:
    return Robot("r", links=[Link("a", inertial, collisions=[Collision(geometry, pose)])])


def scaled(tensor: InertiaTensor, factor: float, products: float = 1.0) -> InertiaTensor:
    moments = [factor * one for one in (tensor.ixx, tensor.iyy, tensor.izz)]
    return InertiaTensor(*moments, *(factor * products * one for one in (tensor.ixy, tensor.ixz, tensor.iyz)))


sizes = st.floats(0.01, 2.0)
shapes = (
    st.builds(Box, st.builds(Vector3, sizes, sizes, sizes))
    | st.builds(Cylinder, sizes, sizes)
    | st.builds(Sphere, sizes)
)
angles = st.floats(-3.0, 3.0)
poses = st.builds(Transform, st.builds(Vector3, sizes, sizes, sizes), st.builds(Vector3, angles, angles, angles))


@given(shapes, poses, st.floats(100.0, 10_000.0))
def test_whatever_is_computed_from_shapes_is_fine(shape: Geometry, pose: Transform, density: float):
    assert messages_of(of(inertial_of_shapes([(shape, pose)], density=density), shape, pose)) == []


@pytest.mark.parametrize(("factor", "unit"), [(1e4, "kg*cm^2"), (1e6, "kg*mm^2"), (1e7, "g*cm^2"), (1e9, "g*mm^2")])
def test_an_inertia_in_another_unit_is_reported_with_the_unit(factor: float, unit: str):
    right = inertial_of_shapes([(BEAM, SLANTED)], mass=2.0)
    (message,) = messages_of(of(Inertial(2.0, right.origin, scaled(right.inertia, factor))))
    assert message.startswith("LF6032 inertia of link 'a' is ")
    assert message.endswith(f"; write the unit if it is in {unit}")
    assert parse_quantity(f"350 {unit}")


def test_no_unit_is_advised_that_the_language_does_not_read():
    right = inertial_of_shapes([(BEAM, SLANTED)], mass=2.0)
    (message,) = messages_of(of(Inertial(2.0, right.origin, scaled(right.inertia, 1e3))))
    assert message == "LF6032 inertia of link 'a' is 700 times that of the box around its shapes"


@pytest.mark.parametrize("products", [-1.0, -0.8])
def test_products_of_the_other_sign_are_reported(products: float):
    right = inertial_of_shapes([(BEAM, SLANTED)], mass=2.0)
    (message,) = messages_of(of(Inertial(2.0, right.origin, scaled(right.inertia, 1.0, products))))
    assert message.startswith("LF6036")


@pytest.mark.parametrize(("written", "after"), [("0.0074", "-0.0074"), ("+0.0074", "-0.0074"), ("-0.0074", "0.0074")])
def test_the_fix_of_products_writes_the_other_sign(written: str, after: str):
    turn = "-45" if written.startswith("-") else "45"
    spec = f"""linkforge: 1
name: arm
links:
  base:
    collision: {{box: [300 mm, 40 mm, 40 mm], origin: {{rpy: [0, 0, {turn} deg]}}}}
    inertial: {{mass: 2, inertia: {{ixx: 0.0079, iyy: 0.0079, izz: 0.0153, ixy: {written}}}}}
"""
    (fix,) = [fix for one in compile_text(spec).diagnostics if one.code.id == "LF6036" for fix in one.fixes]
    assert apply_edits(fix.edits[0].span.file, fix.edits) == spec.replace(f"ixy: {written}", f"ixy: {after}")


def test_products_are_compared_in_the_axes_of_the_link():
    straight = inertial_of_shapes([(BEAM, Transform())], mass=2.0).inertia
    assert messages_of(of(Inertial(2.0, SLANTED, straight))) == []


def test_a_hollow_or_lopsided_body_is_fine():
    right = inertial_of_shapes([(BEAM, SLANTED)], mass=2.0)
    for factor in (0.05, 3.0):
        assert messages_of(of(Inertial(2.0, Transform(Vector3(0.1, 0, 0)), scaled(right.inertia, factor)))) == []


def test_meshes_are_not_measured():
    tiny = InertiaTensor(1e-9, 1e-9, 1e-9)
    assert messages_of(of(Inertial(1e5, Transform(Vector3(0, 0, 50)), tiny), Mesh("package://nowhere/a.stl"))) == []


def test_small_parts_of_the_whole_are_not_checked():
    marker = Link(
        "imu", Inertial(0.001, inertia=InertiaTensor(1e-3, 1e-3, 1e-3)), collisions=[Collision(Sphere(0.0005))]
    )
    base = Link("base", inertial_of_shapes([(BEAM, Transform())], mass=2.0), collisions=[Collision(BEAM)])
    assert messages_of(Robot("r", links=[base, marker], joints=[fixed("glue", "base", "imu")])) == []
    assert [one[:6] for one in messages_of(Robot("r", links=[marker]))] == ["LF6031", "LF6032"]


def test_the_box_around_shapes_holds_them_turned_and_moved():
    shapes = [Collision(BEAM, Transform(Vector3(1, 0, 0), Vector3(0, 0, math.pi / 2))), Collision(Sphere(0.1))]
    volume = bounding_volume(Link("base", collisions=shapes), lambda _: None)
    assert volume is not None
    box = volume.box
    assert box.low == pytest.approx((-0.1, -0.15, -0.1))
    assert box.high == pytest.approx((1.02, 0.15, 0.1))
    assert box.distance((1.02, 0.15, 0.5)) == pytest.approx(0.4)
    assert box.distance((0, 0, 0)) == 0


def of_meshes(folder: Path, inertial: Inertial, scale: float = 1.0) -> Robot:
    """Return a robot of one link, whose one shape is a tetrahedron of 0.2, 0.1 and 0.1 m around [0.1, 0.05, 0.05]."""
    corners = ((0, 0, 0), (0.2, 0, 0), (0, 0.1, 0), (0, 0, 0.1))
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "f 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
    (folder / "part.obj").write_text(text)
    mesh = Mesh(f"file://{folder}/part.obj", Vector3(scale, scale, scale))
    return Robot("r", links=[Link("a", inertial, visuals=[Visual(mesh)])])


FITTING = InertiaTensor(0.002, 0.005, 0.005)


@pytest.mark.parametrize(
    ("inertial", "scale", "messages"),
    [
        (Inertial(2.0, inertia=FITTING), 1.0, []),
        (
            Inertial(2.0, inertia=FITTING),
            300.0,
            [
                "LF6030 link 'a' of 2 kg is lighter than air: 3.7e-05 kg/m³ in its shapes; is one of the units wrong?",
                "LF6033 inertia of link 'a' is 7e-6 of that of the box around its shapes",
            ],
        ),
        (
            Inertial(2.0, inertia=FITTING),
            1000.0,  # reported for the mesh, and not again for what does not fit it
            [],
        ),
        (
            Inertial(2.0, inertia=scaled(FITTING, 1e-6)),
            0.001,
            [
                "LF6031 link 'a' of 2 kg is denser than any metal: 1e+12 kg/m³ in the box around its shapes; "
                "is one of the units wrong?"
            ],
        ),
        (
            Inertial(2.0, inertia=scaled(FITTING, 1e6)),
            1.0,
            [
                "LF6032 inertia of link 'a' is 6e5 times that of the box around its shapes; "
                "write the unit if it is in kg*mm^2"
            ],
        ),
        (
            Inertial(2.0, Transform(Vector3(120.0, 0.0, 0.0)), FITTING),
            1.0,
            ["LF6035 centre of mass of link 'a' is 120 m away from its shapes, which are 0.24 m in size"],
        ),
    ],
)
def test_a_link_of_meshes_is_checked_by_their_boxes(
    tmp_path: Path, inertial: Inertial, scale: float, messages: list[str]
):
    assert [one for one in messages_of(of_meshes(tmp_path, inertial, scale)) if "LF6020" not in one] == messages


def test_a_mesh_that_is_a_sheet_or_not_at_hand_is_no_heavy_body(tmp_path: Path):
    (tmp_path / "sheet.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    link = Link(
        "a", Inertial(20.0, inertia=InertiaTensor(1, 1, 2)), visuals=[Visual(Mesh(f"file://{tmp_path}/sheet.obj"))]
    )
    assert messages_of(Robot("r", links=[link])) == []
    elsewhere = replace(link, visuals=[Visual(Mesh("package://elsewhere/a.obj"))])
    assert messages_of(Robot("r", links=[elsewhere])) == []
