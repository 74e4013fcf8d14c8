from linkforge_compile.core.models.geometry import (
    Box,
    Capsule,
    Color,
    Cylinder,
    Material,
    Mesh,
    Sphere,
    Transform,
    Vector3,
)
from linkforge_compile.core.models.link import Collision, Inertial, InertiaTensor, Link, Visual
from tests.formats.inside import urdf, xml

STEEL = Material("steel", Color(0.6, 0.6, 0.65))


def test_a_frame_is_an_empty_element():
    assert urdf(links=[Link("tool0")]) == '<link name="tool0"/>\n'


def test_a_body_has_mass_looks_and_shape_in_this_order():
    body = Link(
        "base",
        Inertial(4.0, Transform(Vector3(0, 0, 0.05)), InertiaTensor(0.1, 0.2, 0.3, 0.01, 0.02, 0.03)),
        visuals=[Visual(Cylinder(0.08, 0.1), Transform(Vector3(0, 0, 0.05)), STEEL, "hull")],
        collisions=[Collision(Box(Vector3(1, 2, 3)), Transform(rpy=Vector3(0, 1.5, 0)), "hull")],
    )
    assert urdf(links=[body], materials={"steel": STEEL}) == xml("""
        <material name="steel">
          <color rgba="0.6 0.6 0.65 1"/>
        </material>
        <link name="base">
          <inertial>
            <origin xyz="0 0 0.05" rpy="0 0 0"/>
            <mass value="4"/>
            <inertia ixx="0.1" ixy="0.01" ixz="0.02" iyy="0.2" iyz="0.03" izz="0.3"/>
          </inertial>
          <visual name="hull">
            <origin xyz="0 0 0.05" rpy="0 0 0"/>
            <geometry>
              <cylinder radius="0.08" length="0.1"/>
            </geometry>
            <material name="steel"/>
          </visual>
          <collision name="hull">
            <origin xyz="0 0 0" rpy="0 1.5 0"/>
            <geometry>
              <box size="1 2 3"/>
            </geometry>
          </collision>
        </link>
    """)


def test_every_geometry_is_its_own_tag():
    shapes = [Sphere(0.5), Capsule(0.1, 0.4), Mesh("a.stl"), Mesh("package://p/b.dae", Vector3(0.001, 0.001, -0.001))]
    written = urdf(links=[Link("base", collisions=[Collision(shape) for shape in shapes])])
    assert [line.strip() for line in written.splitlines() if line.startswith("      ")] == [
        '<sphere radius="0.5"/>',
        '<capsule radius="0.1" length="0.4"/>',
        '<mesh filename="a.stl"/>',
        '<mesh filename="package://p/b.dae" scale="0.001 0.001 -0.001"/>',
    ]


def test_a_material_that_the_robot_has_otherwise_is_written_in_full():
    rusty = Material("steel", Color(0.4, 0.2, 0.1), "rust.png")
    base = Link("base", visuals=[Visual(Sphere(1), material=rusty)])
    assert urdf(links=[base], materials={"steel": STEEL}) == xml("""
        <material name="steel">
          <color rgba="0.6 0.6 0.65 1"/>
        </material>
        <link name="base">
          <visual>
            <geometry>
              <sphere radius="1"/>
            </geometry>
            <material name="steel">
              <color rgba="0.4 0.2 0.1 1"/>
              <texture filename="rust.png"/>
            </material>
          </visual>
        </link>
    """)


def test_extra_content_is_written_last():
    pose = Transform(extra_attributes=[("quat_xyzw", "0 0 0 1")])
    shape = Collision(
        Box(Vector3(1, 1, 1)), pose, extra_elements=["<surface><friction><mu>1</mu></friction></surface>"]
    )
    link = Link("base", collisions=[shape], extra_attributes=[("type", "hull")], extra_elements=["<self_filter/>"])
    assert urdf(links=[link]) == xml("""
        <link name="base" type="hull">
          <collision>
            <origin xyz="0 0 0" quat_xyzw="0 0 0 1"/>
            <geometry>
              <box size="1 1 1"/>
            </geometry>
            <surface>
              <friction>
                <mu>1</mu>
              </friction>
            </surface>
          </collision>
          <self_filter/>
        </link>
    """)
