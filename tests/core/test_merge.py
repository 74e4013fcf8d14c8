"""Merging: everything nameable comes along, all of it or nothing."""

import gc
import sys
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import wraps
from subprocess import run
from types import MappingProxyType
from weakref import ref

import pytest

from linkforge_compile.core import (
    Box,
    Collision,
    Color,
    EndEffector,
    GazeboElement,
    GroupState,
    IMUInfo,
    Joint,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointType,
    Link,
    Material,
    PassiveJoint,
    Robot,
    RobotBuilder,
    RobotModelError,
    Ros2Control,
    Ros2ControlJoint,
    SemanticRobotDescription,
    Sensor,
    SensorType,
    Transform,
    Transmission,
    ValidationErrorCode,
    Vector3,
    Visual,
)

Code = ValidationErrorCode
RED, BLUE = Color(1, 0, 0), Color(0, 0, 1)


def gripper() -> Robot:
    """A palm and a finger, with one of everything that has a name."""
    robot = Robot("gripper", links=[Link("palm"), Link("finger")], metadata={"maker": "us"}, version="7")
    robot.materials["skin"] = Material("skin", RED)
    robot.link("palm").add_visual(Visual(Box(Vector3(1, 1, 1)), material=robot.materials["skin"]))
    robot.add_joint(Joint("close", JointType.CONTINUOUS, "palm", "finger", axis=Vector3(0, 0, 1)))
    robot.add_sensor(Sensor("imu", SensorType.IMU, "palm", imu_info=IMUInfo(), topic="imu", frame="palm"))
    robot.add_transmission(Transmission.create_simple("drive", "close"))
    robot.add_ros2_control(Ros2Control("motor", "system", "x/Y", [Ros2ControlJoint("close", ["position"])]))
    robot.add_gazebo_element(GazeboElement("palm"))
    robot.add_group("fingers", joints=["close"]).disable_collisions("palm", "finger")
    robot.add_semantic(SemanticRobotDescription(group_states=[GroupState("home", "fingers", {"close": 0.0})]))
    robot.extra_elements = ["<note/>"]
    return robot


def station() -> Robot:
    return Robot("station", links=[Link("table")])


def test_everything_nameable_comes_along_under_the_prefix():
    robot = station().merge(gripper(), "table", "mount", prefix="left_")
    assert robot.links.names == ("table", "left_palm", "left_finger")
    assert robot.joints.names == ("left_close", "mount")
    assert robot.sensor("left_imu") == Sensor(
        "left_imu", SensorType.IMU, "left_palm", imu_info=IMUInfo(), topic="left_imu", frame="left_palm"
    )
    assert robot.transmission("left_drive").joints[0].name == "left_close"
    assert robot.ros2_control("left_motor").joints[0].name == "left_close"
    assert robot.get_gazebo_elements("left_palm") == [GazeboElement("left_palm")]
    assert robot.materials == {"left_skin": Material("left_skin", RED)}
    assert robot.link("left_palm").visuals[0].material == robot.materials["left_skin"]
    assert robot.semantic.groups[0].joints == ("left_close",)
    assert robot.semantic.group_states == (GroupState("left_home", "left_fingers", {"left_close": 0.0}),)
    assert robot.extra_elements == ("<note/>",)


def test_the_robot_keeps_what_is_its_own_and_the_component_stays_as_it_was():
    component = gripper()
    robot = station().merge(component, "table", "mount", prefix="left_")
    assert (robot.name, robot.version, robot.metadata) == ("station", "1.1", {})
    assert robot.semantic.robot_name == "station"
    assert component == gripper()
    robot.merge(component, "table", "second").link("palm").name = "hand"
    assert component == gripper()


def test_the_connecting_joint_is_fixed_by_default_and_ends_at_the_root():
    robot = station().merge(gripper(), "table", "mount", prefix="left_")
    assert robot.joint("mount") == Joint("mount", JointType.FIXED, "table", "left_palm")
    pose, axis, limits = Transform(Vector3(0, 0, 1)), Vector3(1, 0, 0), JointLimits(-1, 1)
    robot.merge(gripper(), "table", "hinge", "right_", JointType.REVOLUTE, pose, axis, limits)
    assert robot.joint("hinge") == Joint("hinge", JointType.REVOLUTE, "table", "right_palm", pose, axis, limits)


def test_the_connecting_joint_copies_the_rest_of_a_given_joint():
    given = Joint(
        "any",
        JointType.FIXED,
        "a",
        "b",
        Transform(Vector3(9, 9, 9)),
        dynamics=JointDynamics(0.5),
        mimic=JointMimic("other"),
        extra_elements=["<x/>"],
    )
    robot = station().merge(gripper(), "table", "mount", prefix="left_", joint=given)
    plain = Joint("mount", JointType.FIXED, "table", "left_palm", dynamics=given.dynamics, mimic=given.mimic)
    assert robot.joint("mount") == replace(plain, extra_elements=["<x/>"])


