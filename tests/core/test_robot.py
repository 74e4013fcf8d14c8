"""A robot: what goes in, what is refused, what it answers."""

import pickle
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from multiprocessing import get_context

import pytest

from linkforge_compile.core import (
    Chain,
    CollisionPair,
    GazeboElement,
    IMUInfo,
    Inertial,
    Joint,
    JointType,
    Link,
    PassiveJoint,
    Robot,
    RobotValidationError,
    Ros2Control,
    Ros2ControlJoint,
    SemanticRobotDescription,
    Sensor,
    SensorType,
    SrdfSphere,
    Transmission,
    ValidationErrorCode,
    Vector3,
)

Code = ValidationErrorCode


def arm() -> Robot:
    """A base, and an upper and a lower link that turn."""
    robot = Robot("arm", links=[Link("base", Inertial(2.0)), Link("upper", Inertial(1.5)), Link("lower")])
    robot.add_joint(Joint("shoulder", JointType.CONTINUOUS, "base", "upper", axis=Vector3(0, 0, 1)))
    robot.add_joint(Joint("elbow", JointType.CONTINUOUS, "upper", "lower", axis=Vector3(0, 1, 0)))
    return robot


def imu(name: str = "imu", on: str = "base") -> Sensor:
    return Sensor(name, SensorType.IMU, on, imu_info=IMUInfo())


def system(name: str = "hardware", joint: str = "elbow") -> Ros2Control:
    return Ros2Control(name, "system", "x/Y", [Ros2ControlJoint(joint, ["position"])])


@contextmanager
def refusal(*codes: ValidationErrorCode) -> Iterator[pytest.ExceptionInfo[RobotValidationError]]:
    with pytest.raises(RobotValidationError) as refused:
        yield refused
    assert refused.value.code in codes


@pytest.mark.parametrize(("name", "code"), [("", Code.NAME_EMPTY), ("two words", Code.INVALID_NAME)])
def test_a_robot_has_a_name_as_links_have(name, code):
    with refusal(code):
        Robot(name)


def test_the_semantic_part_is_named_as_the_robot():
    assert Robot("arm").semantic == SemanticRobotDescription(robot_name="arm")
    assert Robot("arm", semantic=SemanticRobotDescription(robot_name="leg")).semantic.robot_name == "arm"


def test_collections_of_any_kind_become_tuples():
    robot = Robot("r", links=[Link("a")], extra_elements=["<x/>"], extra_attributes={"xmlns:d": "u"})
    assert robot.links == (Link("a"),)
    assert robot.sensors == ()
    assert robot.extra_elements == ("<x/>",)
    assert robot.extra_attributes == (("xmlns:d", "u"),)


def test_a_version_is_stated_if_it_is_not_the_default():
    assert not Robot("r").is_version_written
    assert Robot("r", "2.0").is_version_written
    assert Robot("r", version_stated=True).version == "1.1"


@pytest.mark.parametrize(
    ("add", "part", "code", "target"),
    [
        ("add_link", Link("base"), Code.DUPLICATE_NAME, "Link"),
        ("add_joint", Joint("elbow", "fixed", "base", "lower"), Code.DUPLICATE_NAME, "Joint"),
        ("add_joint", Joint("new", "fixed", "nobody", "lower"), Code.NOT_FOUND, "ParentLink"),
        ("add_joint", Joint("new", "fixed", "base", "nobody"), Code.NOT_FOUND, "ChildLink"),
        ("add_sensor", imu("imu"), Code.DUPLICATE_NAME, "Sensor"),
        ("add_sensor", imu("other", on="nobody"), Code.NOT_FOUND, "LinkName"),
        ("add_transmission", Transmission.create_simple("t", "elbow"), Code.DUPLICATE_NAME, "Transmission"),
        ("add_transmission", Transmission.create_simple("u", "nobody"), Code.NOT_FOUND, "JointName"),
        ("add_ros2_control", system("hardware"), Code.DUPLICATE_NAME, "Ros2Control"),
        ("add_ros2_control", system("other", joint="nobody"), Code.NOT_FOUND, "JointName"),
        ("update_ros2_control", system("other", joint="nobody"), Code.NOT_FOUND, "JointName"),
        ("add_gazebo_element", GazeboElement("nobody"), Code.NOT_FOUND, "GazeboReference"),
    ],
)
def test_what_does_not_fit_is_refused_and_leaves_the_robot_as_it_was(add, part, code, target):
    robot = arm()
    robot.add_sensor(imu("imu"))
    robot.add_transmission(Transmission.create_simple("t", "elbow"))
    robot.add_ros2_control(system("hardware"))
    before = robot.clone()
    with refusal(code) as refused:
        getattr(robot, add)(part)
    assert refused.value.target == target
    assert robot == before


