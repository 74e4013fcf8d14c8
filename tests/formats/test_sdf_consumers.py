"""libsdformat finds in our SDF what it finds in our URDF, and complains about nothing."""

import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import pytest
from lxml import etree

from linkforge_compile import compile_file
from linkforge_compile.core import Robot
from linkforge_compile.diagnostics.codes.simulators import IMPOSSIBLE_FOR_GAZEBO
from linkforge_compile.formats import SDF, Rendering
from linkforge_compile.formats.render import render_urdf
from tests.conftest import ROOT
from tests.consumers import pinocchio_model
from tests.importers.robots import OF_CORPUS, OF_EXAMPLES, STEP
from tests.libsdformat import Part, Read, read_with_libsdformat

EXAMPLES = sorted((ROOT / "examples").rglob("*.robot.yaml"))
REAL = [*OF_EXAMPLES, *OF_CORPUS][::STEP]

RAW = [
    rf"XML Element\[{tag}\], child of element\[{parent}\]"
    for tag, parent in (("noise", "imu"), ("noise", "sensor"), ("optical_frame_id", "camera"))
]
"""What authors write into raw sensors, which are copied, although SDF 1.9 does not have it there."""

TWO_SENSORS = r"sensor with name\[rgbd_frame_sensor\] already exists"
"""Three versions of TALOS have two sensors of one name on one link, in raw XML."""

RECOVERING = etree.XMLParser(recover=True)
"""For elements of which libsdformat does not repeat the namespaces."""

TOLERANCE = 5e-8
"""libsdformat converts the angles of a URDF to quaternions and back, which is worst near a pitch of a quarter turn."""


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_the_same_to_libsdformat_as_their_urdf(path: Path, tmp_path: Path):
    robot = compile_file(path).robot
    assert robot is not None
    ours = read_ours(robot, tmp_path)
    assert own_complaints(ours) == []
    require_poses_of_pinocchio(robot, ours)
    require_same(robot, ours, converted(robot, tmp_path))


@pytest.mark.parametrize("path", REAL, ids=lambda path: path.stem)
def test_real_robots_are_the_same_to_libsdformat_as_their_urdf(path: Path, tmp_path: Path):
    robot = compile_file(path).robot
    assert robot is not None
    ours = read_ours(robot, tmp_path)
    of_author = rf"({'|'.join(RAW)}), not defined in SDF. Copying|{TWO_SENSORS}"
    if not path.stem.startswith("talos_reduced"):
        assert [one for one in own_complaints(ours) if not re.search(of_author, one)] == []
    require_poses_of_pinocchio(robot, ours)
    require_same(robot, ours, converted(robot, tmp_path))


def read_ours(robot: Robot, folder: Path) -> Read:
    """Read the SDF of a robot in version 1.9, the last one that libsdformat 12 knows, which has no mimic joints."""
    return read_with_libsdformat(SDF.render(robot, Rendering({"sdf": "1.9"}))[0].text, folder, is_strict=True)


def own_complaints(read: Read) -> list[str]:
    """Return the complaints, without those about the tag by which Gazebo Harmonic alone knows the frame of a sensor."""
    return [one for one in read.complaints if "XML Element[gz_frame_id]" not in one]


def converted(robot: Robot, folder: Path) -> Read:
    """Return what libsdformat reads in the URDF of a robot, changed so that the conversion drops nothing.

    It drops links of little mass and all below them, fixed joints, models with an impossible tensor, and of a link and
    a joint of one name, either.
    """
    document = etree.fromstring(render_urdf(robot).encode())
    changed = changed_inertials(robot)
    for link in document.iterfind("link"):
        own = robot.links[link.get("name")]
        if (own.mass < LEAST or own.name in changed) and own.name != "world":
            for inertial in link.findall("inertial"):
                link.remove(inertial)
            link.append(etree.fromstring(INERTIAL))
    for joint in document.iterfind("joint"):
        if robot.has_link(joint.get("name")):
            joint.set("name", f"{joint.get('name')}_joint")
        if joint.get("type") == "fixed":
            block = etree.SubElement(document, "gazebo", reference=joint.get("name"))
            etree.SubElement(block, "preserveFixedJoint").text = "true"
    return read_with_libsdformat(etree.tostring(document).decode(), folder, suffix=".urdf")


LEAST = 1e-5
"""A mass that the conversion does not take for 0 [kg]."""

INERTIAL = """
<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
"""


