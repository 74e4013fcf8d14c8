import pytest

from linkforge_compile.core import (
    Box,
    Capsule,
    Color,
    Cylinder,
    LinkPhysics,
    Material,
    Mesh,
    Sphere,
    Transform,
    Vector3,
    Visual,
)
from tests.lower.specs import Spec, lowered, robot_of


@pytest.mark.parametrize(
    ("shape", "geometry"),
    [
        ("box: [1, 20 mm, 3]", Box(Vector3(1, 0.02, 3))),
        ("cylinder: {radius: 1 cm, length: 2}", Cylinder(0.01, 2)),
        ("capsule: {radius: 1, length: 2}", Capsule(1, 2)),
        ("sphere: 50 mm", Sphere(0.05)),
        ("sphere: {radius: 1}", Sphere(1)),
        ("mesh: a.stl", Mesh("a.stl")),
        ("mesh: {file: a.stl, scale: 0.001}", Mesh("a.stl", Vector3(0.001, 0.001, 0.001))),
        ("mesh: {file: a.stl, scale: [1, -1, 1]}", Mesh("a.stl", Vector3(1, -1, 1))),
    ],
)
def test_the_key_of_a_shape_gives_its_geometry(shape, geometry):
    link = robot_of(f"name: arm\nlinks: {{base: {{collision: {{{shape}}}}}}}").link("base")
    assert [collision.geometry for collision in link.collisions] == [geometry]


def test_a_link_without_a_value_is_a_frame():
    link = robot_of("name: arm\nlinks: {tool0: }").link("tool0")
    assert (link.inertial, link.visuals, link.collisions) == (None, (), ())


def test_collision_visual_copies_shapes_and_places_but_not_names():
    link = robot_of(
        """
        name: arm
        links:
          base:
            visual:
              - {sphere: 1, origin: [0, 0, 1], name: ball, material: {color: [1, 0, 0]}}
              - {box: [1, 1, 1]}
            collision: visual
        """
    ).link("base")
    assert [(one.geometry, one.origin, one.name) for one in link.collisions] == [
        (Sphere(1), Transform(Vector3(0, 0, 1)), None),
        (Box(Vector3(1, 1, 1)), Transform.identity(), None),
    ]


@pytest.mark.parametrize(
    ("keys", "order"),
    [
        ("visual: BALLS, collision: BALL", "VVC"),
        ("collision: BALL, visual: BALLS", "CVV"),
        ("visual: BALLS, collision: visual, shape_order: pairs", "VCVC"),
        ("collision: visual, visual: BALLS, shape_order: pairs", "CVCV"),
        ("visual: BALLS, collision: BALL, shape_order: pairs", "VCV"),
        ("visual: BALL, shape_order: pairs", "V"),
        ("shape_order: pairs", ""),
        ("visual: BALLS, collision: BALL, shape_order: [visual, visual, collision]", "VVC"),
        ("visual: BALLS, collision: visual, shape_order: [collision, visual, visual, collision]", "CVVC"),
    ],
)
def test_shapes_are_in_the_order_of_their_keys_or_of_shape_order(keys: str, order: str):
    written = keys.replace("BALLS", "[{sphere: 1}, {sphere: 2}]").replace("BALL", "{sphere: 3}")
    link = robot_of(f"name: arm\nlinks: {{base: {{{written}}}}}").link("base")
    assert "".join(type(shape).__name__[0] for shape in link.shapes) == order
    assert [shape for shape in link.shapes if isinstance(shape, Visual)] == list(link.visuals)


def test_a_visual_has_a_material_of_the_file_or_an_inline_one():
    robot = robot_of(
        """
        name: arm
        materials: {steel: {color: [0.6, 0.6, 0.6]}}
        links:
          base:
            visual:
              - {sphere: 1, material: steel}
              - {sphere: 1, material: {name: wood, texture: wood.png}}
        """
    )
    steel = Material("steel", Color(0.6, 0.6, 0.6))
    assert robot.materials == {"steel": steel}
    assert [visual.material for visual in robot.link("base").visuals] == [steel, Material("wood", None, "wood.png")]