def test_without_a_link_the_component_is_laid_in_with_its_own_root():
    robot = Robot("mobile").merge(gripper(), None, None, prefix="base_")
    assert robot.root_link.name == "base_palm"
    assert robot.joints.names == ("base_close",)
    robot.merge(station(), "base_finger", "post")
    assert robot.get_parent_link("table").name == "base_finger"


def test_prefixes_nest():
    hand = Robot("arm", links=[Link("flange")]).merge(gripper(), "flange", "grip", prefix="hand_")
    robot = station().merge(hand, "table", "mount", prefix="left_")
    assert robot.has_link("left_hand_palm")
    assert robot.joint("left_grip").child == "left_hand_palm"
    assert robot.semantic.groups[0].name == "left_hand_fingers"


def test_a_robot_can_be_merged_into_itself():
    robot = gripper()
    robot.merge(robot, "finger", "splice", prefix="next_")
    assert robot.links.names == ("palm", "finger", "next_palm", "next_finger")


def with_only(**kinds: object) -> Robot:
    """A robot of one link whose name is free, and of parts whose names may be taken."""
    robot = Robot("other", links=[Link("free"), Link("palm2")])
    robot.add_joint(Joint("close2", "fixed", "free", "palm2"))
    for kind, value in kinds.items():
        setattr(robot, kind, value)
    return robot


CLASHES = {
    "link": with_only(links=[Link("palm")], joints=()),
    "joint": with_only(joints=[Joint("close", "fixed", "free", "palm2")]),
    "sensor": with_only(sensors=[Sensor("imu", SensorType.IMU, "free", imu_info=IMUInfo())]),
    "transmission": with_only(transmissions=[Transmission.create_simple("drive", "close2")]),
    "ros2_control": with_only(
        ros2_controls=[Ros2Control("motor", "system", "x/Y", [Ros2ControlJoint("close2", ["effort"])])]
    ),
    "material": with_only(materials={"skin": Material("skin", BLUE)}),
    "group": with_only(semantic=gripper().semantic),
    "group state": with_only(
        semantic=SemanticRobotDescription(group_states=[GroupState("home", "fingers", {"close2": 1.0})])
    ),
}


@pytest.mark.parametrize("component", CLASHES.values(), ids=CLASHES)
def test_two_parts_of_one_name_are_an_error_and_the_robot_stays_as_it_was(component):
    robot = station().merge(gripper(), "table", "mount")
    before = robot.clone()
    with pytest.raises(RobotModelError) as refused:
        robot.merge(component, "table", "second")
    assert refused.value.code is Code.DUPLICATE_NAME
    assert robot == before
    assert robot.merge(component, "table", "third", prefix="other_").joint("third").parent == "table"


def test_states_of_one_name_belong_to_their_groups():
    home = GroupState("home", "legs", {"close2": 1.0})
    component = with_only(semantic=SemanticRobotDescription(group_states=[home]))
    robot = station().merge(gripper(), "table", "mount").merge(component, "table", "second")
    assert [(state.group, state.name) for state in robot.semantic.group_states] == [
        ("fingers", "home"),
        ("legs", "home"),
    ]


@pytest.mark.parametrize(
    "entries",
    [{"end_effectors": [EndEffector("tool", "g", "palm")]}, {"passive_joints": [PassiveJoint("wheel")]}],
    ids=["end effector", "passive joint"],
)
def test_nothing_semantic_is_written_twice(entries):
    robot = station().add_semantic(SemanticRobotDescription(**entries))
    with pytest.raises(RobotModelError, match="Duplicate"):
        robot.merge(with_only(semantic=SemanticRobotDescription(**entries)), "table", "mount")


def test_equal_materials_may_share_a_name():
    robot = station().merge(gripper(), "table", "mount")
    robot.merge(with_only(materials={"skin": Material("skin", RED)}), "table", "second")
    assert robot.materials == {"skin": Material("skin", RED)}


@pytest.mark.parametrize(("own", "added"), [(True, True), (True, False), (False, True), (False, False)])
def test_a_material_of_two_robots_is_after_the_links_if_it_is_in_both(own: bool, added: bool):
    robot = Robot("own", materials={"skin": Material("skin", RED, after_links=own), "bone": Material("bone", RED)})
    robot.merge(Robot("added", materials={"skin": Material("skin", RED, after_links=added)}), None, None)
    assert list(robot.materials) == ["skin", "bone"]
    assert robot.materials["skin"].after_links is (own and added)


def test_the_connecting_joint_may_not_take_a_name_from_either_robot():
    robot = station().merge(gripper(), "table", "mount", prefix="a_")
    for taken in ("mount", "a_close", "b_close"):
        with pytest.raises(RobotModelError, match=f"Duplicate joint name: '{taken}'"):
            robot.merge(gripper(), "table", taken, prefix="b_")


