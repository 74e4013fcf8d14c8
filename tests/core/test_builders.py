"""Building robots call by call."""

import math

import numpy as np
import pytest

from linkforge_compile.core import (
    Chain,
    Inertial,
    InertiaTensor,
    Joint,
    JointLimits,
    JointType,
    Link,
    LinkBuilder,
    Robot,
    RobotBuilder,
    RobotModelError,
    RobotValidationError,
    SensorType,
    Transform,
    ValidationErrorCode,
    Vector3,
    box,
    capsule,
    cylinder,
    mesh,
    sphere,
)

Code = ValidationErrorCode


def on_base(name: str = "arm") -> LinkBuilder:
    """A link under construction on the base of a new robot."""
    builder = RobotBuilder("robot")
    builder.link("base").root()
    return builder.link(name, parent="base")


def test_a_link_joins_its_parent_when_it_is_committed():
    link = on_base().revolute((0, 0, 2), (-1, 1), xyz=(0, 0, 0.5), effort=5.0)
    assert not link._builder.robot.has_link("arm")
    robot = link.build()
    assert robot.joint("base_to_arm") == Joint(
        "base_to_arm",
        JointType.REVOLUTE,
        "base",
        "arm",
        Transform(Vector3(0, 0, 0.5)),
        Vector3(0, 0, 1),
        JointLimits(-1, 1, 5.0, 1.0),
    )


@pytest.mark.parametrize(
    ("hang", "expected"),
    [
        (lambda link: link.fixed("weld"), JointType.FIXED),
        (lambda link: link.continuous((1, 0, 0)), JointType.CONTINUOUS),
        (lambda link: link.prismatic((1, 0, 0), (0, 1)), JointType.PRISMATIC),
        (lambda link: link.floating(), JointType.FLOATING),
        (lambda link: link.planar((0, 0, 1)), JointType.PLANAR),
    ],
    ids=["fixed", "continuous", "prismatic", "floating", "planar"],
)
def test_a_link_hangs_by_any_type_of_joint(hang, expected):
    (joint,) = hang(on_base()).build().joints
    assert joint.type is expected


def test_a_fixed_joint_drops_what_it_may_not_have():
    (joint,) = on_base().revolute((0, 0, 1), (-1, 1)).dynamics(0.1).fixed().build().joints
    assert (joint.axis, joint.limits, joint.dynamics) == (None, None, None)


def test_the_rest_of_a_joint_is_set_call_by_call():
    link = on_base().continuous((0, 0, 1)).dynamics(0.1, 0.2).mimic("other", 2.0).safety(k_velocity=3.0)
    (joint,) = link.calibration(rising=0.5).at_origin(rpy=(0, 0, 1)).build().joints
    assert (joint.dynamics.friction, joint.mimic.joint, joint.safety_controller.k_velocity) == (0.2, "other", 3.0)
    assert (joint.calibration.rising, joint.origin.rpy) == (0.5, Vector3(0, 0, 1))


def test_an_axis_needs_a_direction():
    with pytest.raises(RobotValidationError, match="too small") as refused:
        on_base().continuous((0, 0, 0))
    assert refused.value.code is Code.OUT_OF_RANGE


def test_links_in_a_with_block_hang_on_its_link():
    builder = RobotBuilder("robot")
    with builder.link("base").mass(2.0):
        with builder.link("upper"):
            builder.link("lower").fixed("elbow")
        builder.link("camera")
    robot = builder.build()
    assert {joint.child: joint.parent for joint in robot.joints} == {
        "upper": "base",
        "lower": "upper",
        "camera": "base",
    }
    assert robot.link("base").mass == 2.0


def test_a_with_block_does_not_take_the_place_of_a_link():
    builder = RobotBuilder("robot")
    builder.link("base").mass(2.0).root()
    with pytest.raises(RobotValidationError, match="Duplicate"), builder.link("base"):
        pass
    assert builder.robot.link("base").mass == 2.0


def test_child_goes_on_below():
    robot = RobotBuilder("robot").link("a").child("b").child("c", joint_name="last").build()
    assert robot.joints.names == ("a_to_b", "last")


def test_a_committed_link_refuses_additions():
    link = on_base()
    link.commit()
    with pytest.raises(RuntimeError, match="already committed"):
        link.visual(box(1, 1, 1))


def test_a_link_with_a_parent_is_no_root():
    with pytest.raises(RobotValidationError, match="cannot be root"):
        on_base().root()


def test_a_collision_has_the_color_of_the_last_visual():
    robot = on_base().visual(box(1, 2, 3), xyz=(0, 0, 1)).collision().collision(xyz=(0, 0, 2)).build()
    first, second = robot.link("arm").collisions
    assert first.geometry == second.geometry == box(1, 2, 3)
    assert (first.origin.xyz.z, second.origin.xyz.z) == (1, 2)
    with pytest.raises(RobotValidationError, match="no visuals"):
        on_base().collision()