def changed_inertials(robot: Robot) -> set[str]:
    """Return the links with a tensor that no body can have, which differs in the SDF."""
    return {one.subject for one in SDF.limits(robot, {}) if one.code is IMPOSSIBLE_FOR_GAZEBO}


def require_same(robot: Robot, ours: Read, reference: Read) -> None:
    """Compare poses, mass properties, axes, limits, shapes with their settings and sensors with the converted URDF."""
    changed, loose = changed_inertials(robot), links_below_loose_joints(robot)
    assert [one for one in reference.errors if not re.search(TWO_SENSORS, one)] == []
    for link in robot.links:
        if link.name == "world":
            continue
        found, expected = ours.links.get(link.name) or ours.frames[link.name], reference.links[link.name]
        if link.name not in loose:
            require_same_pose(found, expected)
        if link.mass >= LEAST and link.name not in changed:
            assert found["mass"] == pytest.approx(expected["mass"], rel=1e-12)
            assert found["center"] == pytest.approx(expected["center"], abs=1e-12)
            assert found["inertia"] == pytest.approx(expected["inertia"], rel=1e-9, abs=1e-12)
        elif link.mass:
            assert found["mass"] == link.mass
    for name, joint in ours.joints.items():
        if joint["child"] not in loose:
            require_same_joint(joint, reference.joints[name])
    for kind in ("visuals", "collisions"):
        require_same_shapes(shapes(ours, kind, loose), shapes(reference, kind, loose, is_converted=True))
    require_same_sensors(sensors_of(ours, loose), sensors_of(reference, loose))
    require_colors(robot, ours)


class Shape(NamedTuple):
    """A visual or collision: its geometry, its part, and its settings."""

    geometry: list[object]
    part: Part
    settings: dict[tuple[str, int], float]


def shapes(read: Read, kind: str, loose: set[str], *, is_converted: bool = False) -> list[Shape]:
    """Return the visuals or collisions of all links but the loose ones and the world.

    The conversion gives the settings of a link to its first collision, and not to those with a name; all have them.
    """
    is_of_first = is_converted and kind == "collisions"
    found: list[Shape] = []
    for name, link in read.links.items():
        for shape in link[kind] if name not in {*loose, "world"} else ():
            found.append(Shape(geometry_of(shape), shape, settings_of(link[kind][0] if is_of_first else shape)))
    return found


SURFACE = (
    *(f"surface/friction/ode/{tag}" for tag in ("mu", "mu2", "fdir1")),
    *(f"surface/contact/ode/{tag}" for tag in ("kp", "kd", "max_vel", "min_depth")),
    "max_contacts",
    "laser_retro",
)


def settings_of(shape: Part) -> dict[tuple[str, int], float]:
    """Return the settings of a collision by their path and the number in a text; none for a visual."""
    element = etree.fromstring(shape["xml"], RECOVERING)
    texts = {path: element.findtext(path) or "" for path in SURFACE}
    return {(path, place): float(word) for path, text in texts.items() for place, word in enumerate(text.split())}


def require_colors(robot: Robot, ours: Read) -> None:
    """Compare the colors of visuals with those of the robot, which the conversion makes a quarter brighter."""
    of_gazebo = {
        one.reference for one in robot.gazebo_elements if "visual" in str((one.properties, one.extra_elements))
    }
    expected = [
        visual.material.color.to_tuple()
        for link in robot.links
        for visual in link.visuals
        if visual.material and visual.material.color and link.name not in {*of_gazebo, "world"}
    ]
    visuals = [etree.fromstring(one["xml"], RECOVERING) for link in ours.links.values() for one in link["visuals"]]
    for tag in ("ambient", "diffuse", "specular"):
        found = [visual.findtext(f"material/{tag}") or "" for visual in visuals]
        missing = Counter(map(in_digits, expected)) - Counter(in_digits(map(float, text.split())) for text in found)
        assert not missing, (tag, missing)


def in_digits(color: Iterable[float]) -> tuple[str, ...]:
    return tuple(f"{one:.6g}" for one in color)


def geometry_of(shape: Part) -> list[object]:
    """Return the tags of a geometry, such as `mesh` and `scale`, with their text or numbers."""
    geometry = etree.fromstring(shape["xml"], RECOVERING).find("geometry")
    assert geometry is not None, shape["xml"]
    elements = [element for element in geometry.iter() if not is_usual(element)]
    return sorted(((element.tag, as_numbers(element.text or "")) for element in elements), key=lambda one: one[0])


