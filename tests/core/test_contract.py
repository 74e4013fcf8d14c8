"""The contract: names, order of fields, defaults and signatures as LinkForge's "Data Models" page gives them."""

import dataclasses
import inspect
import math
from collections.abc import Iterator

import pytest

from linkforge_compile import core
from linkforge_compile.core import (
    FileSystemResolver,
    GeometryType,
    InertiaTensor,
    JointType,
    LinkPhysics,
    RobotModelError,
    SemanticRobotDescription,
    SensorType,
    Transform,
    TransmissionType,
    ValidationErrorCode,
    Vector3,
    exceptions,
    models,
)

REQUIRED = "required"
IDENTITY = Transform(Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0))
ONE = Vector3(1.0, 1.0, 1.0)
FLOOR = InertiaTensor(1e-9, 1e-9, 1e-9, 0.0, 0.0, 0.0)
NO = None

# Typed from the page: each class with its positional fields, in order, and their defaults.
FIELDS: dict[str, dict[str, object]] = {
    "Vector3": {"x": REQUIRED, "y": REQUIRED, "z": REQUIRED},
    "Transform": {"xyz": Vector3(0, 0, 0), "rpy": Vector3(0, 0, 0)},
    "Box": {"size": REQUIRED},
    "Cylinder": {"radius": REQUIRED, "length": REQUIRED},
    "Sphere": {"radius": REQUIRED},
    "Mesh": {"resource": REQUIRED, "scale": ONE},
    "Capsule": {"radius": REQUIRED, "length": REQUIRED},
    "JointLimits": {"lower": NO, "upper": NO, "effort": 10.0, "velocity": 1.0},
    "JointDynamics": {"damping": 0.0, "friction": 0.0},
    "JointMimic": {"joint": REQUIRED, "multiplier": 1.0, "offset": 0.0},
    "JointSafetyController": {"soft_lower_limit": NO, "soft_upper_limit": NO, "k_position": NO, "k_velocity": 0.0},
    "JointCalibration": {"rising": NO, "falling": NO},
    "Joint": {
        **dict.fromkeys(("name", "type", "parent", "child"), REQUIRED),
        "origin": IDENTITY,
        **dict.fromkeys(("axis", "limits", "dynamics", "mimic", "safety_controller", "calibration"), NO),
    },
    "InertiaTensor": {**dict.fromkeys(("ixx", "iyy", "izz"), REQUIRED), **dict.fromkeys(("ixy", "ixz", "iyz"), 0.0)},
    "Inertial": {"mass": REQUIRED, "origin": IDENTITY, "inertia": FLOOR},
    "LinkPhysics": {"self_collide": False, "gravity": True, "mu": 1.0, "mu2": 1.0, "kp": 1e12, "kd": 1.0},
    "Visual": {"geometry": REQUIRED, "origin": IDENTITY, "material": NO, "name": NO},
    "Collision": {"geometry": REQUIRED, "origin": IDENTITY, "name": NO},
    "Link": {"name": REQUIRED, "inertial": NO, "physics": LinkPhysics(), "visuals": (), "collisions": ()},
    "Color": {"r": REQUIRED, "g": REQUIRED, "b": REQUIRED, "a": 1.0},
    "Material": {"name": REQUIRED, "color": NO, "texture": NO},
    "SensorNoise": {"type": "gaussian", "mean": 0.0, "stddev": 0.0, "bias_mean": 0.0, "bias_stddev": 0.0},
    "CameraInfo": {
        "horizontal_fov": 1.047,
        "width": 640,
        "height": 480,
        "format": "R8G8B8",
        "near_clip": 0.1,
        "far_clip": 100.0,
        "noise": NO,
    },
    "LidarInfo": {
        "horizontal_samples": 640,
        "horizontal_resolution": 1.0,
        "horizontal_min_angle": -math.pi / 2,
        "horizontal_max_angle": math.pi / 2,
        "vertical_samples": 1,
        "vertical_resolution": 1.0,
        "vertical_min_angle": 0.0,
        "vertical_max_angle": 0.0,
        "range_min": 0.1,
        "range_max": 10.0,
        "range_resolution": 0.01,
        "noise": NO,
    },
    "IMUInfo": {"angular_velocity_noise": NO, "linear_acceleration_noise": NO},
    "GPSInfo": {
        f"{what}_sensing_{where}_noise": NO for what in ("position", "velocity") for where in ("horizontal", "vertical")
    },
    "ContactInfo": {"collision": REQUIRED, "noise": NO},
    "ForceTorqueInfo": {"frame": "child", "measure_direction": "child_to_parent", "noise": NO},
    "Sensor": {
        **dict.fromkeys(("name", "type", "link_name"), REQUIRED),
        **{"update_rate": 30.0, "always_on": True, "visualize": False},
        **dict.fromkeys(("camera_info", "lidar_info", "imu_info", "gps_info"), NO),
        **{"contact_info": NO, "force_torque_info": NO, "origin": IDENTITY, "topic": NO, "plugin": NO},
    },
    "TransmissionJoint": {
        "name": REQUIRED,
        "hardware_interfaces": ("position",),
        "mechanical_reduction": 1.0,
        "offset": 0.0,
    },
    "TransmissionActuator": {
        "name": REQUIRED,
        "hardware_interfaces": ("position",),
        "mechanical_reduction": 1.0,
        "offset": 0.0,
    },
    "Transmission": {"name": REQUIRED, "type": REQUIRED, "joints": (), "actuators": (), "parameters": {}},
    "GazeboPlugin": {"name": REQUIRED, "filename": REQUIRED, "parameters": {}, "raw_xml": NO},
    "GazeboElement": {
        **{"reference": NO, "properties": {}, "plugins": ()},
        **dict.fromkeys(("material", "static", "stop_cfm", "stop_erp"), NO),
        **{"provide_feedback": NO, "implicit_spring_damper": NO},
    },
    "Ros2ControlJoint": {"name": REQUIRED, "command_interfaces": (), "state_interfaces": (), "parameters": {}},
    "Ros2ControlGpio": {"name": REQUIRED, "command_interfaces": (), "state_interfaces": (), "parameters": {}},
    "Ros2ControlSensor": {"name": REQUIRED, "state_interfaces": (), "parameters": {}},
    "Ros2Control": {
        **{"name": REQUIRED, "type": "system", "hardware_plugin": "", "joints": (), "sensors": (), "parameters": {}}
    },
    "VirtualJoint": dict.fromkeys(("name", "type", "parent_frame", "child_link"), REQUIRED),
    "GroupState": {"name": REQUIRED, "group": REQUIRED, "joint_values": {}},
    "EndEffector": {**dict.fromkeys(("name", "group", "parent_link"), REQUIRED), "parent_group": NO},
    "PassiveJoint": {"name": REQUIRED},
    "CollisionPair": {"link1": REQUIRED, "link2": REQUIRED, "reason": NO},
    "Chain": {"base_link": REQUIRED, "tip_link": REQUIRED},
    "PlanningGroup": {"name": REQUIRED, "links": (), "joints": (), "chains": (), "subgroups": ()},
    "SrdfSphere": dict.fromkeys(("center_x", "center_y", "center_z", "radius"), REQUIRED),
    "LinkSphereApproximation": {"link": REQUIRED, "spheres": ()},
    "JointProperty": dict.fromkeys(("joint_name", "property_name", "value"), REQUIRED),
    "SemanticRobotDescription": {
        "robot_name": "",
        **dict.fromkeys(("virtual_joints", "groups", "group_states", "end_effectors", "passive_joints"), ()),
        **dict.fromkeys(("disabled_collisions", "enabled_collisions", "no_default_collision_links"), ()),
        **dict.fromkeys(("link_sphere_approximations", "joint_properties"), ()),
    },
    "Robot": {
        **{
            "name": REQUIRED,
            "version": "1.1",
            "materials": {},
            "metadata": {},
            "resource_resolver": FileSystemResolver,
        },
        **dict.fromkeys(("links", "joints", "sensors", "transmissions", "ros2_controls", "gazebo_elements"), ()),
        **{"semantic": NO, "extra_elements": ()},
    },
}

