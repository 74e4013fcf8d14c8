"""The model alone: robots as values that can be built, merged, checked and written without YAML.

Names, fields and behaviour are those of `linkforge.core`. Each name is imported when it is first used, because the
classes take 0.1 s to define and a robot needs few of them.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkforge_compile.core import builders as builders
    from linkforge_compile.core import constants as constants
    from linkforge_compile.core import exceptions as exceptions
    from linkforge_compile.core import models as models
    from linkforge_compile.core import naming as naming
    from linkforge_compile.core import physics as physics
    from linkforge_compile.core import resolver as resolver
    from linkforge_compile.core.builders import IComposer as IComposer
    from linkforge_compile.core.builders import LinkBuilder as LinkBuilder
    from linkforge_compile.core.builders import RobotBuilder as RobotBuilder
    from linkforge_compile.core.builders import SemanticBuilder as SemanticBuilder
    from linkforge_compile.core.builders import box as box
    from linkforge_compile.core.builders import capsule as capsule
    from linkforge_compile.core.builders import cylinder as cylinder
    from linkforge_compile.core.builders import mesh as mesh
    from linkforge_compile.core.builders import sphere as sphere
    from linkforge_compile.core.constants import DEFAULT_LINK_MASS as DEFAULT_LINK_MASS
    from linkforge_compile.core.constants import EPSILON as EPSILON
    from linkforge_compile.core.constants import GRAVITY_ENABLED as GRAVITY_ENABLED
    from linkforge_compile.core.constants import PI as PI
    from linkforge_compile.core.exceptions import LinkForgeError as LinkForgeError
    from linkforge_compile.core.exceptions import RobotGeneratorError as RobotGeneratorError
    from linkforge_compile.core.exceptions import (
        RobotGeneratorUnsupportedTypeError as RobotGeneratorUnsupportedTypeError,
    )
    from linkforge_compile.core.exceptions import RobotMathError as RobotMathError
    from linkforge_compile.core.exceptions import RobotModelError as RobotModelError
    from linkforge_compile.core.exceptions import RobotParserError as RobotParserError
    from linkforge_compile.core.exceptions import RobotParserIOError as RobotParserIOError
    from linkforge_compile.core.exceptions import RobotParserUnexpectedError as RobotParserUnexpectedError
    from linkforge_compile.core.exceptions import RobotParserXMLRootError as RobotParserXMLRootError
    from linkforge_compile.core.exceptions import RobotPhysicsError as RobotPhysicsError
    from linkforge_compile.core.exceptions import RobotSecurityError as RobotSecurityError
    from linkforge_compile.core.exceptions import RobotValidationError as RobotValidationError
    from linkforge_compile.core.exceptions import RobotXacroError as RobotXacroError
    from linkforge_compile.core.exceptions import RobotXacroExpressionError as RobotXacroExpressionError
    from linkforge_compile.core.exceptions import RobotXacroRecursionError as RobotXacroRecursionError
    from linkforge_compile.core.exceptions import ValidationErrorCode as ValidationErrorCode
    from linkforge_compile.core.exceptions import XacroDetectedError as XacroDetectedError
    from linkforge_compile.core.models import *  # noqa: F403 each is re-exported there
    from linkforge_compile.core.naming import is_valid_name as is_valid_name
    from linkforge_compile.core.physics import calculate_inertia as calculate_inertia
    from linkforge_compile.core.resolver import FileSystemResolver as FileSystemResolver
    from linkforge_compile.core.resolver import IResourceResolver as IResourceResolver

_HOMES = {
    "": "builders constants exceptions models naming physics resolver",
    "builders": "IComposer LinkBuilder RobotBuilder SemanticBuilder box capsule cylinder mesh sphere",
    "constants": "DEFAULT_LINK_MASS EPSILON GRAVITY_ENABLED PI",
    "exceptions": "LinkForgeError RobotGeneratorError RobotGeneratorUnsupportedTypeError RobotMathError "
    "RobotModelError RobotParserError RobotParserIOError RobotParserUnexpectedError "
    "RobotParserXMLRootError RobotPhysicsError RobotSecurityError RobotValidationError RobotXacroError "
    "RobotXacroExpressionError RobotXacroRecursionError ValidationErrorCode XacroDetectedError",
    "models.gazebo": "GazeboElement GazeboPlugin",
    "models.geometry": "Box Capsule Cylinder Geometry GeometryType Mesh Sphere Transform Vector3",
    "models.graph": "KinematicGraph",
    "models.interface": "Interface",
    "models.joint": "Joint JointCalibration JointDynamics JointLimits JointMimic JointSafetyController JointType",
    "models.link": "Collision InertiaTensor Inertial Link LinkPhysics Visual",
    "models.material": "Color Material",
    "models.named_table": "Index",
    "models.robot": "Robot",
    "models.ros2_control": "Ros2Control Ros2ControlGpio Ros2ControlJoint Ros2ControlSensor",
    "models.sensor": "CameraInfo ContactInfo ForceTorqueInfo GPSInfo IMUInfo LidarInfo Sensor SensorNoise SensorType",
    "models.srdf": "Chain CollisionPair EndEffector GroupState JointProperty LinkSphereApproximation PassiveJoint "
    "PlanningGroup SemanticRobotDescription SrdfSphere VirtualJoint",
    "models.transmission": "Transmission TransmissionActuator TransmissionJoint TransmissionType",
    "naming": "is_valid_name",
    "physics": "calculate_inertia",
    "resolver": "FileSystemResolver IResourceResolver",
}
HOME_OF = {name: home for home, names in _HOMES.items() for name in names.split()}
"""The submodule that defines each exported name; empty for a submodule itself."""

if not TYPE_CHECKING:
    __all__ = list(HOME_OF)

    def __getattr__(name: str) -> object:
        if name not in HOME_OF:
            raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
        home = HOME_OF[name]
        return getattr(import_module(f"{__name__}.{home}"), name) if home else import_module(f"{__name__}.{name}")

    def __dir__() -> list[str]:
        return sorted(__all__)
