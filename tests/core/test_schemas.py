"""The classes of the model and the schemas of the language, held against each other."""

import dataclasses
import json
from collections.abc import Mapping
from typing import Any

import pytest

from linkforge_compile.core import models
from linkforge_compile.core.fields import Spec, field_specs
from linkforge_compile.core.part import Part
from linkforge_compile.resources import schemas_folder

EVERYWHERE = {"extra", "extra_attributes", "extra_inside"}
CLASSES: Mapping[str, str] = {
    "controller": "Controller",
    "geometry#box": "Box",
    "geometry#capsule": "Capsule",
    "geometry#cylinder": "Cylinder",
    "geometry#mesh": "Mesh",
    "geometry#sphere": "Sphere",
    "gazebo": "GazeboElement",
    "gazebo#plugin": "GazeboPlugin",
    "gazebo#robot_gazebo": "GazeboElement",
    "joint": "Joint",
    "joint#calibration": "JointCalibration",
    "joint#dynamics": "JointDynamics",
    "joint#limits": "JointLimits",
    "joint#mimic": "JointMimic",
    "joint#safety_controller": "JointSafetyController",
    "link": "Link",
    "link#collision": "Collision",
    "link#inertia": "InertiaTensor",
    "link#inertial": "Inertial",
    "link#physics": "LinkPhysics",
    "link#visual": "Visual",
    "material": "Material",
    "ros2_control": "Ros2Control",
    "ros2_control#ros2_control_gpio": "Ros2ControlGpio",
    "ros2_control#ros2_control_joint": "Ros2ControlJoint",
    "ros2_control#ros2_control_sensor": "Ros2ControlSensor",
    "sensor": "Sensor",
    "sensor#camera": "CameraInfo",
    "sensor#contact": "ContactInfo",
    "sensor#force_torque": "ForceTorqueInfo",
    "sensor#gps": "GPSInfo",
    "sensor#imu": "IMUInfo",
    "sensor#lidar": "LidarInfo",
    "sensor#noise": "SensorNoise",
    "sensor#sensor_plugin": "GazeboPlugin",
    "srdf": "SemanticRobotDescription",
    "srdf#approximating_sphere": "SrdfSphere",
    "srdf#chain": "Chain",
    "srdf#end_effector": "EndEffector",
    "srdf#group": "PlanningGroup",
    "srdf#group_state": "GroupState",
    "srdf#passive_joint": "PassiveJoint",
    "srdf#reason": "CollisionPair",
    "srdf#sphere_approximation": "LinkSphereApproximation",
    "srdf#virtual_joint": "VirtualJoint",
    "transmission": "Transmission",
    "transmission#transmission_actuator": "TransmissionActuator",
    "transmission#transmission_joint": "TransmissionJoint",
    "values#origin": "Transform",
}
"""The class of each schema, or of a definition in it."""

SHAPES = {"box", "capsule", "cylinder", "mesh", "sphere"}
TAGS = {
    "dampingFactor",
    "disableFixedJointLumping",
    "fdir1",
    "fudgeFactor",
    "gravity",
    "kd",
    "kp",
    "laserRetro",
    "maxContacts",
    "maxVel",
    "minDepth",
    "mu1",
    "mu2",
    "preserveFixedJoint",
    "selfCollide",
    "springReference",
    "springStiffness",
    "turnGravityOff",
}
ONLY_IN_SCHEMA: Mapping[str, set[str]] = {
    "gazebo": TAGS,  # become `properties`
    "gazebo#robot_gazebo": TAGS,
    "joint": {"gazebo"},  # becomes an element of the robot
    "link": {"gazebo"},
    "link#collision": SHAPES,  # each is a class of `geometry`
    "link#inertial": {"density"},  # becomes the mass
    "link#visual": SHAPES,
    "sensor#sensor_plugin": {"name"},  # a sensor has one plugin, which no map names
    "srdf#group": {"chain"},  # the short form of `chains`
}
ONLY_IN_CLASS: Mapping[str, set[str]] = {
    "gazebo": {"reference"},  # the link or joint around it
}
REQUIRED_OF_SOME: Mapping[str, set[str]] = {
    "controller": {"type"},  # of all but the manager
    "joint": {"limits"},  # of revolute and prismatic joints
    "sensor": {"contact"},  # of contact sensors
}
WITHOUT_SCHEMA = {
    "Color",  # a list of numbers
    "Interface",  # its keys are the names of its parameters
    "JointProperty",  # a text
    "Vector3",  # a list of numbers
}