def is_usual(element: etree._Element) -> bool:
    """Whether an element is a scale of 1, which is the same as none."""
    return element.tag == "scale" and as_numbers(element.text) == [1, 1, 1]


def as_numbers(text: str) -> list[float] | str:
    """Return the numbers of a text with twelve digits, as the conversion rounds them; a text without as it is."""
    try:
        return [float(f"{float(word):.12g}") for word in text.split()]
    except ValueError:
        return text.strip()


def require_same_shapes(found: list[Shape], expected: list[Shape]) -> None:
    """Compare shapes in whatever order: those of links that are frames in our SDF are on another link there."""
    left = list(found)
    for shape in expected:
        same = [one for one in left if one.geometry == shape.geometry and is_same_pose(one.part, shape.part)]
        assert same, (shape.part["name"], shape.geometry)
        equal = [one for one in same if one.settings == pytest.approx(shape.settings)]
        assert equal, (shape.part["name"], shape.settings, same[0].settings)
        left.remove(equal[0])
    assert left == []


def sensors_of(read: Read, loose: set[str]) -> dict[str, list[Part]]:
    """Return the sensors on links and in joints by name, of which an author may have repeated one."""
    kept = (link for name, link in read.links.items() if name not in loose)
    found: dict[str, list[Part]] = {}
    for part in (*kept, *(joint for joint in read.joints.values() if joint["child"] not in loose)):
        for sensor in part["sensors"]:
            found.setdefault(sensor["name"], []).append(sensor)
    return found


def require_same_sensors(found: dict[str, list[Part]], expected: dict[str, list[Part]]) -> None:
    """Compare poses, types, topics and rates; without fixed joints that are merged, the conversion has them right."""
    assert found.keys() == expected.keys()
    for name, sensors in found.items():
        for sensor, other in zip(sensors, expected[name], strict=True):
            require_same_pose(sensor, other)
            elements = [etree.fromstring(one["xml"], RECOVERING) for one in (sensor, other)]
            described = [(one.get("type"), one.findtext("topic"), one.findtext("update_rate")) for one in elements]
            assert described[0] == described[1], name


def links_below_loose_joints(robot: Robot) -> set[str]:
    """Return the links that the conversion leaves where the model is: it drops floating and planar joints."""
    loose = [joint.child for joint in robot.joints if joint.type in ("floating", "planar")]
    for link in loose:
        loose += [joint.child for joint in robot.joints if joint.parent == link]
    return set(loose)


def require_poses_of_pinocchio(robot: Robot, ours: Read) -> None:
    """Compare the poses of all links with those of Pinocchio in our URDF, closer than the conversion allows."""
    pinocchio = pytest.importorskip("pinocchio")
    model = pinocchio_model(render_urdf(robot))
    data, loose = model.createData(), links_below_loose_joints(robot)
    pinocchio.framesForwardKinematics(model, data, pinocchio.neutral(model))
    for link in robot.links:
        if link.name != "world" and link.name not in loose:
            frame = data.oMf[model.getFrameId(link.name, pinocchio.FrameType.BODY)]
            turn = pinocchio.Quaternion(frame.rotation)
            pose = [*frame.translation, turn.w, turn.x, turn.y, turn.z]
            require_same_pose(ours.links.get(link.name) or ours.frames[link.name], {"pose": pose}, tolerance=1e-12)


def require_same_pose(found: Part, expected: Part, tolerance: float = TOLERANCE) -> None:
    assert is_same_pose(found, expected, tolerance), (found["name"], found["pose"], expected["pose"])


def is_same_pose(found: Part, expected: Part, tolerance: float = TOLERANCE) -> bool:
    # A quaternion and its negative are the same turn.
    product = sum(a * b for a, b in zip(found["pose"][3:], expected["pose"][3:], strict=True))
    is_same_place = found["pose"][:3] == pytest.approx(expected["pose"][:3], abs=tolerance)
    return is_same_place and abs(product) == pytest.approx(1, abs=tolerance)


def require_same_joint(found: Part, expected: Part) -> None:
    assert found["type"] == expected["type"]
    require_same_pose(found, expected)
    if found["type"] == "fixed":  # to which the conversion adds an axis
        return
    for axis, other in zip(found["axes"], expected["axes"], strict=True):
        assert axis["xyz"] == pytest.approx(other["xyz"], abs=TOLERANCE)
        for name in ("lower", "upper", "effort", "velocity", "damping", "friction"):
            assert axis[name] == pytest.approx(other[name], rel=1e-12), (found["name"], name)
