"""Values of a spec are written even if they are the defaults of the model; for all defaults."""

from collections.abc import Iterator
from copy import deepcopy
from dataclasses import MISSING, Field, fields
from typing import NamedTuple

import pytest
import yaml
from lxml import etree

from linkforge_compile import compile_text, core, render_urdf, write_spec
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.core.models.joint import JointDynamics, JointLimits, JointMimic, JointSafetyController
from linkforge_compile.core.models.link import Inertial, InertiaTensor, Link, LinkPhysics
from linkforge_compile.core.models.sensor import CameraInfo, ForceTorqueInfo, LidarInfo, Sensor, SensorNoise
from linkforge_compile.core.models.transmission import TransmissionActuator, TransmissionJoint
from tests.export_spec.test_every_field import is_part

ROBOT = yaml.safe_load("""
    linkforge: 1
    name: r
    links:
      base:
      arm:
        visual: {mesh: {file: package://p/arm.stl}}
        collision: {box: [1, 1, 1]}
        inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}
        physics: {}
      tool:
    joints:
      elbow:
        {type: revolute, parent: base, child: arm, axis: z, limits: {lower: 0, upper: 1, effort: 10, velocity: 1},
        dynamics: {}, safety_controller: {}}
      finger: {type: continuous, parent: arm, child: tool, axis: z, mimic: {joint: elbow}}
    materials: {red: {color: [1, 0, 0]}}
    sensors:
      eye: {type: camera, link: arm, camera: {noise: {}}}
      scan: {type: lidar, link: arm, lidar: {}}
      force: {type: force_torque, link: tool, force_torque: {}}
    transmissions:
      gears: {type: transmission_interface/SimpleTransmission, joints: {elbow: {}}, actuators: {motor: {}}}
    ros2_control: {arm: {hardware_plugin: x/Y, joints: {elbow: {command_interfaces: [position]}}}}
""")


class Place(NamedTuple):
    """The path of a field in a spec, below ROBOT, and in the URDF."""

    spec: str
    urdf: str


EYE, SCAN = (f"//sensor[@name='{name}']" for name in ("eye", "scan"))
TRANSMISSION = "//transmission[@name='gears']"

PLACES = {
    (core.Visual, "origin"): Place("links/arm/visual/origin", "//visual/origin"),
    (core.Collision, "origin"): Place("links/arm/collision/origin", "//collision/origin"),
    (Inertial, "origin"): Place("links/arm/inertial/origin", "//inertial/origin"),
    (core.Joint, "origin"): Place("joints/elbow/origin", "//joint[@name='elbow']/origin"),
    (Sensor, "origin"): Place("sensors/eye/origin", f"{EYE}/pose"),
    (Transform, "xyz"): Place("joints/elbow/origin/xyz", "//joint[@name='elbow']/origin/@xyz"),
    (Transform, "rpy"): Place("joints/elbow/origin/rpy", "//joint[@name='elbow']/origin/@rpy"),
    (core.Mesh, "scale"): Place("links/arm/visual/mesh/scale", "//mesh/@scale"),
    **{
        (InertiaTensor, name): Place(f"links/arm/inertial/inertia/{name}", f"//inertia/@{name}")
        for name in ("ixy", "ixz", "iyz")
    },
    **{
        (LinkPhysics, name): Place(f"links/arm/physics/{name}", f"//gazebo[@reference='arm']/{tag}")
        for name, tag in {
            "self_collide": "selfCollide",
            "gravity": "gravity",
            "mu": "mu1",
            "mu2": "mu2",
            "kp": "kp",
            "kd": "kd",
        }.items()
    },
    **{
        (JointDynamics, name): Place(f"joints/elbow/dynamics/{name}", f"//joint/dynamics/@{name}")
        for name in ("damping", "friction")
    },
    **{
        (JointMimic, name): Place(f"joints/finger/mimic/{name}", f"//joint/mimic/@{name}")
        for name in ("multiplier", "offset")
    },
    (JointSafetyController, "k_velocity"): Place(
        "joints/elbow/safety_controller/k_velocity", "//safety_controller/@k_velocity"
    ),
    **{
        (Sensor, name): Place(f"sensors/eye/{name}", f"{EYE}/{name}")
        for name in ("update_rate", "always_on", "visualize")
    },
    **{
        (CameraInfo, name): Place(f"sensors/eye/camera/{name}", f"{EYE}/camera/{tag}")
        for name, tag in {
            "horizontal_fov": "horizontal_fov",
            "width": "image/width",
            "height": "image/height",
            "format": "image/format",
            "near_clip": "clip/near",
            "far_clip": "clip/far",
        }.items()
    },
    **{
        (SensorNoise, name): Place(f"sensors/eye/camera/noise/{name}", f"{EYE}/camera/noise/{name}")
        for name in ("type", "mean", "stddev", "bias_mean", "bias_stddev")
    },
    **{
        (LidarInfo, f"{side}_{name}"): Place(f"sensors/scan/lidar/{side}_{name}", f"{SCAN}/lidar/scan/{side}/{name}")
        for side in ("horizontal", "vertical")
        for name in ("samples", "resolution", "min_angle", "max_angle")
    },
    **{
        (LidarInfo, f"range_{name}"): Place(f"sensors/scan/lidar/range_{name}", f"{SCAN}/lidar/range/{name}")
        for name in ("min", "max", "resolution")
    },
    **{
        (ForceTorqueInfo, name): Place(f"sensors/force/force_torque/{name}", f"//force_torque/{name}")
        for name in ("frame", "measure_direction")
    },
    **{
        (kind, name): Place(f"transmissions/gears/{section}/{name}", f"{TRANSMISSION}/{element}/{tag}")
        for kind, section, element in (
            (TransmissionJoint, "joints/elbow", "joint"),
            (TransmissionActuator, "actuators/motor", "actuator"),
        )
        for name, tag in {
            "hardware_interfaces": "hardwareInterface",
            "mechanical_reduction": "mechanicalReduction",
            "offset": "offset",
        }.items()
    },
    (core.Ros2Control, "type"): Place("ros2_control/arm/type", "//ros2_control/@type"),
}

