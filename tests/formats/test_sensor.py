import pytest

from linkforge_compile import compile_text, render_urdf
from linkforge_compile.core import Robot
from linkforge_compile.core.models.gazebo import GazeboElement, GazeboPlugin
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
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
from tests.formats.inside import urdf, xml

NOISE = SensorNoise(mean=0.0, stddev=0.01, bias_mean=0.001)


def inside_sensor(sensor: Sensor, gazebo: str = "gz", **parts) -> str:
    """Return the lines between those that every sensor has and the end."""
    lines = urdf(sensors=[sensor], gazebo=gazebo, **parts).splitlines(keepends=True)
    start = next(number for number, line in enumerate(lines) if "<visualize>" in line) + 1
    return xml("".join(lines[start:-2]))


def test_a_camera_with_everything_for_gazebo_sim():
    camera = Sensor(
        "front",
        SensorType.CAMERA,
        "head",
        15.5,
        always_on=False,
        visualize=True,
        camera_info=CameraInfo(1.2, 320, 240, "L8", 0.05, 8, NOISE),
        origin=Transform(Vector3(0.1, 0, 0), Vector3(0, 0, 1.5)),
        topic="front/image",
        frame="front_optical",
        plugin=GazeboPlugin("p", "libp.so", {"a": "1"}),
        extra_elements=["<enable_metrics>true</enable_metrics>"],
    )
    assert urdf(sensors=[camera]) == xml("""
        <gazebo reference="head">
          <sensor name="front" type="camera">
            <always_on>false</always_on>
            <update_rate>15.5</update_rate>
            <visualize>true</visualize>
            <pose>0.1 0 0 0 0 1.5</pose>
            <topic>front/image</topic>
            <gz_frame_id>front_optical</gz_frame_id>
            <camera>
              <horizontal_fov>1.2</horizontal_fov>
              <image>
                <width>320</width>
                <height>240</height>
                <format>L8</format>
              </image>
              <clip>
                <near>0.05</near>
                <far>8</far>
              </clip>
              <noise>
                <type>gaussian</type>
                <mean>0</mean>
                <stddev>0.01</stddev>
                <bias_mean>0.001</bias_mean>
              </noise>
            </camera>
            <plugin name="p" filename="libp.so">
              <a>1</a>
            </plugin>
            <enable_metrics>true</enable_metrics>
          </sensor>
        </gazebo>
    """)


def test_a_lidar():
    assert inside_sensor(Sensor("scan", SensorType.GPU_LIDAR, "base", lidar_info=LidarInfo(noise=NOISE))) == xml("""
        <lidar>
          <scan>
            <horizontal>
              <samples>640</samples>
              <resolution>1</resolution>
              <min_angle>-1.5707963267948966</min_angle>
              <max_angle>1.5707963267948966</max_angle>
            </horizontal>
            <vertical>
              <samples>1</samples>
              <resolution>1</resolution>
              <min_angle>0</min_angle>
              <max_angle>0</max_angle>
            </vertical>
          </scan>
          <range>
            <min>0.1</min>
            <max>10</max>
            <resolution>0.01</resolution>
          </range>
          <noise>
            <type>gaussian</type>
            <mean>0</mean>
            <stddev>0.01</stddev>
            <bias_mean>0.001</bias_mean>
          </noise>
        </lidar>
    """)


def test_an_imu_has_its_noise_on_every_axis():
    imu = inside_sensor(Sensor("imu", SensorType.IMU, "base", imu_info=IMUInfo(linear_acceleration_noise=NOISE)))
    axis = """
            <{0}>
              <noise type="gaussian">
                <mean>0</mean>
                <stddev>0.01</stddev>
                <bias_mean>0.001</bias_mean>
              </noise>
            </{0}>"""
    axes = "".join(axis.format(name) for name in "xyz")
    assert imu == xml(f"""
        <imu>
          <linear_acceleration>{axes}
          </linear_acceleration>
        </imu>
    """)


def test_a_gps_groups_its_noise_by_what_it_senses():
    info = GPSInfo(SensorNoise(stddev=1), SensorNoise(stddev=2), None, SensorNoise("none"))
    assert inside_sensor(Sensor("gps", SensorType.GPS, "base", gps_info=info)) == xml("""
        <navsat>
          <position_sensing>
            <horizontal>
              <noise type="gaussian">
                <mean>0</mean>
                <stddev>1</stddev>
              </noise>
            </horizontal>
            <vertical>
              <noise type="gaussian">
                <mean>0</mean>
                <stddev>2</stddev>
              </noise>
            </vertical>
          </position_sensing>
          <velocity_sensing>
            <vertical>
              <noise type="none">
                <mean>0</mean>
                <stddev>0</stddev>
              </noise>
            </vertical>
          </velocity_sensing>
        </navsat>
    """)


