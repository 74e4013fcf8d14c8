"""Sensors on links: what they measure, how well, and under which topic."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Annotated

from linkforge_compile.core import constants as default
from linkforge_compile.core.exceptions import RobotValidationError
from linkforge_compile.core.fields import (
    ABOVE_ZERO,
    UP_TO_HALF_A_TURN,
    Child,
    Choice,
    Flag,
    Name,
    Noise,
    Number,
    Pose,
    Reference,
    Text,
    check_numbers,
    require_choice,
)
from linkforge_compile.core.models.gazebo import GazeboPlugin
from linkforge_compile.core.models.geometry import IDENTITY, Transform
from linkforge_compile.core.naming import require_name
from linkforge_compile.core.part import Element, Stating, dump_like, extras_last
from linkforge_compile.units import ANGLE, FREQUENCY, LENGTH, LOAD, PIXELS, TURN_RATE, VELOCITY


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


dump_like(SensorType, str)

INFO_FIELDS = {
    SensorType.CAMERA: "camera_info",
    SensorType.DEPTH_CAMERA: "camera_info",
    SensorType.RGBD_CAMERA: "camera_info",
    SensorType.LIDAR: "lidar_info",
    SensorType.RAY: "lidar_info",
    SensorType.GPU_LIDAR: "lidar_info",
    SensorType.IMU: "imu_info",
    SensorType.GPS: "gps_info",
    SensorType.CONTACT: "contact_info",
    SensorType.FORCE_TORQUE: "force_torque_info",
}
"""The field that says what a sensor of each type measures."""

MAY_LACK_INFO = (SensorType.RAY, SensorType.GPU_LIDAR)
"""Sensors of these types may do without their `lidar_info`, as in linkforge.core."""


class ForceTorqueFrame(StrEnum):
    """In whose axes forces and torques are measured."""

    CHILD = default.FT_FRAME_CHILD
    PARENT = default.FT_FRAME_PARENT
    SENSOR = default.FT_FRAME_SENSOR


class ForceTorqueDirection(StrEnum):
    """Whether forces are those of the child on the parent, or of the parent on the child."""

    CHILD_TO_PARENT = default.FT_DIR_CHILD_TO_PARENT
    PARENT_TO_CHILD = default.FT_DIR_PARENT_TO_CHILD


@extras_last
@dataclass(frozen=True)
class SensorNoise(Element, Stating):
    """Noise on a measured value, in that value's unit: `<noise>`.

    `type` is `gaussian`, `gaussian_quantized` or what else the simulator knows. A bias is drawn once from
    `bias_mean` and `bias_stddev`, the rest for every reading. `stated` names those two where they are 0 and
    written nevertheless.

    Raises:
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG = "noise"

    type: Annotated[str, Text()] = default.NOISE_GAUSSIAN
    mean: Annotated[float, Number(xml="mean/text()")] = 0.0
    stddev: Annotated[float, Number(xml="stddev/text()")] = 0.0
    bias_mean: Annotated[float, Number(xml="bias_mean/text()")] = 0.0
    bias_stddev: Annotated[float, Number(xml="bias_stddev/text()")] = 0.0
    stated: Sequence[str] = field(default=(), kw_only=True, repr=False)