OF_NO_SPEC = {
    **dict.fromkeys([(JointLimits, "effort"), (JointLimits, "velocity")], "a spec has to say them"),
    (Inertial, "inertia"): "unsaid, it is computed",
    (core.Ros2Control, "hardware_plugin"): "the default is refused",
    (core.Color, "a"): "one of the numbers of a list, which are all written",
    (core.SemanticRobotDescription, "robot_name"): "the name of the robot",
    (Link, "physics"): "a part, whose fields are here",
    (core.Material, "after_links"): "where it stands, not what it says",
}


def defaults() -> Iterator[tuple[type, Field[object]]]:
    """Yield every field of the IR whose default is a value, not nothing at all."""
    for kind in (getattr(core, name) for name in core.__all__):
        for field in fields(kind) if is_part(kind) else ():
            if (
                default_of(field) not in (MISSING, None, (), {})
                and not field.name.startswith("is_")
                and not field.name.endswith("_stated")
            ):
                yield kind, field


def default_of(field: Field[object]) -> object:
    return field.default_factory() if field.default_factory is not MISSING else field.default


def as_written(value: object) -> object:
    """Return a value of the model as YAML."""
    match value:
        case Transform(xyz=xyz):
            return as_written(xyz)
        case Vector3():
            return list(value)
        case tuple():
            return list(value)
        case str():
            return str(value)
    return value


def with_value(path: str, value: object) -> str:
    spec = deepcopy(ROBOT)
    *way, key = path.split("/")
    node = spec
    for step in way:
        node = node.setdefault(step, {})
    node[key] = value
    return yaml.safe_dump(spec, sort_keys=False)


def test_every_default_is_walked():
    assert {(kind, field.name) for kind, field in defaults()} == PLACES.keys() | OF_NO_SPEC.keys()


WALKED = [(kind, field) for kind, field in defaults() if (kind, field.name) in PLACES]


@pytest.mark.parametrize(("kind", "field"), WALKED, ids=[f"{kind.__name__}.{field.name}" for kind, field in WALKED])
def test_a_written_default_is_written_again(kind: type, field: Field[object]):
    place = PLACES[kind, field.name]
    robot = compile_text(with_value(place.spec, as_written(default_of(field)))).result()
    urdf = render_urdf(robot)
    assert etree.fromstring(urdf.encode()).xpath(place.urdf)
    assert render_urdf(compile_text(write_spec(robot)).result()) == urdf


def test_what_is_not_set_is_not_written():
    urdf = etree.fromstring(render_urdf(compile_text(yaml.safe_dump(ROBOT, sort_keys=False)).result()).encode())
    assert not urdf.xpath("//origin | //pose | //@scale | //mimic/@multiplier | //mimic/@offset | //offset | //kp")
