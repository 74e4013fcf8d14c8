"""Sensors: what measures on a link, how well, and under which topic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

from linkforge_compile.core import constants as default
from linkforge_compile.core.constants import EPSILON
from linkforge_compile.core.exceptions import RobotValidationError, ValidationErrorCode
from linkforge_compile.core.models.gazebo import GazeboPlugin
from linkforge_compile.core.models.geometry import IDENTITY, Transform
from linkforge_compile.core.naming import prefixed_topic
from linkforge_compile.core.part import Element, freeze
from linkforge_compile.core.rules import require_finite, require_name, require_positive


class SensorType(StrEnum):
    """What a sensor measures. `ray` is what Gazebo Classic calls a lidar; `gps` is Gazebo's navsat."""

    CAMERA = "camera"
    DEPTH_CAMERA = "depth_camera"
    LIDAR = "lidar"
    RAY = "ray"
    GPU_LIDAR = "gpu_lidar"
    IMU = "imu"
    GPS = "gps"
    FORCE_TORQUE = "force_torque"
    CONTACT = "contact"
    RGBD_CAMERA = "rgbd_camera"


REQUIRED_INFO = {
    SensorType.CAMERA: "camera_info",
    SensorType.DEPTH_CAMERA: "camera_info",
    SensorType.RGBD_CAMERA: "camera_info",
    SensorType.LIDAR: "lidar_info",
    SensorType.IMU: "imu_info",
    SensorType.GPS: "gps_info",
    SensorType.CONTACT: "contact_info",
    SensorType.FORCE_TORQUE: "force_torque_info",
}
"""The field that a sensor of each type must have; a `ray` or `gpu_lidar` may do without its `lidar_info`."""

_FORCE_TORQUE_FRAMES = (default.FT_FRAME_CHILD, default.FT_FRAME_PARENT, default.FT_FRAME_SENSOR)
_FORCE_TORQUE_DIRECTIONS = (default.FT_DIR_CHILD_TO_PARENT, default.FT_DIR_PARENT_TO_CHILD)


@dataclass(frozen=True, slots=True)
class SensorNoise(Element):
    """Noise on a measured value, in that value's unit: `<noise>`.

    `type` is `gaussian`, `gaussian_quantized` or what else the simulator knows. A bias is drawn once from
    `bias_mean` and `bias_stddev`, the rest for every reading. `stated` names those two where they are 0 and written
    all the same.

    Raises:
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    type: str = default.NOISE_GAUSSIAN
    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    stated: Sequence[str] = field(default=(), kw_only=True, repr=False)

    def __post_init__(self) -> None:
        freeze(self, "stated")
        require_finite(self, "mean", "stddev", "bias_mean", "bias_stddev")

    def is_written(self, name: str) -> bool:
        """Whether a bias becomes a tag: it is not 0, or is stated all the same."""
        return name in self.stated or getattr(self, name) != 0


@dataclass(frozen=True, slots=True)
class CameraInfo(Element):
    """A pinhole camera: `<camera>`.

    `horizontal_fov` [rad], at most π; `width` and `height` [px]; `format` of a pixel; nothing nearer than
    `near_clip` or farther than `far_clip` [m] is seen; `noise` on each channel, None for none.

    Raises:
        RobotValidationError: OUT_OF_RANGE for a field of view outside of (0, π], a size or near_clip that is not
            above 0, and a far_clip that is not beyond near_clip.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    horizontal_fov: float = default.DEFAULT_CAMERA_FOV
    width: int = default.DEFAULT_CAMERA_WIDTH
    height: int = default.DEFAULT_CAMERA_HEIGHT
    format: str = default.DEFAULT_CAMERA_FORMAT
    near_clip: float = default.DEFAULT_CAMERA_NEAR
    far_clip: float = default.DEFAULT_CAMERA_FAR
    noise: SensorNoise | None = None

    def __post_init__(self) -> None:
        freeze(self)
        if self.horizontal_fov <= 0 or self.horizontal_fov > math.pi + EPSILON:
            raise _out_of_range(
                f"horizontal_fov must be above 0 and at most pi [rad], found {self.horizontal_fov}",
                "CameraFOV",
                self.horizontal_fov,
                "horizontal_fov",
            )
        for side in ("width", "height"):
            if getattr(self, side) <= 0:
                raise _out_of_range(
                    f"image dimensions must be positive [px], found {self.width} x {self.height}",
                    "ImageDimensions",
                    (self.width, self.height),
                    side,
                )
        require_positive(self.near_clip, "near_clip", "NearClip", "near_clip")
        if self.far_clip <= self.near_clip:
            raise _out_of_range(
                f"far_clip must be greater than near_clip {self.near_clip} [m], found {self.far_clip}",
                "FarClip",
                self.far_clip,
                "far_clip",
            )
        require_finite(self, "horizontal_fov", "width", "height", "near_clip", "far_clip")


