"""A robot with every feature that real readers accept."""

from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
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
from linkforge_compile.core.models.joint import (
    Joint,
    JointCalibration,
    JointDynamics,
    JointLimits,
    JointMimic,
    JointSafetyController,
    JointType,
)
from linkforge_compile.core.models.link import Collision, Inertial, InertiaTensor, Link, LinkPhysics, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import (
    Interface,
    Ros2Control,
    Ros2ControlGpio,
    Ros2ControlJoint,
    Ros2ControlSensor,
)
from linkforge_compile.core.models.sensor import CameraInfo, IMUInfo, LidarInfo, Sensor, SensorNoise, SensorType
from linkforge_compile.core.models.srdf import (
    Chain,
    EndEffector,
    GroupState,
    JointProperty,
    PassiveJoint,
    PlanningGroup,
    SemanticRobotDescription,
    VirtualJoint,
)
from linkforge_compile.core.models.srdf_collisions import CollisionPair, LinkSphereApproximation, SrdfSphere
from linkforge_compile.core.models.transmission import Transmission

STEEL = Material("steel", Color(0.6, 0.6, 0.65))
SHAPES = {
    "base": Box(Vector3(0.4, 0.3, 0.1)),
    "slider": Cylinder(0.05, 0.2),
    "wheel": Sphere(0.1),
    "arm": Capsule(0.04, 0.3),
    "tool": Mesh("package://tools/gripper.stl", Vector3(0.001, 0.001, 0.001)),
    "finger": Box(Vector3(0.01, 0.01, 0.05)),
}
LIMITS = JointLimits(-1.0, 1.5, 50, 2.5)


def everything() -> Robot:
    """Return a robot with each shape, each kind of joint but floating and planar, and one of all else."""
    return Robot(
        "everything",
        materials={"steel": STEEL},
        links=[_body(name, mass) for mass, name in enumerate(SHAPES, start=1)] + [Link("tool0")],
        joints=_joints(),
        sensors=_sensors(),
        transmissions=[Transmission.create_simple("transmission", "shoulder", mechanical_reduction=100.0)],
        ros2_controls=[_hardware()],
        gazebo_elements=[
            GazeboElement("base", {"maxContacts": "10"}, material="Gazebo/Grey"),
            GazeboElement("wrist", {"preserveFixedJoint": "true"}),
            GazeboElement(plugins=[GazeboPlugin("control", "libcontrol.so", {"parameters": "control.yaml"})]),
        ],
        semantic=_semantic(),
        extra_elements=["<self_filter><padding>0.1</padding></self_filter>"],
    )


def _body(name: str, mass: float) -> Link:
    shape = SHAPES[name]
    return Link(
        name,
        Inertial(mass, Transform(Vector3(0, 0, 0.01)), InertiaTensor(0.02, 0.03, 0.04, 0.001)),
        LinkPhysics(mu=0.1 * mass),
        [Visual(shape, Transform(rpy=Vector3(0, 0, 0.5)), STEEL), Visual(shape, material=Material("", Color(1, 0, 0)))],
        [Collision(shape, name=f"{name}_hull")],
    )


def _joints() -> list[Joint]:
    axis = Vector3(0, 0, 1)
    return [
        Joint(
            "rail", JointType.PRISMATIC, "base", "slider", axis=axis, limits=LIMITS, calibration=JointCalibration(0.1)
        ),
        Joint("axle", JointType.CONTINUOUS, "base", "wheel", axis=axis, dynamics=JointDynamics(0.1, 0.2)),
        Joint(
            "shoulder",
            JointType.REVOLUTE,
            "slider",
            "arm",
            Transform(Vector3(0, 0, 0.2), Vector3(0.1, 0.2, 0.3)),
            Vector3(0, 0.6, 0.8),
            LIMITS,
            safety_controller=JointSafetyController(-0.9, 1.4, 20, 40),
        ),
        Joint("wrist", JointType.FIXED, "arm", "tool", Transform(Vector3(0, 0, 0.3))),
        Joint(
            "grip", JointType.PRISMATIC, "tool", "finger", axis=axis, limits=LIMITS, mimic=JointMimic("rail", 0.5, 0.1)
        ),
        Joint("tool0_joint", JointType.FIXED, "tool", "tool0"),
    ]


def _sensors() -> list[Sensor]:
    noise = SensorNoise(stddev=0.01)
    return [
        Sensor("eye", SensorType.RGBD_CAMERA, "tool", camera_info=CameraInfo(noise=noise), frame="tool0", topic="eye"),
        Sensor("scan", SensorType.LIDAR, "base", lidar_info=LidarInfo()),
        Sensor("imu", SensorType.IMU, "base", imu_info=IMUInfo(noise, noise)),
    ]


def _hardware() -> Ros2Control:
    return Ros2Control(
        "hardware",
        "system",
        "mock_components/GenericSystem",
        [Ros2ControlJoint("shoulder", [Interface("position", {"min": "-1", "max": "1"})], ["position", "velocity"])],
        [Ros2ControlSensor("force", ["force.x"], {"frame_id": "tool0"})],
        {"slowdown": "50.0"},
        gpios=[Ros2ControlGpio("flange", ["out1"], ["in1"])],
    )


def _semantic() -> SemanticRobotDescription:
    return SemanticRobotDescription(
        virtual_joints=[VirtualJoint("world_joint", "fixed", "world", "base")],
        groups=[PlanningGroup("arm", chains=[Chain("slider", "tool0")]), PlanningGroup("hand", links=["finger"])],
        group_states=[GroupState("home", "arm", {"shoulder": 0.5})],
        end_effectors=[EndEffector("hand", "hand", "tool", "arm")],
        passive_joints=[PassiveJoint("axle")],
        disabled_collisions=[CollisionPair("base", "slider", "Adjacent")],
        enabled_collisions=[CollisionPair("base", "tool")],
        no_default_collision_links=["wheel"],
        link_sphere_approximations=[LinkSphereApproximation("arm", [SrdfSphere(0, 0, 0.1, 0.05)])],
        joint_properties=[JointProperty("axle", "angle_wraparound", "true")],
    )
