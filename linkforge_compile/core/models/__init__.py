"""The classes of the IR, each imported when it is first asked for: sixty dataclasses take their time to define."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
    from linkforge_compile.core.models.geometry import (
        Box,
        Capsule,
        Cylinder,
        Geometry,
        GeometryType,
        Mesh,
        Sphere,
        Transform,
        Vector3,
    )
    from linkforge_compile.core.models.graph import KinematicGraph
    from linkforge_compile.core.models.interface import Interface
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
    from linkforge_compile.core.models.material import Color, Material
    from linkforge_compile.core.models.named_table import Index
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.models.ros2_control import (
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
        CollisionPair,
        EndEffector,
        GroupState,
        JointProperty,
        LinkSphereApproximation,
        PassiveJoint,
        PlanningGroup,
        SemanticRobotDescription,
        SrdfSphere,
        VirtualJoint,
    )
    from linkforge_compile.core.models.transmission import (
        Transmission,
        TransmissionActuator,
        TransmissionJoint,
        TransmissionType,
    )

_HOMES = {
    "gazebo": "GazeboElement GazeboPlugin",
    "geometry": "Box Capsule Cylinder Geometry GeometryType Mesh Sphere Transform Vector3",
    "graph": "KinematicGraph",
    "named_table": "Index",
    "interface": "Interface",
    "joint": "Joint JointCalibration JointDynamics JointLimits JointMimic JointSafetyController JointType",
    "link": "Collision InertiaTensor Inertial Link LinkPhysics Visual",
    "material": "Color Material",
    "robot": "Robot",
    "ros2_control": "Ros2Control Ros2ControlGpio Ros2ControlJoint Ros2ControlSensor",
    "sensor": "CameraInfo ContactInfo ForceTorqueInfo GPSInfo IMUInfo LidarInfo Sensor SensorNoise SensorType",
    "srdf": "Chain CollisionPair EndEffector GroupState JointProperty LinkSphereApproximation PassiveJoint "
    "PlanningGroup SemanticRobotDescription SrdfSphere VirtualJoint",
    "transmission": "Transmission TransmissionActuator TransmissionJoint TransmissionType",
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = [
    "Box",
    "CameraInfo",
    "Capsule",
    "Chain",
    "Collision",
    "CollisionPair",
    "Color",
    "ContactInfo",
    "Cylinder",
    "EndEffector",
    "ForceTorqueInfo",
    "GPSInfo",
    "GazeboElement",
    "GazeboPlugin",
    "Geometry",
    "GeometryType",
    "GroupState",
    "IMUInfo",
    "Index",
    "InertiaTensor",
    "Inertial",
    "Interface",
    "Joint",
    "JointCalibration",
    "JointDynamics",
    "JointLimits",
    "JointMimic",
    "JointProperty",
    "JointSafetyController",
    "JointType",
    "KinematicGraph",
    "LidarInfo",
    "Link",
    "LinkPhysics",
    "LinkSphereApproximation",
    "Material",
    "Mesh",
    "PassiveJoint",
    "PlanningGroup",
    "Robot",
    "Ros2Control",
    "Ros2ControlGpio",
    "Ros2ControlJoint",
    "Ros2ControlSensor",
    "SemanticRobotDescription",
    "Sensor",
    "SensorNoise",
    "SensorType",
    "Sphere",
    "SrdfSphere",
    "Transform",
    "Transmission",
    "TransmissionActuator",
    "TransmissionJoint",
    "TransmissionType",
    "Vector3",
    "VirtualJoint",
    "Visual",
]


def __getattr__(name: str) -> object:
    if name in _HOME_OF:
        return getattr(import_module(f"{__name__}.{_HOME_OF[name]}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)