def ring(*extra: Link) -> Robot:
    robot = Robot("ring", links=[Link("a"), Link("b"), *extra])
    robot.add_joint(Joint("ab", "fixed", "a", "b"))
    robot.add_joint(Joint("ba", "fixed", "b", "a"))
    return robot


REFUSED = {
    "an unknown link": (gripper(), {"at_link": "nowhere"}, Code.NOT_FOUND),
    "no name for the joint": (gripper(), {"joint_name": None}, Code.NAME_EMPTY),
    "no root": (Robot("empty"), {}, Code.NO_ROOT),
    "two roots": (Robot("two", links=[Link("a"), Link("b")]), {}, Code.MULTIPLE_ROOTS),
    "a cycle beside the root": (ring(Link("root")), {}, Code.HAS_CYCLE),
    "a cycle, laid in": (ring(), {"at_link": None, "joint_name": None}, Code.HAS_CYCLE),
    "a loose joint": (Robot("loose", links=[Link("a")], joints=[Joint("j", "fixed", "a", "b")]), {}, Code.NOT_FOUND),
    "a bad prefix": (gripper(), {"prefix": "left arm "}, Code.INVALID_NAME),
    "an axis that a fixed joint has not": (gripper(), {"axis": Vector3(1, 0, 0)}, Code.INVALID_VALUE),
}