@dataclass(frozen=True, slots=True)
class LidarInfo(Element):
    """A laser scanner: `<lidar>`, in Gazebo Classic `<ray>`.

    It sends `horizontal_samples` rays between two angles [rad] about the z axis, in `vertical_samples` layers
    between two angles up from the x-y plane; a resolution is readings per ray. Distances are read from
    `range_min` to `range_max` in steps of `range_resolution` [m]; `noise` is on them, None for none.

    Raises:
        RobotValidationError: OUT_OF_RANGE unless samples, range_min and range_resolution are above 0, range_max
            above range_min, and each smallest angle below its largest (vertically only for more than one layer).
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    horizontal_samples: int = default.DEFAULT_LIDAR_SAMPLES
    horizontal_resolution: float = default.DEFAULT_LIDAR_RESOLUTION
    horizontal_min_angle: float = default.DEFAULT_LIDAR_MIN_ANGLE
    horizontal_max_angle: float = default.DEFAULT_LIDAR_MAX_ANGLE
    vertical_samples: int = default.DEFAULT_LIDAR_VERTICAL_SAMPLES
    vertical_resolution: float = default.DEFAULT_LIDAR_VERTICAL_RESOLUTION
    vertical_min_angle: float = default.DEFAULT_LIDAR_VERTICAL_MIN_ANGLE
    vertical_max_angle: float = default.DEFAULT_LIDAR_VERTICAL_MAX_ANGLE
    range_min: float = default.DEFAULT_LIDAR_RANGE_MIN
    range_max: float = default.DEFAULT_LIDAR_RANGE_MAX
    range_resolution: float = default.DEFAULT_LIDAR_RANGE_RESOLUTION
    noise: SensorNoise | None = None

    def __post_init__(self) -> None:
        freeze(self)
        require_positive(self.horizontal_samples, "horizontal_samples", "LidarSamples", "horizontal_samples")
        require_positive(self.range_min, "range_min", "LidarRangeMin", "range_min")
        if self.range_max <= self.range_min:
            raise _out_of_range(
                f"range_max must be greater than range_min {self.range_min} [m], found {self.range_max}",
                "LidarRangeMax",
                self.range_max,
                "range_max",
            )
        require_positive(self.range_resolution, "range_resolution", "LidarRangeResolution", "range_resolution")
        self._check_angles("horizontal", "LidarAngleRange")
        if self.vertical_samples > 1:
            self._check_angles("vertical", "LidarVerticalAngleRange")
        numbers = (name for name in LidarInfo.__match_args__ if name != "noise")
        require_finite(self, *numbers)

    def _check_angles(self, direction: str, target: str) -> None:
        smallest: float = getattr(self, f"{direction}_min_angle")
        largest: float = getattr(self, f"{direction}_max_angle")
        if smallest >= largest:
            raise _out_of_range(
                f"{direction}_min_angle must be less than {direction}_max_angle, found {smallest} and {largest}",
                target,
                (smallest, largest),
                f"{direction}_min_angle",
            )


@dataclass(frozen=True, slots=True)
class IMUInfo(Element):
    """An inertial unit: `<imu>`; noise on each axis of [rad/s] and [m/s²], None for none."""

    angular_velocity_noise: SensorNoise | None = None
    linear_acceleration_noise: SensorNoise | None = None


@dataclass(frozen=True, slots=True)
class GPSInfo(Element):
    """A satellite receiver: `<navsat>`, in Gazebo Classic `<gps>`; noise on [m] and [m/s], None for none."""

    position_sensing_horizontal_noise: SensorNoise | None = None
    position_sensing_vertical_noise: SensorNoise | None = None
    velocity_sensing_horizontal_noise: SensorNoise | None = None
    velocity_sensing_vertical_noise: SensorNoise | None = None


@dataclass(frozen=True, slots=True)
class ContactInfo(Element):
    """A touch sensor: `<contact>`; `collision` names the collision that feels, `noise` is None for none."""

    PREFIXED = ("collision",)

    collision: str
    noise: SensorNoise | None = None


@dataclass(frozen=True, slots=True)
class ForceTorqueInfo(Element):
    """A force and torque sensor in a joint: `<force_torque>`.

    `frame` says in whose axes it measures (`child`, `parent`, `sensor`), `measure_direction` who acts on whom
    (`child_to_parent`, `parent_to_child`); `noise` on [N] and [N·m], None for none.

    Raises:
        RobotValidationError: INVALID_VALUE for another frame or direction.

    """

    frame: str = default.FT_FRAME_CHILD
    measure_direction: str = default.FT_DIR_CHILD_TO_PARENT
    noise: SensorNoise | None = None

    def __post_init__(self) -> None:
        freeze(self)
        self._check_word("frame", _FORCE_TORQUE_FRAMES, "ForceTorqueFrame")
        self._check_word("measure_direction", _FORCE_TORQUE_DIRECTIONS, "ForceTorqueDirection")

    def _check_word(self, name: str, words: tuple[str, ...], target: str) -> None:
        found: str = getattr(self, name)
        if found not in words:
            raise RobotValidationError(
                ValidationErrorCode.INVALID_VALUE,
                f"{name} must be one of {', '.join(words)}, found '{found}'",
                target=target,
                value=found,
                field=(name,),
            )


@dataclass(frozen=True, slots=True)
class Sensor(Element):
    """A sensor on a link: `<sensor name type>` in a `<gazebo reference>` of that link.

    `update_rate` [Hz]. `origin` is its pose in the frame of the link `link_name`. Of the infos, the one that
    belongs to the type is set (a ray or gpu_lidar may do without); the others are None. `topic` is where it
    publishes, `frame` the frame in its messages (an optical frame, say); None for what the simulator chooses.
    `plugin` is None for none.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name or link, OUT_OF_RANGE for an update rate that is not
            above 0, INVALID_VALUE where the info of its type is missing.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    PREFIXED = ("name", "link_name", "contact_info", "plugin", "frame")

    name: str
    type: SensorType
    link_name: str
    update_rate: float = default.DEFAULT_UPDATE_RATE
    always_on: bool = True
    visualize: bool = False
    camera_info: CameraInfo | None = None
    lidar_info: LidarInfo | None = None
    imu_info: IMUInfo | None = None
    gps_info: GPSInfo | None = None
    contact_info: ContactInfo | None = None
    force_torque_info: ForceTorqueInfo | None = None
    origin: Transform = IDENTITY
    topic: str | None = None
    plugin: GazeboPlugin | None = None
    frame: str | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        freeze(self)
        require_name(self.name, "sensor name", "SensorName")
        require_name(self.link_name, "link of a sensor", "LinkName", ("link",))
        require_positive(self.update_rate, "update_rate", "UpdateRate", "update_rate")
        info = REQUIRED_INFO.get(self.type)
        if info and getattr(self, info) is None:
            raise RobotValidationError(
                ValidationErrorCode.INVALID_VALUE,
                f"sensor '{self.name}' of type {self.type} requires {info}",
                target="SensorInfo",
                value=self.name,
                field=(info.removesuffix("_info"),),
            )
        require_finite(self, "update_rate")

    def with_prefix(self, prefix: str) -> Sensor:
        """Return the sensor with its names and its relative topic prefixed; an absolute topic is kept."""
        sensor = Element.with_prefix(self, prefix)
        return replace(sensor, topic=prefixed_topic(prefix, self.topic)) if self.topic else sensor


def _out_of_range(message: str, target: str, value: object, at: str) -> RobotValidationError:
    return RobotValidationError(ValidationErrorCode.OUT_OF_RANGE, message, target=target, value=value, field=(at,))
