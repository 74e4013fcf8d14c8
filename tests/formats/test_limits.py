"""What a format or its readers do not support is reported."""

from contextlib import suppress
from dataclasses import fields, replace

import pytest

from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.fields import Vector, field_specs
from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.geometry import Capsule, Color, Material, Mesh, Sphere, Vector3
from linkforge_compile.core.models.joint import Joint, JointLimits, JointType
from linkforge_compile.core.models.link import Link, LinkPhysics, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Interface, Ros2Control, Ros2ControlJoint
from linkforge_compile.core.models.sensor import (
    CameraInfo,
    ContactInfo,
    ForceTorqueInfo,
    IMUInfo,
    Sensor,
    SensorNoise,
    SensorType,
)
from linkforge_compile.core.models.srdf import PlanningGroup, SemanticRobotDescription
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.core.part import Element
from linkforge_compile.formats import SRDF, URDF
from linkforge_compile.formats.parts import _ways_into, doubtful_parts_in
from tests.export_spec.test_every_field import full, parts
from tests.formats.everything import everything


def limits_of(robot: Robot, **options: str) -> list[tuple[str, str]]:
    return [(diagnostic.code.id, diagnostic.message) for diagnostic in URDF.limits(robot, options)]


def robot(*visuals: Visual, **parts) -> Robot:
    return Robot("r", links=[Link("base", visuals=visuals), Link("tool")], **parts)


def test_an_ordinary_robot_is_within_the_limits():
    arm = robot(Visual(Sphere(1), material=Material("red", Color(1, 0, 0))))
    assert not limits_of(arm)
    assert not list(SRDF.limits(arm, {}))


def test_a_robot_with_every_feature_is_reported_for_its_capsule_only():
    assert [code for code, _ in limits_of(everything())] == ["LF7002"]


def test_capsules_are_reported_once():
    assert limits_of(robot(Visual(Capsule(1, 1)), Visual(Capsule(2, 2)))) == [
        (
            "LF7002",
            "a capsule needs a reader of URDF 1.1, such as urdfdom 6 or MuJoCo; older ones refuse the whole file",
        )
    ]


def test_a_version_older_than_a_capsule():
    codes = limits_of(robot(Visual(Capsule(1, 1)), version="1.0"))
    assert codes[1] == (
        "LF7003",
        "a robot with a capsule is URDF 1.1 or later, found version '1.0'; omit `version` to get the right one",
    )


@pytest.mark.parametrize("version", ["2.0", "1", "1.3", "my arm v2"])
def test_a_version_that_urdfdom_does_not_read(version: str):
    assert limits_of(robot(version=version)) == [
        ("LF7004", f"urdfdom reads the versions 1.0, 1.1 and 1.2 of URDF and refuses any other, found '{version}'")
    ]


def test_two_materials_of_one_name():
    red, green = Material("paint", Color(1, 0, 0)), Material("paint", Color(0, 1, 0))
    [(code, message)] = limits_of(robot(Visual(Sphere(1), material=red), Visual(Sphere(1), material=green)))
    assert code == "LF7005"
    assert message.startswith("there are different materials named 'paint'")
    assert not limits_of(robot(Visual(Sphere(1), material=red), Visual(Sphere(1), material=red)))


def test_nameless_materials_may_differ():
    red, green = Material("", Color(1, 0, 0)), Material("", Color(0, 1, 0))
    assert not limits_of(robot(Visual(Sphere(1), material=red), Visual(Sphere(1), material=green)))


TOLL = "a\x07b"
UNWRITABLE = {
    "mesh": robot(Visual(Mesh(TOLL))),
    "material": robot(materials={"m": Material(TOLL, Color(1, 0, 0))}),
    "visual": robot(Visual(Sphere(1), name=TOLL)),
    "limits": robot(
        joints=[
            Joint(
                *("j", JointType.PRISMATIC, "base", "tool"),
                axis=Vector3(0, 0, 1),
                limits=JointLimits(extra_attributes=[("jerk", TOLL)]),
            )
        ]
    ),
    "sensor": robot(sensors=[Sensor("s", SensorType.IMU, "base", imu_info=IMUInfo(), topic=TOLL)]),
    "frame": robot(sensors=[Sensor("s", SensorType.IMU, "base", imu_info=IMUInfo(), frame=TOLL)]),
    "always on": robot(sensors=[Sensor("s", SensorType.IMU, "base", imu_info=IMUInfo(), always_on=TOLL)]),
    "visualize": robot(sensors=[Sensor("s", SensorType.IMU, "base", imu_info=IMUInfo(), visualize=TOLL)]),
    "self-collide": Robot("r", links=[Link("base", physics=LinkPhysics(self_collide=TOLL))]),
    "gravity": Robot("r", links=[Link("base", physics=LinkPhysics(gravity=TOLL))]),
    "static": robot(gazebo_elements=[GazeboElement("base", static=TOLL)]),
    "interface": robot(ros2_controls=[Ros2Control("c", "system", "p", [Ros2ControlJoint("j", [TOLL])])]),
    "parameter": robot(
        ros2_controls=[Ros2Control("c", "system", "p", [Ros2ControlJoint("j", [Interface("x", {"min": TOLL})])])]
    ),
    "property": robot(gazebo_elements=[GazeboElement("base", {"mu1": TOLL})]),
    "tag": robot(gazebo_elements=[GazeboElement("base", {"two words": "1"})]),
    "raw": robot(gazebo_elements=[GazeboElement(plugins=[GazeboPlugin("p", "f", raw_xml="<a>")])]),
    "transmission": robot(
        transmissions=[
            Transmission("t", "custom", [TransmissionJoint("j")], [TransmissionActuator("a")], {"<": "1"}),
        ]
    ),
    "extra": Robot("r", extra_elements=["<a>"]),
    "attribute": Robot("r", links=[Link("base", extra_attributes=[("a b", "1")])]),
}


