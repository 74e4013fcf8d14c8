"""Hypothesis strategies that draw valid parts of robots."""

from collections.abc import Sequence

from hypothesis import strategies as st

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
from linkforge_compile.core.models.transmission import (
    Transmission,
    TransmissionActuator,
    TransmissionJoint,
    TransmissionType,
)

Strategy = st.SearchStrategy


def tuples_of(members: Strategy, *, min_size: int = 0, max_size: int = 3, unique_by: object = None) -> Strategy:
    return st.lists(members, min_size=min_size, max_size=max_size, unique_by=unique_by).map(tuple)


def maybe(values: Strategy) -> Strategy:
    return st.none() | values


def by_name(part: object) -> str:
    return part.name


names = st.text("abz09_-./éλ链", min_size=1, max_size=6)
prefixes = names.filter(lambda name: name[0] != "/")  # a leading slash would make a relative topic absolute
texts = st.text("ab <&'\"é\n", max_size=6)
words = st.text("abz", min_size=1, max_size=4)
parameters = st.dictionaries(names, texts, max_size=2)
extras = {
    "extra_attributes": tuples_of(st.tuples(words, texts), max_size=1),
    "extra_elements": tuples_of(words.map("<{}/>".format), max_size=1),
}

numbers = st.integers(-9, 9) | st.floats(-1e6, 1e6)
sizes = st.integers(1, 9) | st.floats(1e-3, 1e3)
not_negative = st.just(0) | sizes
angles = st.floats(-7, 7)

vectors = st.builds(Vector3, numbers, numbers, numbers)
extents = st.builds(Vector3, sizes, sizes, sizes)
rotations = st.builds(Vector3, angles, angles, angles)
poses = st.builds(Transform, vectors, rotations)
axes = st.sampled_from([Vector3(1, 0, 0), Vector3(0, -1.0, 0), Vector3(0.6, 0.0, 0.8)])

boxes = st.builds(Box, extents)
cylinders = st.builds(Cylinder, sizes, sizes)
spheres = st.builds(Sphere, sizes)
capsules = st.builds(Capsule, sizes, sizes)
meshes = st.builds(Mesh, texts, extents)
primitives = boxes | cylinders | spheres | capsules
geometries = primitives | meshes

shares = st.floats(0, 1)
colors = st.builds(Color, shares, shares, shares, shares)
materials = st.builds(Material, names, colors, maybe(texts), after_links=st.booleans())

tensors = st.builds(InertiaTensor, numbers, numbers, numbers, numbers, numbers, numbers, **extras)
inertials = st.builds(Inertial, not_negative, poses, tensors)
visuals = st.builds(Visual, geometries, poses, maybe(materials), maybe(names), **extras)
collisions = st.builds(Collision, geometries, poses, maybe(names), **extras)
link_physics = st.builds(LinkPhysics, st.booleans(), mu=sizes)


def links(named: Strategy = names) -> Strategy:
    orders = tuples_of(st.sampled_from(["visual", "collision"]), max_size=6)
    shapes = tuples_of(visuals), tuples_of(collisions)
    return st.builds(Link, named, maybe(inertials), link_physics, *shapes, shape_order=orders, **extras)


limits = st.builds(
    lambda ends, effort, velocity: JointLimits(min(ends), max(ends), effort, velocity),
    st.tuples(numbers, numbers),
    not_negative,
    not_negative,
)


@st.composite
def joints(draw: st.DrawFn, named: Strategy = names, ends: Strategy | None = None) -> Joint:
    """Draw a joint of any type; `ends` gives its parent and child, two different links."""
    kind = draw(st.sampled_from(JointType))
    parent, child = draw(st.lists(names, min_size=2, max_size=2, unique=True) if ends is None else ends)
    turns = kind not in {JointType.FIXED, JointType.FLOATING}
    return Joint(
        draw(named),
        kind,
        parent,
        child,
        draw(poses),
        draw(axes) if turns else None,
        draw(limits) if turns else None,
        draw(maybe(st.builds(JointDynamics, not_negative, not_negative))),
        draw(maybe(st.builds(JointMimic, names, numbers, numbers))),
        draw(maybe(st.builds(JointSafetyController, maybe(numbers), maybe(numbers)))),
        draw(maybe(st.builds(JointCalibration, maybe(numbers), maybe(numbers)))),
        axis_as_written=draw(maybe(vectors)) if turns else None,
    )