def test_a_second_parent_and_a_cycle_are_left_to_the_checks():
    robot = arm()
    robot.add_joint(Joint("brace", "fixed", "base", "lower"))
    robot.add_joint(Joint("back", "fixed", "lower", "base"))
    assert robot.has_cycle
    assert robot.get_parent_joint("lower").name == "elbow"


def test_an_overwritten_link_keeps_its_place():
    robot = arm()
    robot.add_link(Link("upper"), overwrite=True)
    assert robot.links.names == ("base", "upper", "lower")
    assert robot.link("upper").mass == 0


def test_a_hardware_component_is_replaced_without_a_look_at_its_joints():
    robot = arm()
    robot.update_ros2_control(system())
    robot.update_ros2_control(system(joint="nobody"))
    assert [control.joints[0].name for control in robot.ros2_controls] == ["nobody"]


@pytest.mark.parametrize("kind", ["link", "joint", "sensor", "transmission", "ros2_control"])
def test_every_kind_is_found_by_name_or_missed_in_three_ways(kind):
    robot = arm()
    robot.add_sensor(imu("thing"))
    robot.add_transmission(Transmission.create_simple("thing", "elbow"))
    robot.add_ros2_control(system("thing"))
    robot.add_link(Link("thing"))
    robot.add_joint(Joint("thing", "fixed", "lower", "thing"))
    assert getattr(robot, f"get_{kind}")("thing") is getattr(robot, kind)("thing")
    assert getattr(robot, f"has_{kind}")("thing")
    assert getattr(robot, f"get_{kind}")("nothing") is None
    assert not getattr(robot, f"has_{kind}")("nothing")
    with refusal(Code.NOT_FOUND):
        getattr(robot, kind)("nothing")


def test_neighbours_come_in_the_order_of_the_joints_and_an_unknown_link_has_none():
    robot = arm()
    robot.add_link(Link("camera"))
    robot.add_joint(Joint("bracket", "fixed", "base", "camera"))
    assert [link.name for link in robot.get_child_links("base")] == ["upper", "camera"]
    assert [joint.name for joint in robot.get_joints_for_link("upper", as_parent=False)] == ["shoulder"]
    assert robot.get_parent_link("lower").name == "upper"
    assert robot.get_parent_link("base") is None
    assert (robot.get_child_joints("nobody"), robot.get_child_links("nobody")) == ([], [])


def test_gazebo_elements_are_found_by_what_they_are_about():
    robot = arm()
    about_base, about_robot = GazeboElement("base"), GazeboElement()
    robot.add_gazebo_element(about_base)
    robot.add_gazebo_element(about_robot)
    robot.add_gazebo_element(about_base)
    assert robot.get_gazebo_elements("base") == [about_base, about_base]
    assert robot.get_gazebo_elements() == [about_base, about_robot, about_base]


def test_a_robot_needs_exactly_one_root():
    with refusal(Code.NO_ROOT):
        Robot("r").get_root_link()
    with refusal(Code.MULTIPLE_ROOTS):
        Robot("r", links=[Link("a"), Link("b")]).get_root_link()
    assert arm().root_link.name == "base"


def test_a_joint_to_nowhere_can_be_held_but_has_no_root_and_no_graph():
    robot = Robot("r", links=[Link("a")], joints=[Joint("j", "fixed", "a", "nobody")])
    with refusal(Code.NOT_FOUND):
        _ = robot.root_link
    with refusal(Code.NOT_FOUND):
        _ = robot.graph