# Ours beside the contract: by keyword only, so that what stands there positionally is the contract's alone.
OURS = {
    "Sensor": {"frame": NO},
    "Joint": {"axis_as_written": NO},
    "Ros2Control": {"gpios": ()},
    "Robot": {"version_stated": False},
}

ENUMS = {
    JointType: "revolute continuous prismatic fixed floating planar",
    GeometryType: "box cylinder sphere mesh capsule",
    SensorType: "camera depth_camera lidar ray gpu_lidar imu gps force_torque contact rgbd_camera",
    TransmissionType: "transmission_interface/SimpleTransmission transmission_interface/DifferentialTransmission "
    "transmission_interface/FourBarLinkageTransmission custom",
    ValidationErrorCode: "invalid_name duplicate_name name_empty not_found has_cycle no_root multiple_roots "
    "out_of_range value_empty invalid_value physics_violation inertia_triangle_inequality mesh_unwelded "
    "mesh_duplicate_face mesh_degenerate mesh_boundary_edge mesh_non_manifold mesh_inconsistent_winding mesh_sliver "
    "generic_failure",
}

METHODS = {
    "add_link": "link overwrite=False",
    "add_joint": "joint",
    "add_sensor": "sensor",
    "add_transmission": "transmission",
    "add_ros2_control": "ros2_control",
    "update_ros2_control": "ros2_control",
    "add_gazebo_element": "element",
    "get_gazebo_elements": "reference=None",
    **{
        method: "name"
        for kind in ("link", "joint", "sensor", "transmission", "ros2_control")
        for method in (kind, f"get_{kind}", f"has_{kind}")
    },
    "get_joints_for_link": "link_name as_parent=True",
    "get_child_joints": "link_name",
    "get_parent_joint": "link_name",
    "get_parent_link": "link_name",
    "get_child_links": "link_name",
    "get_root_link": "",
    "add_group": "name links=None joints=None chains=None subgroups=None base_link=None tip_link=None",
    "disable_collisions": "link1 link2 reason='Adjacent'",
    "disable_all_collisions": "links reason='Adjacent'",
    "enable_collisions": "link1 link2 reason=None",
    "disable_default_collisions": "link",
    "add_joint_property": "joint_name property_name value",
    "approximate_link_collision": "link spheres",
    "merge": "component at_link joint_name prefix='' joint_type=<JointType.FIXED: 'fixed'> origin=None axis=None "
    "limits=None joint=None",
    "prefix_all": "prefix",
    "clone": "",
    "normalized": "",
    "summary": "",
    "export_urdf": "validate=True pretty_print=True",
    "export_srdf": "validate=True pretty_print=True",
    "resolve_resource": "uri relative_to=None",
}
PROPERTIES = ("graph", "root_link", "has_cycle", "total_mass", "degrees_of_freedom")