@extras_last
@dataclass(frozen=True)
class CameraInfo(Element):
    """A pinhole camera: `<camera>`.

    `horizontal_fov` [rad], at most π; `width` and `height` [px]; `format` of a pixel; nothing nearer than
    `near_clip` or farther than `far_clip` [m] is seen; `noise` on each channel, None for none.

    Raises:
        RobotValidationError: OUT_OF_RANGE for a field of view outside of (0, π], a size or near_clip that is not
            above 0, and a far_clip that is not beyond near_clip.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG = "camera"

    horizontal_fov: Annotated[float, Number(ANGLE, UP_TO_HALF_A_TURN, xml="horizontal_fov/text()")] = (
        default.DEFAULT_CAMERA_FOV
    )
    width: Annotated[int, Number(PIXELS, ABOVE_ZERO, is_whole=True, xml="image/width/text()")] = (
        default.DEFAULT_CAMERA_WIDTH
    )
    height: Annotated[int, Number(PIXELS, ABOVE_ZERO, is_whole=True, xml="image/height/text()")] = (
        default.DEFAULT_CAMERA_HEIGHT
    )
    format: Annotated[str, Text(xml="image/format/text()")] = default.DEFAULT_CAMERA_FORMAT
    near_clip: Annotated[float, Number(LENGTH, ABOVE_ZERO, xml="clip/near/text()")] = default.DEFAULT_CAMERA_NEAR
    far_clip: Annotated[float, Number(LENGTH, may_be_far=True, xml="clip/far/text()")] = default.DEFAULT_CAMERA_FAR
    noise: Annotated[SensorNoise | None, Noise()] = None

    def _check(self) -> None:
        check_numbers(self)
        if self.far_clip <= self.near_clip:
            raise RobotValidationError.out_of_range(
                f"far_clip must be greater than near_clip {self.near_clip} [m], found {self.far_clip}",
                "FarClip",
                self.far_clip,
                "far_clip",
            )


@extras_last
@dataclass(frozen=True)
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

    TAG = "lidar"

    horizontal_samples: Annotated[
        int, Number(bound=ABOVE_ZERO, is_whole=True, xml="scan/horizontal/samples/text()")
    ] = default.DEFAULT_LIDAR_SAMPLES
    horizontal_resolution: Annotated[float, Number(xml="scan/horizontal/resolution/text()")] = (
        default.DEFAULT_LIDAR_RESOLUTION
    )
    horizontal_min_angle: Annotated[float, Number(ANGLE, xml="scan/horizontal/min_angle/text()")] = (
        default.DEFAULT_LIDAR_MIN_ANGLE
    )
    horizontal_max_angle: Annotated[float, Number(ANGLE, xml="scan/horizontal/max_angle/text()")] = (
        default.DEFAULT_LIDAR_MAX_ANGLE
    )
    vertical_samples: Annotated[int, Number(is_whole=True, xml="scan/vertical/samples/text()")] = (
        default.DEFAULT_LIDAR_VERTICAL_SAMPLES
    )
    vertical_resolution: Annotated[float, Number(xml="scan/vertical/resolution/text()")] = (
        default.DEFAULT_LIDAR_VERTICAL_RESOLUTION
    )
    vertical_min_angle: Annotated[float, Number(ANGLE, xml="scan/vertical/min_angle/text()")] = (
        default.DEFAULT_LIDAR_VERTICAL_MIN_ANGLE
    )
    vertical_max_angle: Annotated[float, Number(ANGLE, xml="scan/vertical/max_angle/text()")] = (
        default.DEFAULT_LIDAR_VERTICAL_MAX_ANGLE
    )
    range_min: Annotated[float, Number(LENGTH, ABOVE_ZERO, xml="range/min/text()")] = default.DEFAULT_LIDAR_RANGE_MIN
    range_max: Annotated[float, Number(LENGTH, may_be_far=True, xml="range/max/text()")] = (
        default.DEFAULT_LIDAR_RANGE_MAX
    )
    range_resolution: Annotated[float, Number(LENGTH, ABOVE_ZERO, xml="range/resolution/text()")] = (
        default.DEFAULT_LIDAR_RANGE_RESOLUTION
    )
    noise: Annotated[SensorNoise | None, Noise(LENGTH)] = None

    def _check(self) -> None:
        check_numbers(self)
        if self.range_max <= self.range_min:
            raise RobotValidationError.out_of_range(
                f"range_max must be greater than range_min {self.range_min} [m], found {self.range_max}",
                "LidarRangeMax",
                self.range_max,
                "range_max",
            )
        self._check_angles("horizontal", "LidarAngleRange")
        if self.vertical_samples > 1:
            self._check_angles("vertical", "LidarVerticalAngleRange")

    def _check_angles(self, direction: str, target: str) -> None:
        smallest: float = getattr(self, f"{direction}_min_angle")
        largest: float = getattr(self, f"{direction}_max_angle")
        if smallest >= largest:
            raise RobotValidationError.out_of_range(
                f"{direction}_min_angle must be less than {direction}_max_angle, found {smallest} and {largest}",
                target,
                (smallest, largest),
                f"{direction}_min_angle",
            )


@extras_last
@dataclass(frozen=True)
class IMUInfo(Element):
    """An inertial unit: `<imu>`; noise on each axis of [rad/s] and [m/s²], None for none."""

    TAG = "imu"

    angular_velocity_noise: Annotated[SensorNoise | None, Noise(TURN_RATE, xml="angular_velocity/*/noise")] = None
    linear_acceleration_noise: Annotated[SensorNoise | None, Noise(xml="linear_acceleration/*/noise")] = None


@extras_last
@dataclass(frozen=True)
class GPSInfo(Element):
    """A satellite receiver: `<navsat>`, in Gazebo Classic `<gps>`; noise on [m] and [m/s], None for none."""

    TAG = "navsat"

    position_sensing_horizontal_noise: Annotated[
        SensorNoise | None, Noise(LENGTH, xml="position_sensing/horizontal/noise")
    ] = None
    position_sensing_vertical_noise: Annotated[
        SensorNoise | None, Noise(LENGTH, xml="position_sensing/vertical/noise")
    ] = None
    velocity_sensing_horizontal_noise: Annotated[
        SensorNoise | None, Noise(VELOCITY, xml="velocity_sensing/horizontal/noise")
    ] = None
    velocity_sensing_vertical_noise: Annotated[
        SensorNoise | None, Noise(VELOCITY, xml="velocity_sensing/vertical/noise")
    ] = None


@extras_last
@dataclass(frozen=True)
class ContactInfo(Element):
    """A touch sensor: `<contact>`; `collision` names the collision that feels, `noise` is None for none."""

    TAG = "contact"

    collision: Annotated[str, Reference("collision", xml="collision/text()", example="fingertip_collision")]
    noise: Annotated[SensorNoise | None, Noise()] = None


@extras_last
@dataclass(frozen=True)
class ForceTorqueInfo(Element):
    """A force and torque sensor in a joint: `<force_torque>`.

    `frame` is the frame of its axes (`child`, `parent`, `sensor`), `measure_direction` the direction of the forces
    (`child_to_parent`, `parent_to_child`); `noise` on [N] and [N·m], None for none.

    Raises:
        RobotValidationError: INVALID_VALUE for another frame or direction.

    """

    TAG = "force_torque"

    frame: Annotated[str, Choice(ForceTorqueFrame, xml="frame/text()")] = default.FT_FRAME_CHILD
    measure_direction: Annotated[str, Choice(ForceTorqueDirection, xml="measure_direction/text()")] = (
        default.FT_DIR_CHILD_TO_PARENT
    )
    noise: Annotated[SensorNoise | None, Noise(LOAD, xml="*/*/noise")] = None

    def _check(self) -> None:
        require_choice(self.frame, ForceTorqueFrame, "frame", "ForceTorqueFrame", "frame")
        direction = self.measure_direction
        require_choice(
            direction, ForceTorqueDirection, "measure_direction", "ForceTorqueDirection", "measure_direction"
        )


@extras_last
@dataclass(frozen=True)
class Sensor(Element):
    """A sensor on a link: `<sensor name type>` in a `<gazebo reference>` of that link.

    `update_rate` [Hz]. `origin` is its pose in the frame of the link `link_name`. Of the infos, the one that
    belongs to the type is set (a ray or gpu_lidar may do without); the others are None. `topic` is where it
    publishes, `frame` the frame in its messages (such as an optical frame); None to let the simulator choose.
    `plugin` is None for none.

    Raises:
        RobotValidationError: NAME_EMPTY for an empty name or link, OUT_OF_RANGE for an update rate that is not
            above 0, INVALID_VALUE where the info of its type is missing.
        RobotMathError: INVALID_VALUE for NaN or infinity.

    """

    TAG = "sensor"

    name: Annotated[str, Name()]
    type: Annotated[SensorType, Choice(SensorType, example="camera")]
    link_name: Annotated[str, Reference("link", key="link", xml="../@reference", example="head")]
    update_rate: Annotated[float, Number(FREQUENCY, ABOVE_ZERO, xml="update_rate/text()")] = default.DEFAULT_UPDATE_RATE
    always_on: Annotated[bool, Flag(xml="always_on/text()")] = True
    visualize: Annotated[bool, Flag(xml="visualize/text()")] = False
    camera_info: Annotated[CameraInfo | None, Child(key="camera")] = None
    lidar_info: Annotated[LidarInfo | None, Child(key="lidar")] = None
    imu_info: Annotated[IMUInfo | None, Child(key="imu")] = None
    gps_info: Annotated[GPSInfo | None, Child(key="gps")] = None
    contact_info: Annotated[ContactInfo | None, Child(key="contact")] = None
    force_torque_info: Annotated[ForceTorqueInfo | None, Child(key="force_torque")] = None
    origin: Annotated[Transform, Pose(xml="pose")] = IDENTITY
    topic: Annotated[str | None, Reference("topic", xml="topic/text()")] = None
    plugin: Annotated[GazeboPlugin | None, Child()] = None
    frame: Annotated[str | None, Reference("frame", xml="gz_frame_id/text()")] = field(default=None, kw_only=True)

    def _check(self) -> None:
        require_name(self.name, "sensor name", "SensorName")
        require_name(self.link_name, "link of a sensor", "LinkName", ("link",))
        check_numbers(self)
        info = INFO_FIELDS[self.type]
        if getattr(self, info) is None and self.type not in MAY_LACK_INFO:
            raise RobotValidationError.invalid(
                f"sensor '{self.name}' of type {self.type} requires {info}",
                "SensorInfo",
                self.name,
                info.removesuffix("_info"),
            )
