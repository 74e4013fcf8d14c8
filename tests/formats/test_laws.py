"""What holds for every robot."""

from contextlib import suppress
from functools import partial

from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.geometry import Material, Transform, Vector3
from linkforge_compile.core.models.link import Inertial, InertiaTensor, Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Severity
from linkforge_compile.formats import SRDF, URDF
from linkforge_compile.formats.render import render_srdf, render_urdf
from tests import strategies

# The first document waits for Jinja to be imported and the templates to be compiled.
unhurried = settings(deadline=None)

lists = partial(st.lists, max_size=2)
hostile = st.text(st.characters(exclude_categories=()), max_size=8)
doubles = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def robots(draw: st.DrawFn) -> Robot:
    """Draw a robot of any parts; they need not fit together to be written."""
    return Robot(
        "r",
        materials={material.name: material for material in draw(lists(strategies.materials))},
        links=draw(lists(strategies.links(), unique_by=strategies.by_name)),
        joints=draw(lists(strategies.joints(), unique_by=strategies.by_name)),
        sensors=draw(lists(strategies.sensors())),
        transmissions=draw(lists(strategies.transmissions())),
        ros2_controls=draw(lists(strategies.ros2_controls())),
        gazebo_elements=draw(lists(strategies.gazebo_elements())),
        semantic=draw(strategies.semantics),
    )


@unhurried
@given(robots(), st.booleans(), st.sampled_from(["gz", "classic"]))
def test_a_document_is_well_formed_or_refused_with_a_report(robot: Robot, pretty: bool, gazebo: str):
    errors = [
        diagnostic for diagnostic in URDF.limits(robot, {"gazebo": gazebo}) if diagnostic.severity is Severity.ERROR
    ]
    try:
        text = render_urdf(robot, pretty=pretty, gazebo=gazebo)
    except RobotGeneratorError:
        assert errors
    else:
        assert not errors
        etree.fromstring(text.encode())


@unhurried
@given(robots())
def test_layout_changes_no_content(robot: Robot):
    documents = [render_srdf(robot, pretty=pretty) for pretty in (True, False)]
    assert len({etree.tostring(_without_layout(text), method="c14n") for text in documents}) == 1


def _without_layout(text: str) -> etree._Element:
    return etree.fromstring(text.encode(), etree.XMLParser(remove_blank_text=True))


@unhurried
@given(strategies.semantics)
def test_an_srdf_is_well_formed(semantic):
    robot = Robot("r", semantic=semantic)
    assert not list(SRDF.limits(robot, {}))
    etree.fromstring(render_srdf(robot).encode())


@unhurried
@given(hostile, hostile)
def test_any_text_comes_back_or_is_refused(texture: str, banner: str):
    robot = Robot("r", materials={"m": Material("m", texture=texture)})
    try:
        text = render_urdf(robot, banner=banner)
    except RobotGeneratorError:
        assert list(URDF.limits(robot, {}))
    else:
        assert etree.fromstring(text.encode()).find("material/texture").get("filename") == texture


@unhurried
@given(st.tuples(*[doubles] * 6), st.tuples(*[doubles] * 6), doubles.map(abs))
def test_numbers_come_back_as_the_same_doubles(pose: tuple[float, ...], tensor: tuple[float, ...], mass: float):
    link = Link("base", Inertial(mass, Transform(Vector3(*pose[:3]), Vector3(*pose[3:])), InertiaTensor(*tensor)))
    inertial = etree.fromstring(render_urdf(Robot("r", links=[link])).encode()).find("link/inertial")
    origin = inertial.find("origin")
    written = (origin.get("xyz") + " " + origin.get("rpy")).split() if origin is not None else ["0"] * 6
    assert tuple(map(float, written)) == pose
    assert float(inertial.find("mass").get("value")) == mass
    names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    assert tuple(float(inertial.find("inertia").get(name)) for name in names) == tensor


@unhurried
@given(robots())
def test_the_same_robot_gives_the_same_bytes(robot: Robot):
    with suppress(RobotGeneratorError):
        assert render_urdf(robot) == render_urdf(robot.clone())
    assert render_srdf(robot) == render_srdf(robot.clone())