plugins = st.builds(GazeboPlugin, names, words, parameters, maybe(texts))


def gazebo_elements(references: Strategy | None = None) -> Strategy:
    return st.builds(
        GazeboElement,
        maybe(names) if references is None else references,
        parameters,
        tuples_of(plugins),
        stop_cfm=maybe(not_negative),
        stop_erp=maybe(shares),
        static=maybe(st.booleans()),
    )


noises = maybe(st.builds(SensorNoise, mean=numbers, stddev=not_negative))
sensor_infos = {
    SensorType.CAMERA: ("camera_info", st.builds(CameraInfo, noise=noises)),
    SensorType.DEPTH_CAMERA: ("camera_info", st.builds(CameraInfo, width=st.integers(1, 4096))),
    SensorType.RGBD_CAMERA: ("camera_info", st.builds(CameraInfo)),
    SensorType.LIDAR: ("lidar_info", st.builds(LidarInfo, noise=noises)),
    SensorType.RAY: ("lidar_info", maybe(st.builds(LidarInfo))),
    SensorType.GPU_LIDAR: ("lidar_info", maybe(st.builds(LidarInfo))),
    SensorType.IMU: ("imu_info", st.builds(IMUInfo, noises, noises)),
    SensorType.GPS: ("gps_info", st.builds(GPSInfo, noises)),
    SensorType.CONTACT: ("contact_info", st.builds(ContactInfo, names, noises)),
    SensorType.FORCE_TORQUE: ("force_torque_info", st.builds(ForceTorqueInfo)),
}
topics = st.sampled_from(["scan", "camera/image", "/camera", "~/camera"])


@st.composite
def sensors(draw: st.DrawFn, named: Strategy = names, on: Strategy = names) -> Sensor:
    """Draw a sensor of any type, with the info of its type, on a link that `on` draws."""
    kind = draw(st.sampled_from(SensorType))
    info, values = sensor_infos[kind]
    return Sensor(
        draw(named),
        kind,
        draw(on),
        draw(sizes),
        origin=draw(poses),
        topic=draw(maybe(topics)),
        plugin=draw(maybe(plugins)),
        frame=draw(maybe(names)),
        **{info: draw(values)},
    )


interfaces = st.sampled_from(["position", "velocity", "effort"]) | st.builds(Interface, words, parameters)


def transmission_end(kind: type, named: Strategy) -> Strategy:
    return st.builds(kind, named, tuples_of(words, min_size=1), st.none() | sizes, numbers)


@st.composite
def transmissions(draw: st.DrawFn, named: Strategy = names, moved: Strategy = names) -> Transmission:
    """Draw a transmission of any type, with joints that `moved` draws."""
    kind = draw(st.sampled_from(TransmissionType))
    count = {TransmissionType.SIMPLE: 1, TransmissionType.CUSTOM: draw(st.integers(1, 3))}.get(kind, 2)
    actuators = transmission_end(TransmissionActuator, names)
    return Transmission(
        draw(named),
        kind,
        draw(tuples_of(transmission_end(TransmissionJoint, moved), min_size=count, max_size=count, unique_by=by_name)),
        draw(tuples_of(actuators, min_size=count, max_size=count, unique_by=by_name)),
        draw(parameters),
    )


def ros2_controls(named: Strategy = names, moved: Strategy = names) -> Strategy:
    """Return hardware systems with joints that `moved` draws."""
    joint = st.builds(Ros2ControlJoint, moved, tuples_of(interfaces, min_size=1), tuples_of(interfaces), parameters)
    return st.builds(
        Ros2Control,
        named,
        st.just("system"),
        words,
        tuples_of(joint, unique_by=by_name),
        tuples_of(st.builds(Ros2ControlSensor, names, tuples_of(interfaces)), unique_by=by_name),
        parameters,
        gpios=tuples_of(st.builds(Ros2ControlGpio, names, tuples_of(interfaces)), unique_by=by_name),
    )


