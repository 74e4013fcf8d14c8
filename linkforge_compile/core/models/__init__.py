"""The classes of the model.

Each is imported when it is first used: all of them take 0.1 s to define, and a robot needs few.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkforge_compile.core.models.controller import *  # noqa: F403
    from linkforge_compile.core.models.gazebo import *  # noqa: F403
    from linkforge_compile.core.models.geometry import *  # noqa: F403
    from linkforge_compile.core.models.graph import *  # noqa: F403
    from linkforge_compile.core.models.joint import *  # noqa: F403
    from linkforge_compile.core.models.link import *  # noqa: F403
    from linkforge_compile.core.models.named_table import *  # noqa: F403
    from linkforge_compile.core.models.robot import *  # noqa: F403
    from linkforge_compile.core.models.ros2_control import *  # noqa: F403
    from linkforge_compile.core.models.sensor import *  # noqa: F403
    from linkforge_compile.core.models.srdf import *  # noqa: F403
    from linkforge_compile.core.models.srdf_collisions import *  # noqa: F403
    from linkforge_compile.core.models.transmission import *  # noqa: F403

_NAMES = {
    "controller": "Controller",
    "gazebo": "GazeboElement GazeboPlugin",
    "geometry": "Box Capsule Color Cylinder Geometry GeometryType Material Mesh Sphere Transform Vector3",
    "graph": "KinematicGraph",
    "joint": "Joint JointCalibration JointDynamics JointLimits JointMimic JointSafetyController JointType",
    "link": "Collision InertiaTensor Inertial Link LinkPhysics Visual",
    "named_table": "Index",
    "robot": "Robot",
    "ros2_control": "Interface Ros2Control Ros2ControlGpio Ros2ControlJoint Ros2ControlSensor",
    "sensor": "CameraInfo ContactInfo ForceTorqueInfo GPSInfo IMUInfo LidarInfo Sensor SensorNoise SensorType",
    "srdf": "Chain EndEffector GroupState JointProperty PassiveJoint PlanningGroup "
    "SemanticRobotDescription VirtualJoint",
    "srdf_collisions": "CollisionPair LinkSphereApproximation SrdfSphere",
    "transmission": "Transmission TransmissionActuator TransmissionJoint TransmissionType",
}
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names.split()}

if not TYPE_CHECKING:
    __all__ = list(_MODULE_OF)

    def __getattr__(name: str) -> object:
        if name not in _MODULE_OF:
            raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
        return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)

    def __dir__() -> list[str]:
        return sorted(__all__)
