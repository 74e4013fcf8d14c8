"""The classes of the model, which `linkforge_compile.core` exports as well."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile import core

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement as GazeboElement
    from linkforge_compile.core.models.gazebo import GazeboPlugin as GazeboPlugin
    from linkforge_compile.core.models.geometry import Box as Box
    from linkforge_compile.core.models.geometry import Capsule as Capsule
    from linkforge_compile.core.models.geometry import Cylinder as Cylinder
    from linkforge_compile.core.models.geometry import Geometry as Geometry
    from linkforge_compile.core.models.geometry import GeometryType as GeometryType
    from linkforge_compile.core.models.geometry import Mesh as Mesh
    from linkforge_compile.core.models.geometry import Sphere as Sphere
    from linkforge_compile.core.models.geometry import Transform as Transform
    from linkforge_compile.core.models.geometry import Vector3 as Vector3
    from linkforge_compile.core.models.graph import KinematicGraph as KinematicGraph
    from linkforge_compile.core.models.interface import Interface as Interface
    from linkforge_compile.core.models.joint import Joint as Joint
    from linkforge_compile.core.models.joint import JointCalibration as JointCalibration
    from linkforge_compile.core.models.joint import JointDynamics as JointDynamics
    from linkforge_compile.core.models.joint import JointLimits as JointLimits
    from linkforge_compile.core.models.joint import JointMimic as JointMimic
    from linkforge_compile.core.models.joint import JointSafetyController as JointSafetyController
    from linkforge_compile.core.models.joint import JointType as JointType
    from linkforge_compile.core.models.link import Collision as Collision
    from linkforge_compile.core.models.link import Inertial as Inertial
    from linkforge_compile.core.models.link import InertiaTensor as InertiaTensor
    from linkforge_compile.core.models.link import Link as Link
    from linkforge_compile.core.models.link import LinkPhysics as LinkPhysics
    from linkforge_compile.core.models.link import Visual as Visual
    from linkforge_compile.core.models.material import Color as Color
    from linkforge_compile.core.models.material import Material as Material
    from linkforge_compile.core.models.named_table import Index as Index
    from linkforge_compile.core.models.robot import Robot as Robot
    from linkforge_compile.core.models.ros2_control import Ros2Control as Ros2Control
    from linkforge_compile.core.models.ros2_control import Ros2ControlGpio as Ros2ControlGpio
    from linkforge_compile.core.models.ros2_control import Ros2ControlJoint as Ros2ControlJoint
    from linkforge_compile.core.models.ros2_control import Ros2ControlSensor as Ros2ControlSensor
    from linkforge_compile.core.models.sensor import CameraInfo as CameraInfo
    from linkforge_compile.core.models.sensor import ContactInfo as ContactInfo
    from linkforge_compile.core.models.sensor import ForceTorqueInfo as ForceTorqueInfo
    from linkforge_compile.core.models.sensor import GPSInfo as GPSInfo
    from linkforge_compile.core.models.sensor import IMUInfo as IMUInfo
    from linkforge_compile.core.models.sensor import LidarInfo as LidarInfo
    from linkforge_compile.core.models.sensor import Sensor as Sensor
    from linkforge_compile.core.models.sensor import SensorNoise as SensorNoise
    from linkforge_compile.core.models.sensor import SensorType as SensorType
    from linkforge_compile.core.models.srdf import Chain as Chain
    from linkforge_compile.core.models.srdf import CollisionPair as CollisionPair
    from linkforge_compile.core.models.srdf import EndEffector as EndEffector
    from linkforge_compile.core.models.srdf import GroupState as GroupState
    from linkforge_compile.core.models.srdf import JointProperty as JointProperty
    from linkforge_compile.core.models.srdf import LinkSphereApproximation as LinkSphereApproximation
    from linkforge_compile.core.models.srdf import PassiveJoint as PassiveJoint
    from linkforge_compile.core.models.srdf import PlanningGroup as PlanningGroup
    from linkforge_compile.core.models.srdf import SemanticRobotDescription as SemanticRobotDescription
    from linkforge_compile.core.models.srdf import SrdfSphere as SrdfSphere
    from linkforge_compile.core.models.srdf import VirtualJoint as VirtualJoint
    from linkforge_compile.core.models.transmission import Transmission as Transmission
    from linkforge_compile.core.models.transmission import TransmissionActuator as TransmissionActuator
    from linkforge_compile.core.models.transmission import TransmissionJoint as TransmissionJoint
    from linkforge_compile.core.models.transmission import TransmissionType as TransmissionType
else:
    __all__ = [name for name, home in core.HOME_OF.items() if home.startswith("models.")]

    def __getattr__(name: str) -> object:
        if name in __all__:
            return getattr(core, name)
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")

    def __dir__() -> list[str]:
        return sorted(__all__)