def test_a_material_is_named_after_it_was_defined():
    builder = RobotBuilder("robot").material("red", (1, 0, 0, 1))
    builder.link("base").visual(sphere(1), material="red").root()
    assert builder.build().link("base").visuals[0].material is builder.robot.materials["red"]
    with pytest.raises(RobotValidationError, match="'blue' not found"):
        builder.link("other").visual(sphere(1), material="blue")


def test_a_missing_inertia_is_that_of_the_shape():
    link = on_base().visual(sphere(9)).collision(sphere(0.5), xyz=(0, 0, 1)).mass(10.0).build().link("arm")
    assert link.inertial == Inertial(10.0, Transform(Vector3(0, 0, 1)), InertiaTensor(1.0, 1.0, 1.0))


def test_an_inertia_is_that_of_all_shapes_together():
    link = on_base().collision(box(1, 1, 1), xyz=(-0.5, 0, 0)).collision(box(1, 1, 1), xyz=(0.5, 0, 0))
    inertial = link.mass(12.0).build().link("arm").inertial
    assert inertial.origin.xyz == Vector3(0, 0, 0)
    assert math.isclose(inertial.inertia.ixx, 2.0)
    assert math.isclose(inertial.inertia.izz, 5.0)


def test_a_given_inertia_or_centre_is_kept():
    given = on_base().visual(sphere(1)).mass(1.0, origin_xyz=(1, 0, 0)).inertia(1, 2, 3).build().link("arm").inertial
    assert given == Inertial(1.0, Transform(Vector3(1, 0, 0)), InertiaTensor(1, 2, 3))
    assert on_base().mass(1.0).build().link("arm").inertia == InertiaTensor.stability_floor()


def test_the_inertia_of_a_mesh_is_not_guessed():
    with pytest.raises(RobotModelError, match="mesh"):
        on_base().visual(mesh("arm.stl")).mass(1.0).build()


def test_sensors_sit_on_their_link():
    link = on_base().camera("eye", xyz=(1, 0, 0)).lidar("scan").gpu_lidar("fast").imu("imu").gps("gps")
    robot = link.force_torque("wrist").contact("touch", "tip").build()
    assert {sensor.name: sensor.update_rate for sensor in robot.sensors} == {
        "eye": 30.0,
        "scan": 30.0,
        "fast": 30.0,
        "imu": 100.0,
        "gps": 5.0,
        "wrist": 100.0,
        "touch": 50.0,
    }
    assert {sensor.link_name for sensor in robot.sensors} == {"arm"}
    assert robot.sensor("eye").origin.xyz == Vector3(1, 0, 0)
    assert on_base("leg").sensor(robot.sensor("scan")).build().sensors[0].link_name == "leg"
    assert robot.sensor("fast").type is SensorType.GPU_LIDAR


def test_a_joint_is_driven_by_a_transmission_and_a_system():
    link = on_base().continuous((0, 0, 1)).transmission(reduction=50.0).ros2_control(["position"], ["velocity"])
    with pytest.raises(RobotValidationError, match="no global system"):
        link.commit()
    link._builder.ros2_control("hardware", "x/Y", parameters={"rate": 100})
    robot = link.build()
    assert robot.transmission("trans_base_to_arm").joints[0].mechanical_reduction == 50.0
    (system,) = robot.ros2_controls
    assert (system.parameters["rate"], system.joints[0].name) == ("100", "base_to_arm")


def test_a_link_that_is_refused_can_be_committed_later():
    link = on_base().ros2_control(["position"], [])
    with pytest.raises(RobotValidationError):
        link.commit()
    assert not link._builder.robot.has_link("arm")


def test_what_the_link_knows_of_physics_goes_there_and_the_rest_to_gazebo():
    robot = on_base().physics(mu=0.5, material="Gazebo/Red").build()
    assert robot.link("arm").physics.mu == 0.5
    assert robot.get_gazebo_elements("arm")[0].material == "Gazebo/Red"


def test_what_is_begun_of_a_component_is_attached_and_exported():
    hand = RobotBuilder("hand")
    palm = hand.link("palm")
    palm.commit()
    hand.link("finger", parent="palm")
    arm = RobotBuilder("arm")
    arm.link("base")
    assert '<link name="base"' in arm.export_urdf(validate=False)
    arm.attach(hand, "base")
    assert [link.name for link in arm.robot.links] == ["base", "palm", "finger"]


def test_another_robot_is_attached():
    tool = RobotBuilder("tool")
    tool.link("body").root()
    builder = RobotBuilder(robot=Robot("arm", links=[Link("flange")]))
    builder.attach(tool, "flange", prefix="t_", joint_type=JointType.REVOLUTE, axis=(0, 3, 0), limits=(-1, 1))
    builder.attach(tool.build(), "flange", "second", prefix="u_", xyz=(1, 0, 0), disable_collision=True)
    robot = builder.build()
    assert robot.joint("flange_to_t_body").axis == Vector3(0, 1, 0)
    assert robot.joint("second").origin.xyz == Vector3(1, 0, 0)
    assert [(pair.link1, pair.link2) for pair in robot.semantic.disabled_collisions] == [("flange", "u_body")]