@pytest.mark.parametrize("faulty", UNWRITABLE.values(), ids=UNWRITABLE)
def test_what_xml_cannot_hold_is_reported_once_anywhere(faulty: Robot):
    [(code, message)] = limits_of(faulty)
    assert code == "LF7001"
    assert message.startswith("this cannot be written as XML: ")


def test_the_semantic_part_is_its_own_formats_affair():
    semantic = SemanticRobotDescription(groups=[PlanningGroup("arm", links=[TOLL])])
    faulty = Robot("r", semantic=semantic)
    assert not limits_of(faulty)
    assert [diagnostic.code.id for diagnostic in SRDF.limits(faulty, {})] == ["LF7001"]


def test_nothing_is_taken_for_plain_that_xml_may_be_unable_to_hold():
    whole = everything()
    assert not doubtful_parts_in(whole.links, whole.joints, whole.sensors).parts
    changed = []
    for part in parts(whole):
        texts = [field.name for field in fields(part) if type(getattr(part, field.name)) is str]
        changes = [{name: TOLL} for name in texts] + [{"extra_attributes": [("a", TOLL)]}, {"extra_elements": ["<a>"]}]
        for change in changes:
            with suppress(RobotModelError, TypeError):  # its constructor refuses it, or has no such field
                changed.append(replace(part, **change))
    assert len(changed) > 200
    assert [part for part in changed if not doubtful_parts_in([part]).parts] == []


FORCES = Sensor("ft", SensorType.FORCE_TORQUE, "tool", force_torque_info=ForceTorqueInfo())
WRIST = Joint("wrist", JointType.FIXED, "base", "tool")


def test_forces_need_a_joint_above_the_link():
    assert limits_of(robot(sensors=[FORCES])) == [
        ("LF7101", "Gazebo measures forces in the joint above a link, and there is none above 'tool'")
    ]


def test_forces_in_a_fixed_joint_need_it_preserved():
    [(code, message)] = limits_of(robot(sensors=[FORCES], joints=[WRIST]))
    assert code == "LF7102"
    assert "'wrist'" in message
    preserved = GazeboElement("wrist", {"preserveFixedJoint": "true"})
    assert not limits_of(robot(sensors=[FORCES], joints=[WRIST], gazebo_elements=[preserved]))


def test_a_contact_sensor_has_no_noise():
    contact = Sensor("bump", SensorType.CONTACT, "base", contact_info=ContactInfo("hull", SensorNoise()))
    assert [code for code, _ in limits_of(robot(sensors=[contact]))] == ["LF7103"]


def test_a_frame_is_left_out_for_gazebo_classic_alone():
    camera = Sensor("eye", SensorType.CAMERA, "base", camera_info=CameraInfo(), frame="eye_optical")
    assert not limits_of(robot(sensors=[camera]))
    assert [code for code, _ in limits_of(robot(sensors=[camera]), gazebo="classic")] == ["LF7104"]


def test_the_info_of_another_type_is_left_out():
    imu = Sensor("imu", SensorType.IMU, "base", imu_info=IMUInfo(), camera_info=CameraInfo())
    assert limits_of(robot(sensors=[imu])) == [("LF7105", "a sensor of type imu has no 'camera'; it is omitted")]


def test_fields_that_are_not_looked_into_refuse_text():
    trusted = {
        (type(part), name): part
        for part in parts(full())
        if isinstance(part, Element | Link)
        for name, spec in field_specs(type(part)).items()
        if spec.xml and not isinstance(spec, Vector) and name not in _ways_into(type(part))[0]
    }
    assert len(trusted) > 50
    for (_, name), part in trusted.items():
        with pytest.raises((RobotModelError, TypeError)):
            replace(part, **{name: TOLL})
    with pytest.raises((RobotModelError, TypeError)):
        Vector3(TOLL, 0, 0)  # what the others hold
