"""The schema and the language cover every field of every class of the IR; what only one of them has is named here."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import NamedTuple

import pytest

from linkforge_compile import core
from linkforge_compile.core.models import gazebo as gz
from linkforge_compile.core.models import geometry, joint, link, srdf
from linkforge_compile.core.models import ros2_control as rc
from linkforge_compile.core.models import sensor as measuring
from linkforge_compile.core.models import transmission as driving
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.part import FrozenMap, Part
from linkforge_compile.schema.registry import load_files

EXTRA = {"extra_elements": "extra"}
"""Of every element."""

NOTHING_INSIDE = frozenset(
    {geometry.Transform, geometry.Box, geometry.Cylinder, geometry.Sphere, geometry.Capsule, geometry.Mesh}
    | {geometry.Color, link.InertiaTensor, joint.JointLimits, joint.JointDynamics, joint.JointMimic}
    | {joint.JointSafetyController, joint.JointCalibration, srdf.VirtualJoint, srdf.Chain}
    | {srdf.EndEffector, srdf.PassiveJoint, srdf.JointProperty, srdf.CollisionPair}
    | {srdf.SrdfSphere, srdf.LinkSphereApproximation, gz.GazeboElement, gz.GazeboPlugin}
)
"""Elements of attributes alone, of parts, or of free parts, which say themselves what is inside: no `extra_inside`."""

TAGS = frozenset(
    {"mu1", "mu2", "fdir1", "kp", "kd", "maxVel", "minDepth", "maxContacts", "selfCollide", "gravity", "turnGravityOff"}
    | {"dampingFactor", "laserRetro", "springStiffness", "springReference", "fudgeFactor", "preserveFixedJoint"}
    | {"disableFixedJointLumping"}
)
"""The tags of SDFormat, which are `properties` in the IR."""

SHAPES = frozenset({"box", "cylinder", "sphere", "capsule", "mesh"})


class Said(NamedTuple):
    """How the language has a class: the titles of its objects, its renamed fields, and those of one side only."""

    titles: tuple[str, ...]
    renamed: Mapping[str, str | frozenset[str]] = FrozenMap()
    only_in_the_ir: Mapping[str, str] = FrozenMap()
    only_in_the_schema: frozenset[str] = frozenset()


KEY = {"name": "the key of its entry"}
STATED = {"stated": "which keys are there though they say the default"}
INFOS = {f"{info}_info": info for info in ("camera", "lidar", "imu", "gps", "contact", "force_torque")}

NO_INTERFACES = {"interfaces_stated": "whether `hardware_interfaces` is other than `[]`"}

LANGUAGE: dict[type, Said] = {
    core.Robot: Said(
        ("a robot",),
        {"ros2_controls": "ros2_control", "gazebo_elements": "gazebo"},
        {
            "version_stated": "whether `version` is there",
            "resource_resolver": "no part of the robot",
        },
        frozenset({"linkforge", "description", "parameters", "variables", "data", "variants", "packages", "include"})
        | {"defaults", "frames", "mount", "modules"},
    ),
    link.Link: Said(
        ("a link",),
        {"visuals": "visual", "collisions": "collision"},
        KEY,
        frozenset({"gazebo"}),
    ),
    link.Visual: Said(("a visual",), {"geometry": SHAPES}),
    link.Collision: Said(("a collision",), {"geometry": SHAPES}),
    link.Inertial: Said(("an inertial",), only_in_the_schema=frozenset({"density"})),
    link.InertiaTensor: Said(("an inertia tensor",)),
    link.LinkPhysics: Said(("a link's physics",), {}, STATED),
    geometry.Vector3: Said((), {}, dict.fromkeys("xyz", "its place in a list of three numbers")),
    geometry.Transform: Said(("an origin",), {}, {"is_stated": "whether `origin` is there"}),
    geometry.Box: Said(("a box",)),
    geometry.Cylinder: Said(("a cylinder",)),
    geometry.Sphere: Said(("a sphere",)),
    geometry.Capsule: Said(("a capsule",)),
    geometry.Mesh: Said(("a mesh",), {"resource": "file"}, {"is_scale_stated": "whether `scale` is there"}),
    geometry.Color: Said(("a color",), dict.fromkeys("rgba", "rgba")),
    geometry.Material: Said(("a material", "a visual's material")),
    joint.Joint: Said(
        ("a joint", "a module's joint"),
        {},
        {"axis_as_written": "the same `axis`, before it was made a unit vector"},
        frozenset({"gazebo"}),
    ),
    joint.JointLimits: Said(("a joint's limits",)),
    joint.JointDynamics: Said(("a joint's dynamics",)),
    joint.JointMimic: Said(("a joint's mimic",), {}, STATED),
    joint.JointSafetyController: Said(("a joint's safety controller",)),
    joint.JointCalibration: Said(("a joint's calibration",)),
    measuring.Sensor: Said(("a sensor",), {"link_name": "link", **INFOS}, KEY),
    measuring.SensorNoise: Said(("a noise",), {}, STATED),
    measuring.CameraInfo: Said(("a camera's settings",)),
    measuring.LidarInfo: Said(("a lidar's settings",)),
    measuring.IMUInfo: Said(("an IMU's noise",)),
    measuring.GPSInfo: Said(("a GPS receiver's noise",)),
    measuring.ContactInfo: Said(("a contact sensor's settings",)),
    measuring.ForceTorqueInfo: Said(("a force-torque sensor's settings",)),
    driving.Transmission: Said(("a transmission",), {}, KEY),
    driving.TransmissionJoint: Said(("a joint of a transmission",), {}, KEY | STATED | NO_INTERFACES),
    driving.TransmissionActuator: Said(("an actuator",), {}, KEY | STATED | NO_INTERFACES),
    rc.Ros2Control: Said(("a ros2_control block",), {}, KEY),
    rc.Ros2ControlJoint: Said(("a joint of ros2_control",), {}, KEY),
    rc.Ros2ControlSensor: Said(("a sensor of ros2_control",), {}, KEY),
    rc.Ros2ControlGpio: Said(("a gpio",), {}, KEY),
    Interface: Said(("an interface's parameters",), {}, {"parameters": "all its other keys"}),
    gz.GazeboElement: Said(("a gazebo block", "a robot's gazebo block"), only_in_the_schema=TAGS),
    gz.GazeboPlugin: Said(("a plugin", "a sensor's plugin"), {}, {"raw_xml": "`parameters`, or `extra`"}),
    srdf.SemanticRobotDescription: Said(("a semantic part",), {}, {"robot_name": "the robot's name"}),
    srdf.VirtualJoint: Said(("a virtual joint",), {}, KEY),
    srdf.PlanningGroup: Said(("a group",), {}, KEY, frozenset({"chain"})),
    srdf.Chain: Said(("a chain",)),
    srdf.EndEffector: Said(("an end effector",), {}, KEY),
    srdf.GroupState: Said(
        ("joint values by name",), {}, {**KEY, "group": "the key around it", "joint_values": "all its other keys"}
    ),
    srdf.PassiveJoint: Said(("a passive joint",), {}, KEY),
    srdf.JointProperty: Said(
        ("a joint property",), {}, {"joint_name": "the key around it", "property_name": "the key of its entry"}
    ),
    srdf.CollisionPair: Said(
        ("a collision pair",), {}, {"link1": "the key around it", "link2": "the key of its entry"}
    ),
    srdf.LinkSphereApproximation: Said(("a sphere approximation",), {}, {"link": "the key of its entry"}),
    srdf.SrdfSphere: Said(
        ("an approximating sphere",), {"center_x": "center", "center_y": "center", "center_z": "center"}
    ),
}

NO_PART_OF_THE_ROBOT = frozenset(
    {"a frame", "a module", "an element inside", "a parameter", "defaults", "a data file", "an override"}
)
"""Objects that make parts of the robot and leave nothing of themselves."""


def classes_of(base: type) -> Iterator[type]:
    for kind in base.__subclasses__():
        if not kind.__name__.startswith("_") and kind.__module__.startswith("linkforge_compile.core.models"):
            yield kind
        yield from classes_of(kind)


def objects_in(schema: object) -> Iterator[tuple[str, set[str]]]:
    """Yield the title and the keys of every object that a schema describes."""
    if isinstance(schema, list):
        for part in schema:
            yield from objects_in(part)
    elif isinstance(schema, dict):
        if "properties" in schema and isinstance(schema.get("title"), str):
            yield schema["title"], set(schema["properties"])
        for part in schema.values():
            yield from objects_in(part)


CLASSES = sorted({*classes_of(Part), core.Robot, link.Link, Interface}, key=lambda kind: kind.__name__)
OBJECTS = dict(found for schema in load_files().values() for found in objects_in(schema))


def fields_of(kind: type) -> set[str]:
    if not is_dataclass(kind):
        return {"parameters", *EXTRA, "extra_attributes", "extra_inside"}
    unsaid = {"source", "extra_inside"} if kind in NOTHING_INSIDE else {"source"}
    return {field.name for field in fields(kind) if not field.name.startswith("_")} - unsaid


def keys_of(said: Said, field: str) -> frozenset[str]:
    keys = {**EXTRA, **said.renamed}.get(field, field)
    return frozenset({keys}) if isinstance(keys, str) else keys


def test_every_class_has_a_form_in_the_language():
    assert {kind.__name__ for kind in CLASSES} == {kind.__name__ for kind in LANGUAGE}


def test_every_object_of_the_schema_becomes_a_class():
    said = {title for one in LANGUAGE.values() for title in one.titles}
    assert OBJECTS.keys() - NO_PART_OF_THE_ROBOT == said


@pytest.mark.parametrize("kind", LANGUAGE, ids=lambda kind: kind.__name__)
def test_a_class_and_its_schema_say_the_same_fields(kind: type):
    said = LANGUAGE[kind]
    keys = {key for title in said.titles for key in OBJECTS[title]}
    of_fields = {key for field in fields_of(kind) - said.only_in_the_ir.keys() for key in keys_of(said, field)}
    # A name is the key of an entry, and may be a key of its own where a list holds it.
    assert keys - {"name"} - said.only_in_the_schema == of_fields - {"name"}
    assert said.only_in_the_ir.keys() <= fields_of(kind)
    assert said.only_in_the_schema <= keys