def test_mass_and_degrees_of_freedom_are_plain_sums():
    robot = arm()
    robot.add_link(Link("plate"))
    robot.add_joint(Joint("slide", JointType.PLANAR, "lower", "plate", axis=Vector3(0, 0, 1)))
    assert robot.total_mass == 3.5
    assert robot.degrees_of_freedom == 4


def test_text_and_summary_are_those_of_the_contract():
    robot = arm()
    assert str(robot) == "Robot(name=arm, links=3, joints=2, dof=2)"
    assert robot.summary() == (
        "Robot Summary: arm\n  Status: VALID\n  Root: base\n  Topology: 3 links, 2 joints (2 DOF)"
    )
    robot.add_transmission(Transmission.create_simple("t", "elbow"))
    robot.add_sensor(imu())
    robot.add_ros2_control(system())
    robot.add_gazebo_element(GazeboElement())
    assert robot.summary().splitlines()[4:] == [
        "  Functional: 1 sensors, 1 transmissions",
        "  Hardware: 1 ros2_control blocks",
        "  Simulation: 1 gazebo tags",
    ]


def test_the_summary_of_a_broken_robot_has_what_is_known():
    assert "  Status: INVALID\n  Root: 2 roots" in Robot("r", links=[Link("a"), Link("b")]).summary()
    loose = Robot("r", joints=[Joint("j", "fixed", "a", "b")])
    assert "  Status: INVALID\n  Root: Unknown" in loose.summary()


def test_a_group_names_what_is_there():
    robot = arm()
    returned = robot.add_group("whole", ["base"], ["elbow"], [Chain("base", "upper")], None, "upper", "lower")
    assert returned is robot
    (group,) = robot.semantic.groups
    assert group.chains == (Chain("base", "upper"), Chain("upper", "lower"))
    robot.add_group("more", subgroups=["whole"])
    for wrong in ({"links": ["x"]}, {"joints": ["x"]}, {"chains": [Chain("x", "base")]}, {"subgroups": ["x"]}):
        with refusal(Code.NOT_FOUND):
            robot.add_group("wrong", **wrong)
    assert [group.name for group in robot.semantic.groups] == ["whole", "more"]


def test_half_a_chain_an_empty_group_and_a_second_group_of_one_name_are_refused():
    robot = arm().add_group("arm", joints=["elbow"])
    with refusal(Code.INVALID_VALUE):
        robot.add_group("half", base_link="base")
    with refusal(Code.VALUE_EMPTY):
        robot.add_group("empty")
    with refusal(Code.DUPLICATE_NAME):
        robot.add_group("arm", joints=["shoulder"])


def test_a_collision_pair_is_there_once_whatever_the_order_of_its_links():
    robot = arm().disable_collisions("base", "upper").disable_collisions("upper", "base", reason="Never")
    robot.enable_collisions("base", "lower").enable_collisions("lower", "base")
    robot.disable_default_collisions("lower").disable_default_collisions("lower")
    assert robot.semantic.disabled_collisions == (CollisionPair("base", "upper", "Adjacent"),)
    assert robot.semantic.enabled_collisions == (CollisionPair("base", "lower", None),)
    assert robot.semantic.no_default_collision_links == ("lower",)


def test_disabling_all_collisions_makes_every_pair_or_none():
    robot = arm().disable_all_collisions(["base", "upper", "lower"], "Never")
    pairs = [(pair.link1, pair.link2) for pair in robot.semantic.disabled_collisions]
    assert pairs == [("base", "upper"), ("base", "lower"), ("upper", "lower")]
    fresh = arm()
    for wrong in (["base", "upper", "nobody"], ["base", "upper", "base"], ["nobody"]):
        with refusal(Code.NOT_FOUND, Code.INVALID_VALUE):
            fresh.disable_all_collisions(wrong)
    assert fresh == arm()


def test_properties_and_spheres_are_written_once():
    robot = arm().add_joint_property("elbow", "wraparound", "true")
    robot.approximate_link_collision("base", [SrdfSphere(0, 0, 0, 0.1)])
    with refusal(Code.DUPLICATE_NAME):
        robot.add_joint_property("elbow", "wraparound", "false")
    with refusal(Code.DUPLICATE_NAME):
        robot.approximate_link_collision("base", [])
    with refusal(Code.NOT_FOUND):
        robot.add_joint_property("nobody", "wraparound", "true")