pairs = st.lists(names, min_size=2, max_size=2, unique=True)
collision_pairs = st.builds(lambda ends, reason: CollisionPair(*ends, reason), pairs, maybe(words))
chains = st.builds(Chain, names, names)
groups = st.builds(
    PlanningGroup, names, tuples_of(names, min_size=1), tuples_of(names), tuples_of(chains), tuples_of(names)
)
group_states = st.builds(GroupState, names, names, st.dictionaries(names, numbers | st.lists(numbers), max_size=3))
end_effectors = st.builds(EndEffector, names, names, names, maybe(names))
virtual_joints = st.builds(VirtualJoint, names, st.sampled_from(["fixed", "planar", "floating"]), names, names)
passive_joints = st.builds(PassiveJoint, names)
srdf_spheres = st.builds(SrdfSphere, numbers, numbers, numbers, not_negative)
sphere_approximations = st.builds(LinkSphereApproximation, names, tuples_of(srdf_spheres))
joint_properties = st.builds(JointProperty, names, names, words)
semantics = st.builds(
    SemanticRobotDescription,
    st.just("") | names,
    tuples_of(virtual_joints, max_size=1),
    tuples_of(groups),
    tuples_of(group_states),
    tuples_of(end_effectors, max_size=1),
    tuples_of(passive_joints),
    tuples_of(collision_pairs),
    tuples_of(collision_pairs, max_size=1),
    tuples_of(names),
    tuples_of(sphere_approximations, max_size=1),
    tuples_of(joint_properties, max_size=2),
)

PREFIXED: Sequence[Strategy] = (
    materials,
    visuals,
    collisions,
    links(),
    joints(),
    plugins,
    gazebo_elements(),
    sensors(),
    transmissions(),
    ros2_controls(),
    semantics,
)
"""Every kind of part with `with_prefix`, which also prefixes the parts inside."""

parts = st.one_of(*PREFIXED, poses, tensors, inertials, link_physics, geometries)


def semantics_about(links: Strategy, joints: Strategy) -> Strategy:
    """Return semantic descriptions without duplicates."""
    group = st.builds(PlanningGroup, names, tuples_of(links, min_size=1), tuples_of(joints))
    state = st.builds(GroupState, names, names, st.dictionaries(joints, numbers, max_size=2))
    return st.builds(
        SemanticRobotDescription,
        groups=tuples_of(group, unique_by=by_name),
        group_states=tuples_of(state, unique_by=lambda state: (state.group, state.name)),
        passive_joints=tuples_of(passive_joints, unique_by=by_name),
        disabled_collisions=tuples_of(collision_pairs, unique_by=lambda pair: pair.key),
        no_default_collision_links=tuples_of(links, unique_by=str),
        joint_properties=tuples_of(joint_properties, max_size=1),
    )


@st.composite
def robots(draw: st.DrawFn) -> Robot:
    """Draw a robot whose links form one tree, with other parts of every kind."""
    robot = Robot(draw(names), materials={material.name: material for material in draw(tuples_of(materials))})
    link_names = draw(st.lists(names, min_size=1, max_size=4, unique=True))
    joint_names = draw(st.lists(names, min_size=len(link_names), max_size=len(link_names), unique=True))
    for place, (link, joint) in enumerate(zip(link_names, joint_names, strict=True)):
        robot.add_link(draw(links(st.just(link))))
        if place:
            ends = st.tuples(st.sampled_from(link_names[:place]), st.just(link))
            robot.add_joint(draw(joints(st.just(joint), ends)))
    on, moved = st.sampled_from(link_names), st.sampled_from(joint_names)
    robot.sensors = draw(tuples_of(sensors(on=on), max_size=2, unique_by=by_name))
    if len(robot.joints) > 1:
        moved = st.sampled_from(robot.joints.names)
        robot.transmissions = draw(tuples_of(transmissions(moved=moved), max_size=1))
        robot.ros2_controls = draw(tuples_of(ros2_controls(moved=moved), max_size=2, unique_by=by_name))
    robot.gazebo_elements = draw(tuples_of(gazebo_elements(maybe(on))))
    if draw(st.booleans()):
        robot.add_semantic(draw(semantics_about(on, moved)))
    return robot
