"""Every field of every class of the model comes back from a spec, unless it has its default."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass, replace

from linkforge_compile import core
from linkforge_compile.core.models.controller import Controller
from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.geometry import Color, Material, Transform, Vector3
from linkforge_compile.core.models.joint import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from linkforge_compile.core.models.link import Inertial, InertiaTensor, LinkPhysics
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import (
    Interface,
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)
from linkforge_compile.core.models.sensor import (
    CameraInfo,
    ContactInfo,
    ForceTorqueInfo,
    GPSInfo,
    IMUInfo,
    LidarInfo,
    Sensor,
    SensorNoise,
    SensorType,
)
from linkforge_compile.core.models.srdf import EndEffector, PlanningGroup
from linkforge_compile.core.models.srdf_collisions import CollisionPair
from linkforge_compile.core.models.transmission import Transmission, TransmissionActuator, TransmissionJoint
from linkforge_compile.core.part import Inside
from linkforge_compile.export_spec import write_spec
from linkforge_compile.export_spec.gazebo import _IS_NORMAL
from tests.conftest import ROOT
from tests.export_spec.test_laws import compiled
from tests.formats.everything import everything

POSE = Transform(Vector3(1, 2, 3), Vector3(0.1, 0.2, 0.3), is_stated=True)
NOISE = SensorNoise("gaussian_quantized", 0.1, 0.2, 0.3, 0.4)
UNBIASED = SensorNoise(bias_mean=0, bias_stddev=0, stated=["bias_mean", "bias_stddev"])
EXTRAS = {"extra_elements": ("<e/>", "<f/>"), "extra_attributes": (("x", "1"),)}


def raw(*tags: str) -> dict[str, object]:
    """Return something raw in an element and in some of those inside of it."""
    insides = [Inside(tag, name or None, **EXTRAS) for tag, _, name in (tag.partition(" ") for tag in tags)]
    return {**EXTRAS, "extra_inside": tuple(insides)}


NOTHING_INSIDE = {
    *(core.Transform, core.Box, core.Cylinder, core.Sphere, core.Capsule, core.Mesh, core.Color, core.InertiaTensor),
    *(JointLimits, JointDynamics, JointMimic, JointSafetyController, JointCalibration, core.LinkSphereApproximation),
    *(core.Chain, core.VirtualJoint, core.EndEffector, core.PassiveJoint, core.CollisionPair, core.JointProperty),
    *(core.SrdfSphere, GazeboElement, GazeboPlugin),
}
"""Elements of attributes alone, of parts, and of free parts, which say themselves what is inside."""

# A semantic part is called what its robot is, and raw XML of a plugin becomes its `extra`; the rest has no form.
NOT_OF_A_SPEC = {
    (core.SemanticRobotDescription, "robot_name"),
    (core.Joint, "axis_as_written"),
    (core.GazeboPlugin, "raw_xml"),
    *((kind, "extra_inside") for kind in NOTHING_INSIDE),
    *((Controller, name) for name in ("extra_attributes", "extra_elements", "extra_inside")),  # in no XML
}


def test_a_robot_with_something_in_every_field_comes_back_as_it_was():
    robot = full()
    assert compiled(write_spec(robot)) == robot


def test_that_robot_has_something_in_every_field():
    written = {(type(part), name) for part in parts(full()) for name in written_fields(part)}
    kinds = {kind for kind in (getattr(core, name) for name in core.__all__) if is_part(kind)}
    fields_of_all = {(kind, field.name) for kind in kinds for field in fields(kind) if field.name != "source"}
    assert fields_of_all - written - NOT_OF_A_SPEC == set()


def test_the_tags_that_may_be_keys_are_those_of_the_schema():
    schema = json.loads((ROOT / "schemas" / "gazebo.schema.json").read_text("utf-8"))
    keys = {key for block in schema["definitions"].values() for key in block.get("properties", ())}
    assert set(_IS_NORMAL) <= keys


def is_part(kind: object) -> bool:
    return (
        isinstance(kind, type)
        and is_dataclass(kind)
        and kind.__module__.startswith("linkforge_compile.core.models")
        and kind is not Robot
    )


def parts(whole: object) -> Iterator[object]:
    """Yield every part of a robot, at any depth."""
    if isinstance(whole, Mapping):
        whole = tuple(whole.values())
    if isinstance(whole, str):
        return
    if is_dataclass(whole):
        if not isinstance(whole, Robot):
            yield whole
        names = [field.name for field in fields(whole) if field.name not in {"source", "_semantic", "_drawn"}]
        for name in names:
            yield from parts(getattr(whole, name))
    elif hasattr(whole, "__iter__"):
        for item in whole:
            yield from parts(item)


def written_fields(part: object) -> Iterator[str]:
    for field in fields(part):
        default = field.default_factory() if field.default_factory is not MISSING else field.default
        if getattr(part, field.name) != default:
            yield field.name


def full() -> Robot:
    noise = replace(NOISE, **raw("mean"))
    plugin = GazeboPlugin("control", "control.so", {"frame": "tool", "gains": {"p": "1.10"}}, **EXTRAS)
    shared = Material("shared", Color(0.1, 0.2, 0.3, 0.4, **EXTRAS), "shared.png", after_links=True, **raw("texture"))
    body = core.Link(
        "body",
        Inertial(2, replace(POSE, **EXTRAS), InertiaTensor(1, 2, 3, 0.1, 0.2, 0.3, **EXTRAS), **raw("mass")),
        LinkPhysics(self_collide=True, gravity=False, mu=0.5, mu2=0.6, kp=7, kd=8),
        [core.Visual(shape, replace(POSE, **EXTRAS), shared, "seen", **raw("geometry")) for shape in _shapes()],
        [core.Collision(shape, POSE, "felt", **raw("geometry")) for shape in _shapes()],
        shape_order=["collision", "collision", "visual"],
        **EXTRAS,
    )
    return Robot(
        "full",
        "1.2",
        {"shared": shared},
        {"author": "me"},
        links=[body, core.Link("arm", physics=LinkPhysics(stated=["mu"])), core.Link("finger")],
        joints=[_joint("slide", "body", "arm"), replace(_joint("follow", "arm", "finger"), type=JointType.CONTINUOUS)],
        sensors=[replace(sensor, plugin=plugin) for sensor in _sensors(noise)],
        transmissions=[_transmission(), _without_offset()],
        ros2_controls=[_hardware()],
        controllers=[_controller()],
        gazebo_elements=[
            GazeboElement("body", {"maxContacts": "10"}),
            GazeboElement(
                "body", {"mu1": "0.9", "odd": "yes"}, [plugin], "Gazebo/Red", True, 0.1, 0.2, True, True, **EXTRAS
            ),
        ],
        semantic=_semantic(),
        version_stated=True,
        **EXTRAS,
    )


def _shapes() -> list[core.Geometry]:
    return [
        core.Box(Vector3(1, 2, 3), **EXTRAS),
        core.Cylinder(1, 2, **EXTRAS),
        core.Sphere(1, **EXTRAS),
        core.Capsule(1, 2, **EXTRAS),
        core.Mesh("arm.stl", Vector3(1, 2, 3), is_scale_stated=True, **EXTRAS),
    ]


def _joint(name: str, parent: str, child: str) -> Joint:
    return Joint(
        name,
        JointType.PRISMATIC,
        parent,
        child,
        POSE,
        Vector3(0, 0, 1),
        JointLimits(-1, 1, 2, 3, acceleration=4, deceleration=5, jerk=6, **EXTRAS),
        JointDynamics(0.1, 0.2, **EXTRAS),
        JointMimic("slide", 2, 0.5, stated=["multiplier"], **EXTRAS),
        JointSafetyController(-0.5, 0.5, 10, 20, **EXTRAS),
        JointCalibration(0.1, 0.2, **EXTRAS),
        **raw("parent", "axis"),
    )


def _sensors(noise: SensorNoise) -> list[Sensor]:
    camera = CameraInfo(1, 320, 240, "L8", 0.2, 50, noise, **raw("image"))
    lidar = LidarInfo(100, 2, -1, 1, 4, 2, -0.1, 0.1, 0.2, 20, 0.02, noise, **raw("scan"))
    common = {"update_rate": 7.5, "always_on": False, "visualize": True, "origin": POSE, "topic": "t", "frame": "arm"}
    return [
        Sensor("camera", SensorType.CAMERA, "arm", camera_info=camera, **common, **raw("always_on", "topic")),
        Sensor("lidar", SensorType.LIDAR, "arm", lidar_info=lidar, **common),
        Sensor("imu", SensorType.IMU, "arm", imu_info=IMUInfo(UNBIASED, noise, **raw("angular_velocity"))),
        Sensor("gps", SensorType.GPS, "arm", gps_info=GPSInfo(noise, noise, noise, noise, **raw("position_sensing"))),
        Sensor("touch", SensorType.CONTACT, "arm", contact_info=ContactInfo("felt", noise, **raw("collision"))),
        Sensor(
            "force",
            SensorType.FORCE_TORQUE,
            "arm",
            force_torque_info=ForceTorqueInfo("sensor", "parent_to_child", noise, **raw("frame")),
        ),
    ]


def _transmission() -> Transmission:
    joint = TransmissionJoint("slide", ["velocity", "effort"], 50, 0.1, **raw("hardwareInterface effort"))
    actuator = TransmissionActuator("motor", ["effort"], None, 0.2, **raw("offset"))
    return Transmission("gears", "custom", [joint], [actuator], {"role": {"_x": "1", "_text": "007"}}, **raw("type"))


def _without_offset() -> Transmission:
    joint = TransmissionJoint("slide", stated=["offset"], interfaces_stated=False)
    actuator = TransmissionActuator("idle", stated=["offset"], interfaces_stated=False)
    return Transmission("idler", "custom", [joint], [actuator])


def _controller() -> Controller:
    names = {"group": "arm", "joints": ["slide"], "left_wheels": ["slide"], "right_wheels": ["slide"], "frame": "body"}
    interfaces = {"command_interfaces": ["position"], "state_interfaces": ["velocity"]}
    parameters = {"gain": 1.0, "count": 1, "is_on": True, "name": "1", "list": [1, 2], "nested": {"x": 0.5}}
    return Controller("drive", "my/Controller", **names, **interfaces, sensor="wrench", parameters=parameters)


def _hardware() -> Ros2Control:
    position = Interface("position", {"min": "-1"}, **raw("param min"))
    return Ros2Control(
        "hardware",
        "actuator",
        "driver/Actuator",
        [Ros2ControlJoint("slide", [position, "velocity"], ["effort"], {"id": "007"}, **raw("param"))],
        [Ros2ControlSensor("force", ["x"], {"id": "1"}, **raw("param id"))],
        {"port": "1.10"},
        gpios=[Ros2ControlGpio("flange", ["out"], ["in"], {"id": "2"}, **raw("param id"))],
        **raw("hardware"),
    )


def _semantic() -> core.SemanticRobotDescription:
    written = everything().semantic
    chain = core.Chain("body", "arm", **EXTRAS)
    return replace(
        written,
        virtual_joints=[replace(joint, **EXTRAS) for joint in written.virtual_joints],
        groups=[
            PlanningGroup(
                "arm",
                *(["arm"], ["slide"], [chain, chain], ["hand"]),
                kinematics={"kinematics_solver_timeout": 1.0},
                **raw("joint slide", "group hand"),
            ),
            *written.groups[1:],
        ],
        end_effectors=[EndEffector("tool", "hand", "arm", "arm", **EXTRAS)],
        enabled_collisions=[CollisionPair("body", "arm", "User", **EXTRAS)],
        link_sphere_approximations=[
            replace(
                one, **EXTRAS, spheres=[replace(sphere, center_x=1, center_y=2, **EXTRAS) for sphere in one.spheres]
            )
            for one in written.link_sphere_approximations
        ],
        passive_joints=[replace(joint, **EXTRAS) for joint in written.passive_joints],
        joint_properties=[replace(remark, **EXTRAS) for remark in written.joint_properties],
        group_states=[replace(state, **raw("joint shoulder")) for state in written.group_states],
        **raw("disable_default_collisions wheel"),
    )