def test_prefixing_all_goes_through_or_leaves_the_robot_as_it_was():
    robot = arm().add_group("arm", joints=["elbow"])
    before = robot.clone()
    with refusal(Code.INVALID_NAME):
        robot.prefix_all("left arm ")
    assert robot == before
    robot.prefix_all("left_")
    assert (robot.name, robot.semantic.robot_name) == ("left_arm", "left_arm")
    assert robot.joint("left_elbow").child == "left_lower"
    assert robot.semantic.groups[0].joints == ("left_elbow",)


def test_prefixing_all_leaves_a_robot_alone_whose_links_were_renamed_to_one_name():
    robot = arm()
    robot.links[0].name = "upper"
    with refusal(Code.DUPLICATE_NAME):
        robot.prefix_all("left_")
    assert robot.name == "arm"
    assert robot.links.names == ("upper", "upper", "lower")


def test_a_clone_has_links_of_its_own():
    robot = arm()
    other = robot.clone()
    other.link("base").name = "floor"
    assert robot.has_link("base")
    assert other != robot


def test_several_gazebo_elements_about_one_part_have_an_order_of_their_own_when_normalized():
    first, second = GazeboElement("base", {"mu1": "1"}), GazeboElement("base", {"kp": "2", "kd": "1"})
    swapped = GazeboElement("base", {"kd": "1", "kp": "2"})
    one, other = arm(), arm()
    one.gazebo_elements = (first, second)
    other.gazebo_elements = (swapped, first)
    assert one.normalized() == other.normalized()


def test_replace_makes_a_robot_of_its_own():
    robot = arm()
    other = replace(robot, name="leg")
    other.add_link(Link("foot"))
    assert (other.name, other.semantic.robot_name, len(robot.links)) == ("leg", "leg", 3)


def described(robot: Robot) -> tuple[str, Robot]:
    return robot.summary(), robot


def test_a_robot_survives_a_process_pool():
    robot = arm().disable_collisions("base", "upper")
    robot.add_gazebo_element(GazeboElement("base", {"mu1": "0.2"}))
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        summary, returned = pool.submit(described, robot).result()
    assert summary == robot.summary()
    assert returned == robot
    assert returned.link("upper").mass == 1.5


def test_a_pickle_carries_no_graph():
    robot = arm()
    slim = len(pickle.dumps(robot))
    assert not robot.has_cycle
    assert len(pickle.dumps(robot)) == slim


def test_reading_the_semantics_changes_nothing():
    one, other = Robot("one"), Robot("one")
    assert other.semantic.robot_name == "one"
    one.name = other.name = "two"
    assert one == other
    assert one.semantic.robot_name == other.semantic.robot_name == "two"


def test_the_semantics_refer_to_the_robot_by_its_current_name():
    robot = Robot("one", links=[Link("a")], semantic=SemanticRobotDescription("elsewhere"))
    robot.disable_default_collisions("a")
    assert robot.semantic.robot_name == "one"
    robot.name = "two"
    assert (robot.semantic.robot_name, robot.semantic.no_default_collision_links) == ("two", ("a",))
    robot.semantic = SemanticRobotDescription("elsewhere")
    assert robot.semantic.robot_name == "two"


def test_descriptions_join_by_one_law():
    twice = SemanticRobotDescription(passive_joints=[PassiveJoint("j"), PassiveJoint("j")])
    with pytest.raises(RobotValidationError, match="Duplicate passive joint") as merged:
        SemanticRobotDescription().merge_with(twice)
    with pytest.raises(RobotValidationError, match="Duplicate passive joint") as added:
        Robot("r").add_semantic(twice)
    assert str(merged.value) == str(added.value)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_every_protocol_pickles_a_robot(protocol):
    robot = Robot("r", links=[Link("a"), Link("b")], joints=[Joint("j", "fixed", "a", "b")])
    robot.disable_collisions("a", "b").add_group("g", links=["a"])
    assert pickle.loads(pickle.dumps(robot, protocol)) == robot
