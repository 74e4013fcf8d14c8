"""Defaults of the IR with their units, tolerances, and the words of URDF, SRDF and ros2_control."""

from __future__ import annotations

import math
import sys
from typing import Final

PI: Final = math.pi
HALF_PI: Final = math.pi / 2

UNKNOWN: Final = sys.float_info.max
"""Replaces a faulty number after its error is reported, so that its element can be built; never written."""

EPSILON: Final = 1e-9
"""How far a unit vector's length may be from 1, and below which a length, an axis or a reduction counts as zero."""

IR_VERSION: Final = "1.1"

# Links
WORLD: Final = "world"
"""The link that represents the world, to Gazebo as well; it needs no mass."""
DEFAULT_LINK_MASS: Final = 1.0  # [kg]
MIN_REASONABLE_INERTIA: Final = 1e-9  # [kg·m²], the diagonal of a tensor that is not given
LEAST_MASS: Final = 1e-9  # [kg], that of a link without mass, where a simulator needs one: too small to matter
DEFAULT_SELF_COLLIDE: Final = False
GRAVITY_ENABLED: Final = True
DEFAULT_FRICTION_MU: Final = 1.0  # Coulomb, first direction
DEFAULT_FRICTION_MU2: Final = 1.0  # Coulomb, second direction
DEFAULT_CONTACT_KP: Final = 1e12  # [N/m]
DEFAULT_CONTACT_KD: Final = 1.0  # [N·s/m]

# Materials
DEFAULT_MATERIAL_RGBA: Final = (0.7, 0.7, 0.7, 1.0)

# Joints
DEFAULT_JOINT_EFFORT: Final = 10.0  # [N·m], [N] for prismatic
DEFAULT_JOINT_VELOCITY: Final = 1.0  # [rad/s], [m/s] for prismatic
DEFAULT_JOINT_DAMPING: Final = 0.0  # [N·m·s/rad], [N·s/m] for prismatic
DEFAULT_JOINT_FRICTION: Final = 0.0  # [N·m], [N] for prismatic
DEFAULT_URDF_AXIS_XYZ: Final = (1.0, 0.0, 0.0)  # what a URDF joint without <axis> means

# Sensors
DEFAULT_UPDATE_RATE: Final = 30.0  # [Hz]
DEFAULT_UPDATE_RATE_IMU: Final = 100.0  # [Hz]
DEFAULT_UPDATE_RATE_GPS: Final = 5.0  # [Hz]
DEFAULT_UPDATE_RATE_CONTACT: Final = 50.0  # [Hz]
DEFAULT_UPDATE_RATE_FORCE_TORQUE: Final = 100.0  # [Hz]
NOISE_GAUSSIAN: Final = "gaussian"

DEFAULT_CAMERA_FOV: Final = 1.047  # [rad], about 60°
DEFAULT_CAMERA_WIDTH: Final = 640  # [px]
DEFAULT_CAMERA_HEIGHT: Final = 480  # [px]
DEFAULT_CAMERA_FORMAT: Final = "R8G8B8"
DEFAULT_CAMERA_NEAR: Final = 0.1  # [m]
DEFAULT_CAMERA_FAR: Final = 100.0  # [m]

DEFAULT_LIDAR_SAMPLES: Final = 640
DEFAULT_LIDAR_RESOLUTION: Final = 1.0  # range readings per sample
DEFAULT_LIDAR_MIN_ANGLE: Final = -HALF_PI  # [rad]
DEFAULT_LIDAR_MAX_ANGLE: Final = HALF_PI  # [rad]
DEFAULT_LIDAR_VERTICAL_SAMPLES: Final = 1
DEFAULT_LIDAR_VERTICAL_RESOLUTION: Final = 1.0  # range readings per sample
DEFAULT_LIDAR_VERTICAL_MIN_ANGLE: Final = 0.0  # [rad]
DEFAULT_LIDAR_VERTICAL_MAX_ANGLE: Final = 0.0  # [rad]
DEFAULT_LIDAR_RANGE_MIN: Final = 0.1  # [m]
DEFAULT_LIDAR_RANGE_MAX: Final = 10.0  # [m]
DEFAULT_LIDAR_RANGE_RESOLUTION: Final = 0.01  # [m]

FT_FRAME_CHILD: Final = "child"
FT_FRAME_PARENT: Final = "parent"
FT_FRAME_SENSOR: Final = "sensor"
FT_DIR_CHILD_TO_PARENT: Final = "child_to_parent"
FT_DIR_PARENT_TO_CHILD: Final = "parent_to_child"

# ros2_control and transmissions
HW_IF_POSITION: Final = "position"
HW_IF_VELOCITY: Final = "velocity"
HW_IF_EFFORT: Final = "effort"
CONTROL_TYPE_SYSTEM: Final = "system"
CONTROL_TYPE_ACTUATOR: Final = "actuator"
CONTROL_TYPE_SENSOR: Final = "sensor"

# SRDF
SRDF_VJOIN_FIXED: Final = "fixed"
SRDF_VJOIN_PLANAR: Final = "planar"
SRDF_VJOIN_FLOATING: Final = "floating"
SRDF_REASON_ADJACENT: Final = "Adjacent"