WITHOUT_CLASS = {
    "defaults",  # are in the elements that they complete
    "frame",  # becomes the origin of what is in it
    "material#color",  # a list of numbers
    "material#visual_material",  # a `Material` too
    "module",  # becomes links and joints
    "module#module_joint",  # a `Joint` too
    "parameter",  # replaced by its value
    "robot",  # is read by hand
    "ros2_control#interface",  # its keys are the names of its parameters
}

HOW_IT_WAS_WRITTEN = {
    "axis_as_written",
    "extra_attributes",
    "extra_elements",
    "extra_inside",
    "interfaces_stated",
    "is_scale_stated",
    "is_stated",
    "raw_xml",
    "source",
    "stated",
}
"""Fields that no key of the language sets: where and how an element was written, and raw XML."""


def entries_of(schema: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries of an object in a schema, alone or together with a short form."""
    forms = (schema, *schema.get("anyOf", ()))
    return next((form["properties"] for form in forms if "properties" in form), {})


def schema_at(place: str) -> Mapping[str, Any]:
    """Return the schema of a file, or a definition in it."""
    file, _, name = place.partition("#")
    schema = json.loads((schemas_folder() / f"{file}.schema.json").read_text("utf-8"))
    return schema["definitions"][name] if name else schema


def entries_at(place: str) -> dict[str, Any]:
    entries = entries_of(schema_at(place))
    return {key: entry for key, entry in entries.items() if key not in EVERYWHERE}


def description_of(entry: Mapping[str, Any], place: str) -> str:
    """Return the schema of a key, written there or in the definition of its values."""
    if "description" in entry or "$ref" not in entry:
        return entry.get("description", "")
    file, _, definition = entry["$ref"].partition("#/definitions/")
    here = place.partition("#")[0]
    return schema_at(f"{file.removesuffix('.schema.json') or here}#{definition}").get("description", "")


def specs_at(place: str) -> list[Spec]:
    """Return the specs of a class that have a key in the language."""
    return [spec for spec in field_specs(getattr(models, CLASSES[place])).values() if spec.key]


@pytest.mark.parametrize("place", CLASSES)
def test_a_class_and_its_schema_have_the_same_fields(place: str):
    described = {spec.key for spec in specs_at(place)}
    assert entries_at(place).keys() - described == ONLY_IN_SCHEMA.get(place, set())
    assert described - entries_at(place).keys() == ONLY_IN_CLASS.get(place, set())


@pytest.mark.parametrize("place", CLASSES)
def test_a_class_and_its_schema_require_the_same_fields(place: str):
    entries = {key: entry for key, entry in entries_at(place).items() if key not in ONLY_IN_SCHEMA.get(place, ())}
    required = {key for key, entry in entries.items() if "required" in description_of(entry, place).lower()}
    assert required - REQUIRED_OF_SOME.get(place, set()) == {spec.key for spec in specs_at(place) if spec.example}


def test_every_class_of_the_model_has_a_schema():
    kinds = {name: getattr(models, name) for name in models.__all__}
    parts = (Part, models.Link, models.Interface)
    names = {name for name, kind in kinds.items() if isinstance(kind, type) and issubclass(kind, parts)}
    assert names - set(CLASSES.values()) == WITHOUT_SCHEMA


def test_every_object_of_a_schema_has_a_class():
    places = set()
    for path in schemas_folder().glob("*.schema.json"):
        schema, file = json.loads(path.read_text("utf-8")), path.name.removesuffix(".schema.json")
        objects = {file: schema, **{f"{file}#{name}": one for name, one in schema.get("definitions", {}).items()}}
        places |= {place for place, one in objects.items() if entries_of(one)}
    assert places - set(CLASSES) == WITHOUT_CLASS


@pytest.mark.parametrize("name", sorted(set(CLASSES.values())))
def test_every_field_of_a_class_is_described_or_tells_how_it_was_written(name: str):
    kind = getattr(models, name)
    assert {field.name for field in dataclasses.fields(kind)} - field_specs(kind).keys() <= HOW_IT_WAS_WRITTEN