def test_planning_is_set_before_the_links_are_finished():
    builder = RobotBuilder("robot")
    builder.link("base")
    semantic = builder.semantic.group("arm", base_link="base", tip_link="tip").group_state("up", "arm", {"j": 1})
    semantic.end_effector("hand", "arm", "tip").passive_joint("j").virtual_joint("world", "base")
    semantic.disable_collisions("a", "b").disable_collisions("b", "a").enable_collisions("a", "c")
    semantic.disable_default_collisions("a").joint_property("j", "p", "v").approximate_link_collision("a", [])
    assert semantic.done() is builder
    description = builder.build().semantic
    assert description.groups[0].chains == (Chain("base", "tip"),)
    assert description.group_states[0].joint_values == {"j": (1.0,)}
    assert (description.virtual_joints[0].parent_frame, description.virtual_joints[0].type) == ("world", "fixed")
    assert len(description.disabled_collisions) == 1
    with pytest.raises(RobotValidationError, match="together"):
        semantic.group("half", tip_link="tip")
    with pytest.raises(RobotValidationError, match="Duplicate"):
        semantic.group("arm", links=["base"])


def test_building_refuses_what_is_not_a_tree_unless_disabled():
    builder = RobotBuilder("robot")
    builder.link("a")
    builder.link("b")
    with pytest.raises(RobotValidationError) as refused:
        builder.build()
    assert refused.value.code is Code.MULTIPLE_ROOTS
    assert len(builder.build(validate=False).links) == 2


def test_a_clone_goes_its_own_way():
    builder = RobotBuilder("robot")
    builder.link("a")
    other = builder.clone()
    other.link("b", parent="a").commit()
    assert builder.build().links.names == ("a",)
    assert other.build().links.names == ("a", "b")


def test_a_builder_needs_a_name_or_a_robot():
    with pytest.raises(RobotModelError, match="Either name or robot"):
        RobotBuilder()


def test_shapes_are_made_of_plain_numbers():
    assert cylinder(1, 2).length == 2
    assert capsule(1, 2).radius == 1
    assert mesh("a.stl", (1, 1, 2)).scale == Vector3(1, 1, 2)


def test_a_continuous_joint_without_effort_and_velocity_has_no_limits():
    def limits(**given):
        return RobotBuilder("r").link("a").child("b").continuous((0, 0, 1), **given).build().joints[0].limits

    assert limits(effort=None, velocity=None) is None
    assert limits(effort=None, velocity=2.0) == JointLimits(0.0, 0.0, 0.0, 2.0)
    assert limits() == JointLimits(0.0, 0.0, 10.0, 1.0)


def test_triples_may_be_arrays_of_numpy():
    place, axis = np.array([1.0, 2.0, 3.0]), np.array([0, 0, 2])
    builder = RobotBuilder("r")
    base = builder.link("a").visual(box(1, 1, 1), xyz=place).collision(xyz=place).mass(1, origin_xyz=place)
    base.child("b").revolute(axis, np.array([-1, 1]), xyz=place).imu("imu", xyz=place).commit()
    builder.attach(
        Robot("m", links=[Link("m")]), "b", joint_type="revolute", xyz=place, axis=axis, limits=np.array([0, 1])
    )
    robot = builder.build()
    at = Vector3(1, 2, 3)
    link = robot.link("a")
    assert (link.visuals[0].origin.xyz, link.collisions[0].origin.xyz, link.inertial.origin.xyz) == (at, at, at)
    assert [joint.origin.xyz for joint in robot.joints] == [at, at]
    assert [joint.axis for joint in robot.joints] == [Vector3(0, 0, 1)] * 2


def test_a_commit_that_fails_leaves_the_robot_as_it_was():
    builder = RobotBuilder("r")
    builder.link("base").imu("imu").commit()
    before = builder.robot.clone()
    for link in (
        builder.link("arm", parent="nowhere").fixed().physics(material="Gazebo/Red"),
        builder.link("hand", parent="base").fixed().imu("palm").imu("imu"),
    ):
        with pytest.raises(RobotValidationError):
            link.commit()
        assert builder.robot == before
    builder.link("nowhere", parent="base").fixed().commit()
    assert builder.robot.links.names == ("base", "nowhere")


def test_a_block_that_fails_commits_nothing():
    builder = RobotBuilder("r")
    base = builder.link("base").mass(3)
    with pytest.raises(ZeroDivisionError), base:
        _ = 1 / 0
    assert builder.robot.link("base").inertial is None
    assert builder.link("next")._parent is None