def test_a_contact_sensor_names_its_collision():
    assert inside_sensor(Sensor("bump", SensorType.CONTACT, "base", contact_info=ContactInfo("hull"))) == xml("""
        <contact>
          <collision>hull</collision>
        </contact>
    """)


def test_forces_are_sensed_in_the_joint_above_the_link():
    sensor = Sensor("ft", SensorType.FORCE_TORQUE, "tool", force_torque_info=ForceTorqueInfo("sensor"))
    written = urdf(
        sensors=[sensor], links=[Link("arm"), Link("tool")], joints=[Joint("wrist", JointType.FIXED, "arm", "tool")]
    )
    assert '<gazebo reference="wrist">' in written
    assert inside_sensor(sensor) == xml("""
        <force_torque>
          <frame>sensor</frame>
          <measure_direction>child_to_parent</measure_direction>
        </force_torque>
    """)


def test_noise_of_a_force_sensor_is_on_forces_and_torques():
    sensor = Sensor("ft", SensorType.FORCE_TORQUE, "tool", force_torque_info=ForceTorqueInfo(noise=NOISE))
    assert inside_sensor(sensor).count("<noise type=") == 6


INFOS = {
    SensorType.CAMERA: {"camera_info": CameraInfo()},
    SensorType.DEPTH_CAMERA: {"camera_info": CameraInfo()},
    SensorType.RGBD_CAMERA: {"camera_info": CameraInfo()},
    SensorType.LIDAR: {"lidar_info": LidarInfo()},
    SensorType.RAY: {},
    SensorType.GPU_LIDAR: {"lidar_info": LidarInfo()},
    SensorType.IMU: {"imu_info": IMUInfo()},
    SensorType.GPS: {"gps_info": GPSInfo()},
    SensorType.FORCE_TORQUE: {"force_torque_info": ForceTorqueInfo()},
    SensorType.CONTACT: {"contact_info": ContactInfo("hull")},
}
DIALECTS = [
    (SensorType.CAMERA, "camera", "<camera>", "camera", "<camera>"),
    (SensorType.DEPTH_CAMERA, "depth_camera", "<camera>", "depth", "<camera>"),
    (SensorType.RGBD_CAMERA, "rgbd_camera", "<camera>", "depth", "<camera>"),
    (SensorType.LIDAR, "gpu_lidar", "<lidar>", "ray", "<ray>"),
    (SensorType.RAY, "gpu_lidar", "", "ray", ""),
    (SensorType.GPU_LIDAR, "gpu_lidar", "<lidar>", "gpu_ray", "<ray>"),
    (SensorType.IMU, "imu", "<imu/>", "imu", "<imu/>"),
    (SensorType.GPS, "navsat", "<navsat/>", "gps", "<gps/>"),
    (SensorType.FORCE_TORQUE, "force_torque", "<force_torque>", "force_torque", "<force_torque>"),
    (SensorType.CONTACT, "contact", "<contact>", "contact", "<contact>"),
]


@pytest.mark.parametrize(("kind", "gz", "gz_tag", "classic", "classic_tag"), DIALECTS, ids=[row[0] for row in DIALECTS])
def test_each_gazebo_has_its_own_words(kind: SensorType, gz: str, gz_tag: str, classic: str, classic_tag: str):
    sensor = Sensor("s", kind, "base", **INFOS[kind])
    sim, old = urdf(sensors=[sensor]), urdf(sensors=[sensor], gazebo="classic")
    assert f'type="{gz}"' in sim
    assert gz_tag in sim
    assert f'type="{classic}"' in old
    assert classic_tag in old


def test_sensors_follow_the_written_gazebo_blocks_each_in_its_own():
    written = urdf(
        sensors=[Sensor(name, SensorType.IMU, "base", imu_info=IMUInfo()) for name in ("one", "two")],
        gazebo_elements=[GazeboElement("base", material="Gazebo/Red")],
    )
    assert [line for line in written.splitlines() if "<gazebo" in line or "name=" in line] == [
        '<gazebo reference="base">',
        '<gazebo reference="base">',
        '  <sensor name="one" type="imu">',
        '<gazebo reference="base">',
        '  <sensor name="two" type="imu">',
    ]


def test_an_unknown_simulator_is_refused_with_the_choices():
    with pytest.raises(ValueError, match="gazebo takes 'gz' or 'classic', found 'sim'"):
        render_urdf(Robot("r"), gazebo="sim")
    with pytest.raises(ValueError, match="gazebo takes 'gz' or 'classic', found 'sim'"):
        compile_text("linkforge: 1\nname: r\nlinks: {base: }\n", gazebo="sim")