@pytest.mark.parametrize(("component", "arguments", "code"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_joined_is_refused_and_the_robot_stays_as_it_was(component, arguments, code):
    robot = station().merge(gripper(), "table", "mount", prefix="left_")
    before = robot.clone()
    with pytest.raises(RobotModelError) as refused:
        robot.merge(component, **{"at_link": "table", "joint_name": "second", **arguments})
    assert refused.value.code is code
    assert robot == before


def test_an_absolute_topic_is_kept():
    component = gripper()
    component.sensors = [replace(component.sensors[0], topic="/imu")]
    assert station().merge(component, "table", "mount", prefix="left_").sensors[0].topic == "/imu"


def test_merging_and_finding_the_root_do_without_networkx():
    script = """
import sys
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.link import Link
robot = Robot("r", links=[Link("a")])
robot.merge(Robot("s", links=[Link("b")]), "a", "j", prefix="x_").root_link
print("networkx" in sys.modules)
"""
    assert run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout == "False\n"


def test_links_of_one_name_are_reported_without_follow_on_errors():
    arm = Robot("arm", links=[Link("base"), Link("tool")], joints=[Joint("j", "fixed", "base", "tool")])
    for module in (
        Robot("module", links=[Link("tool")]),  # not as a joint from a link to itself
        Robot("module", links=[Link("root"), Link("tool")], joints=[Joint("k", "fixed", "root", "tool")]),
        Robot("module", links=[Link("new"), Link("base")], joints=[Joint("k", "fixed", "new", "base")]),  # nor a cycle
    ):
        before = arm.clone()
        with pytest.raises(RobotModelError) as merged:
            arm.merge(module, "tool", "mount")
        with pytest.raises(RobotModelError) as attached:
            RobotBuilder(robot=arm).attach(module, "tool")
        assert merged.value.code is attached.value.code is Code.DUPLICATE_NAME
        assert arm == before


def test_merged_parts_follow_in_their_order_and_the_mount_is_last():
    arm = Robot("arm", links=[Link("z")])
    module = Robot("module", links=[Link("c"), Link("a"), Link("b")])
    module.joints = [Joint("cb", "fixed", "c", "b"), Joint("ba", "fixed", "b", "a")]
    arm.merge(module, "z", "mount", prefix="m_")
    assert arm.links.names == ("z", "m_c", "m_a", "m_b")
    assert arm.joints.names == ("m_cb", "m_ba", "mount")


def test_own_extra_attributes_win():
    arm = Robot("arm", links=[Link("base")], extra_attributes={"kind": "own"})
    arm.merge(Robot("m", links=[Link("x")], extra_attributes={"kind": "other", "more": "1"}), "base", "mount")
    assert dict(arm.extra_attributes) == {"kind": "own", "more": "1"}


@pytest.mark.parametrize(
    "break_it",
    [
        lambda robot: setattr(robot, "extra_attributes", [("alone",)]),
        lambda robot: setattr(robot, "materials", MappingProxyType({})),
    ],
    ids=["extra_attributes", "materials"],
)
def test_what_cannot_be_taken_in_changes_nothing(break_it):
    arm = Robot("arm", links=[Link("base")])
    break_it(arm)
    module = Robot("m", links=[Link("x")], materials={"steel": Material("steel", RED)})
    with pytest.raises((ValueError, AttributeError)):
        arm.merge(module, "base", "mount")
    assert arm.links.names == ("base",)
    assert arm.joints == ()


@dataclass(frozen=True)
class Rated(Joint):
    """A joint of a user's own, who computes something."""

    payload: float = 0.0

    def __post_init__(self):
        Joint.__post_init__(self)
        object.__setattr__(self, "label", f"{self.name}: {self.payload} kg")


def test_a_part_of_a_user_class_gets_a_prefix_in_a_new_instance():
    robot = Robot("arm", links=[Link("a"), Link("b")])
    robot.add_joint(Rated("j", "fixed", "a", "b", payload=3.0))
    robot.prefix_all("left_")
    assert robot.joint("left_j").label == "left_j: 3.0 kg"
    assert (robot.joints[0].parent, robot.joints[0].child) == ("left_a", "left_b")


class Marked(Link):
    def with_prefix(self, prefix: str) -> Link:
        return Link(f"{prefix}marked_{self.name}")


def test_a_link_of_a_user_class_makes_its_own_copy():
    robot = Robot("arm", links=[Marked("a")])
    robot.prefix_all("left_")
    assert [link.name for link in robot.links] == ["left_marked_a"]


def recording(method):
    """Wrap `with_prefix` to record each call."""

    @wraps(method)
    def with_prefix(part, prefix):
        return replace(method(part, prefix), name="recorded")

    return with_prefix


class Recording(Visual):
    with_prefix = recording(Visual.with_prefix)


def test_a_part_with_a_wrapped_copy_method_makes_its_own_copy():
    visuals = (Recording(Box(Vector3(1, 1, 1))),)
    merged = Robot("station").merge(Robot("arm", links=[Link("a", visuals=visuals)]), None, None, "left_")
    assert merged.links[0].visuals[0].name == "recorded"
    assert Link("a", visuals=visuals).with_prefix("left_").visuals[0].name == "recorded"


class Weak(str):
    """A name of which one can tell whether anybody still has it."""


def painted(name: str) -> Robot:
    skin, shape = Material(name, RED), Box(Vector3(1, 1, 1))
    return Robot(
        "arm",
        links=[
            Link("a", visuals=[Visual(shape, material=skin)] * 2),
            Link("b", visuals=[Visual(shape, material=skin)]),
        ],
    )


def test_shapes_without_a_name_are_those_of_the_component_and_lists_of_them_are_not():
    arm = Robot("arm", links=[Link("a"), Link("b")], joints=[Joint("j", "fixed", "a", "b")])
    shapes = [Collision(Box(Vector3(1, 1, 1))), Collision(Box(Vector3(2, 2, 2)))]
    arm.link("a").collisions, arm.link("b").collisions = shapes, [*shapes, Collision(Box(Vector3(1, 1, 1)), name="c")]
    robot = Robot("station").merge(arm, None, None, "left_")
    shapes.clear()
    assert [link.collisions for link in robot.links] == [
        tuple(arm.link("b").collisions[:2]),
        (*arm.link("b").collisions[:2], Collision(Box(Vector3(1, 1, 1)), name="left_c")),
    ]
    assert robot.link("left_b").collisions[0] is arm.link("b").collisions[0]


@pytest.mark.parametrize(
    "use",
    [
        lambda robot: robot.prefix_all("left_"),
        lambda robot: [link.with_prefix("left_") for link in robot.links],
        lambda robot: robot.links[0].visuals[0].with_prefix("left_"),
        lambda robot: (
            robot.add_joint(Joint("j", "fixed", "a", "b"))
            or Robot("s", links=[Link("left_b")]).merge(robot, None, None, "left_")
        ),
    ],
    ids=["robot", "links", "visual", "refused"],
)
def test_nothing_of_a_robot_is_kept_when_it_is_gone(use):
    name = Weak("skin")
    kept, robot = ref(name), painted(name)
    with suppress(RobotModelError):
        use(robot)
    del name, robot
    gc.collect()
    assert kept() is None


@pytest.mark.parametrize("name", ["left wrist", "", "wrist!"])
def test_a_link_that_was_renamed_to_what_is_no_name_is_refused_under_a_prefix(name: str):
    arm, station = Robot("arm", links=[Link("base"), Link("wrist")]), Robot("station")
    arm.links[1].name = name
    found = name and f"left_{name}"
    with pytest.raises(RobotModelError, match=f"found '{found}'") as refused:
        station.merge(arm, None, None, prefix="left_")
    assert refused.value.code is Code.INVALID_NAME
    assert station.links == ()


def test_a_prefix_that_no_name_may_have_is_refused():
    for joint in (Joint("j", "fixed", "a", "b"), Rated("j", "fixed", "a", "b")):
        with pytest.raises(RobotModelError) as refused:
            joint.with_prefix("a b")
        assert refused.value.code is Code.INVALID_NAME