PARENTS = {
    "RobotModelError": "LinkForgeError",
    "RobotValidationError": "RobotModelError",
    "RobotPhysicsError": "RobotModelError",
    "RobotMathError": "RobotModelError",
    "RobotSecurityError": "RobotModelError",
    "RobotGeneratorError": "LinkForgeError",
    "RobotGeneratorUnsupportedTypeError": "RobotGeneratorError",
    "RobotParserError": "LinkForgeError",
    "RobotParserIOError": "RobotParserError",
    "RobotParserXMLRootError": "RobotParserError",
    "RobotParserUnexpectedError": "RobotParserError",
    "RobotXacroError": "RobotParserError",
    "RobotXacroRecursionError": "RobotXacroError",
    "RobotXacroExpressionError": "RobotXacroError",
    "XacroDetectedError": "RobotParserError",
}


def fields_of(cls: type, *, kw_only: bool) -> Iterator[tuple[str, object]]:
    for field in dataclasses.fields(cls):
        if not field.init or field.kw_only is not kw_only:
            continue
        if field.default_factory is not dataclasses.MISSING:
            made = field.default_factory
            yield field.name, made if made is FileSystemResolver else made()
        else:
            yield field.name, REQUIRED if field.default is dataclasses.MISSING else field.default


@pytest.mark.parametrize("name", FIELDS)
def test_fields_stand_in_order_with_their_defaults(name):
    cls = getattr(core, name)
    assert list(fields_of(cls, kw_only=False)) == list(FIELDS[name].items())
    for field, default in OURS.get(name, {}).items():
        assert dict(fields_of(cls, kw_only=True))[field] == default