@pytest.mark.parametrize(
    ("base", "path", "resource"),
    [
        ("", "../meshes/./a.stl", "../meshes/./a.stl"),
        ("../hand/", "meshes/a.stl", "../hand/meshes/a.stl"),
        ("../hand/robots/", "../meshes/a.stl", "../hand/meshes/a.stl"),
        ("package://hand/robots/", "../meshes/a.stl", "package://hand/meshes/a.stl"),
        ("package://hand/", "../other/a.stl", "package://hand/../other/a.stl"),
        ("../hand/", "package://hand/a.stl", "package://hand/a.stl"),
        ("../hand/", "/meshes/a.stl", "/meshes/a.stl"),
    ],
)
def test_a_mesh_path_becomes_relative_to_the_compiled_file(base, path, resource):
    text = f"name: hand\nlinks: {{palm: {{visual: {{mesh: {path}, material: {{texture: {path}}}}}}}}}"
    (visual,) = robot_of(Spec(text, mesh_base=base)).link("palm").visuals
    assert visual.geometry == Mesh(resource)
    assert visual.material.texture == resource


def test_an_inertial_is_computed_from_the_collisions_before_the_visuals():
    link = robot_of(
        """
        name: arm
        links:
          base:
            visual: {mesh: pretty.stl}
            collision: {box: [1, 1, 1], origin: [0, 0, 0.5]}
            inertial: {mass: 6 kg}
        """
    ).link("base")
    assert link.mass == 6
    assert link.inertial_origin == Transform(Vector3(0, 0, 0.5))
    assert link.inertia.ixx == pytest.approx(1)


def test_density_counts_every_shape():
    text = "name: arm\nlinks: {base: {visual: [{box: [1, 1, 1]}, {box: [1, 1, 2]}], inertial: {density: 2 g/cm^3}}}"
    assert robot_of(text).link("base").mass == pytest.approx(6000)


def test_a_written_tensor_is_kept_with_products_of_zero():
    inertial = (
        robot_of(
            """
        name: arm
        links: {base: {inertial: {mass: 2, origin: [1, 2, 3], inertia: {ixx: 1, iyy: 20 kg*cm^2, izz: 3, ixz: -1}}}}
        """
        )
        .link("base")
        .inertial
    )
    assert inertial.origin.xyz == Vector3(1, 2, 3)
    assert [getattr(inertial.inertia, entry) for entry in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")] == [
        1, 0.002, 3, 0, -1, 0,
    ]  # fmt: skip


def test_a_link_keeps_what_is_sound_when_a_part_of_it_is_faulty():
    result = lowered(
        """
        name: arm
        links:
          base:
            visual: [{sphere: 0}, {sphere: 1}]   # E[LF5006]:23 sphere must be above 0 m, found 0
            inertial: {mass: 3 mm}   # E[LF5002]:22 mass takes a mass such as '3 kg', found '3 mm', which is a length
        """
    )
    assert [visual.geometry for visual in result.robot.link("base").visuals] == [Sphere(1)]
    assert not result.unresolved


def test_a_material_that_was_faulty_is_not_unknown():
    lowered(
        """
        name: arm
        materials: {red: {color: [9, 0, 0]}}   # E[LF5006]:27 color must be from 0 to 1, found 9
        links: {base: {visual: {sphere: 1, material: red}}}
        """
    )


def test_objects_know_where_they_were_written():
    link = robot_of("name: arm\nlinks:\n  base: {visual: {sphere: 1}, inertial: {mass: 1}}").link("base")
    assert str(link.source.span) == "spec.yaml:3:3"
    assert str(link.source.at("inertial", "mass")) == "spec.yaml:3:48"
    assert str(link.visuals[0].source.at("sphere")) == "spec.yaml:3:27"


def test_physics_that_say_the_default_are_stated_all_the_same():
    wheel = robot_of("""
        name: cart
        links: {wheel: {physics: {mu: 1, mu2: 0.5, kp: }}}
    """).link("wheel")
    assert wheel.physics == LinkPhysics(mu2=0.5, stated=["mu"])