@pytest.mark.parametrize("name", FIELDS)
def test_dataclasses_gives_the_fields_of_the_contract_first(name):
    names = [field.name for field in dataclasses.fields(getattr(core, name))]
    assert names[: len(FIELDS[name])] == list(FIELDS[name])


def test_missing_semantics_are_an_empty_description():
    assert core.Robot("r").semantic == SemanticRobotDescription(robot_name="r")


def test_every_class_with_fields_is_in_the_table():
    classes = {name for name in models.__all__ if dataclasses.is_dataclass(getattr(core, name))}
    assert classes - {"Controller"} == set(FIELDS)  # LinkForge has no controllers


@pytest.mark.parametrize("enum", ENUMS, ids=lambda enum: enum.__name__)
def test_enums_have_these_values_and_are_their_text(enum):
    assert {str(member) for member in enum} == set(ENUMS[enum].split())


@pytest.mark.parametrize("enum", [JointType, GeometryType, SensorType, ValidationErrorCode], ids=lambda e: e.__name__)
def test_members_of_enums_are_called_as_their_values_in_capitals(enum):
    assert [member.name for member in enum] == [member.value.upper() for member in enum]


def test_kinds_of_transmissions_are_called_so():
    assert [kind.name for kind in TransmissionType] == ["SIMPLE", "DIFFERENTIAL", "FOUR_BAR_LINKAGE", "CUSTOM"]


@pytest.mark.parametrize("name", METHODS)
def test_methods_of_robot_have_these_signatures(name):
    _, *parameters = inspect.signature(getattr(core.Robot, name)).parameters.values()
    shown = (
        parameter.name if parameter.default is parameter.empty else f"{parameter.name}={parameter.default!r}"
        for parameter in parameters
    )
    assert " ".join(shown) == METHODS[name]


@pytest.mark.parametrize("name", PROPERTIES)
def test_robot_has_these_properties(name):
    assert isinstance(getattr(core.Robot, name), property)


@pytest.mark.parametrize("name", PARENTS)
def test_errors_stand_under_these(name):
    assert issubclass(getattr(core, name), getattr(core, PARENTS[name]))


@pytest.mark.parametrize("cls", [exceptions.RobotValidationError, exceptions.RobotPhysicsError, core.RobotMathError])
def test_errors_carry_their_facts_and_say_them(cls):
    error = cls(ValidationErrorCode.OUT_OF_RANGE, "too far", "Reach", 3)
    assert (error.code, error.message, error.target, error.value) == ("out_of_range", "too far", "Reach", 3)
    prefix = {"RobotPhysicsError": "PHYSICS_", "RobotMathError": "MATH_"}.get(cls.__name__, "")
    assert str(error) == f"[{prefix}OUT_OF_RANGE] too far (target: Reach) (value: 3)"
    assert isinstance(error, RobotModelError)


def test_every_promised_name_can_be_imported_and_is_listed():
    for name in core.__all__:
        assert getattr(core, name) is not None, name
    assert len(set(core.__all__)) == len(core.__all__)
    assert set(models.__all__) < set(core.__all__)
    assert set(core.__all__) <= set(dir(core))
    with pytest.raises(AttributeError, match="no attribute 'Roboter'"):
        _ = core.Roboter
