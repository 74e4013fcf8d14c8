"""What holds for every robot: written as a spec and compiled again, it is the robot that it was."""

import math
from dataclasses import replace

from hypothesis import HealthCheck, assume, given, settings

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.gazebo import GazeboPlugin
from linkforge_compile.core.models.geometry import Mesh, Vector3
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Collision, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics, Severity
from linkforge_compile.expand import arguments_from_values, expand
from linkforge_compile.export_spec import write_spec
from linkforge_compile.formats.render import render_srdf, render_urdf
from linkforge_compile.load import Loader
from linkforge_compile.lower import lower
from tests import strategies
from tests.formats.everything import everything


def compiled(text: str) -> Robot:
    """Read, validate, expand and lower a spec that has no fault; without checks of the robot."""
    sink = Diagnostics()
    loader = Loader()
    spec = loader.parse(text, "written.robot.yaml", None, sink)
    assert spec is not None, (list(map(str, sink)), text)
    lowered = lower(expand(spec, arguments_from_values({}), loader, sink), sink)
    assert not [diagnostic for diagnostic in sink if diagnostic.severity is Severity.ERROR], (
        list(map(str, sink)),
        text,
    )
    assert lowered.robot is not None
    return lowered.robot


def sayable(robot: Robot) -> Robot:
    """Return what a spec can say of a robot: meshes with files, axes as they can have been written, XML as `extra`."""
    robot = robot.clone()
    robot.links = [
        replace(link, visuals=map(_with_a_file, link.visuals), collisions=map(_with_a_file, link.collisions))
        for link in robot.links
    ]
    robot.joints = [_with_an_axis_once_written(joint) for joint in robot.joints]
    robot.gazebo_elements = [
        replace(element, plugins=[_without_raw_xml(plugin) for plugin in element.plugins])
        for element in robot.gazebo_elements
    ]
    robot.sensors = [
        replace(sensor, plugin=sensor.plugin and _without_raw_xml(sensor.plugin)) for sensor in robot.sensors
    ]
    return robot


def _with_a_file(shape: Visual | Collision) -> Visual | Collision:
    if isinstance(shape.geometry, Mesh) and not shape.geometry.resource.strip():
        return replace(shape, geometry=replace(shape.geometry, resource="a.stl"))
    return shape


def _with_an_axis_once_written(joint: Joint) -> Joint:
    written = joint.axis_as_written
    if written is None or joint.axis is None:
        return joint
    length = math.hypot(*written)
    # A unit vector was not written otherwise: reading one leaves no other spelling.
    is_its_own = (
        length and written != joint.axis and Vector3(*(component / length for component in written)) == joint.axis
    )
    return joint if is_its_own else replace(joint, axis_as_written=None)


def _without_raw_xml(plugin: GazeboPlugin) -> GazeboPlugin:
    if plugin.raw_xml is None:
        return plugin
    raw = (plugin.raw_xml,) if plugin.raw_xml.strip() else ()
    return replace(plugin, raw_xml=None, parameters={}, extra_elements=(*raw, *plugin.extra_elements))


def has_tags(robot: Robot) -> bool:
    """Whether no property is called what would be an attribute of its owner."""
    plugins = [*(sensor.plugin for sensor in robot.sensors if sensor.plugin)]
    plugins += [plugin for element in robot.gazebo_elements for plugin in element.plugins]
    free = [plugin.parameters for plugin in plugins] + [element.properties for element in robot.gazebo_elements]
    free += [transmission.parameters for transmission in robot.transmissions]
    return not any(name.startswith("_") for part in free for name in part)


def is_sayable(robot: Robot) -> bool:
    """Whether it has no two things of one name, interfaces with parameters say, where a spec can have only one."""
    try:
        write_spec(robot)
    except RobotGeneratorError:
        return False
    return True


# A robot is a large thing to draw and to compile: the time goes into its hundreds of parts, not into those refused.
few = settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow])

robots = strategies.robots().map(sayable).filter(has_tags).filter(is_sayable)


@few
@given(robots)
def test_a_robot_comes_back_as_it_was(robot: Robot):
    again = compiled(write_spec(robot))
    pairs, ours = robot.semantic.disabled_collisions, again.semantic.disabled_collisions
    assert sorted(ours, key=repr) == sorted(pairs, key=repr)
    assert sorted(again.semantic.group_states, key=repr) == sorted(robot.semantic.group_states, key=repr)
    for one in (robot, again):
        one.semantic = replace(one.semantic, disabled_collisions=(), group_states=())
    assert again == robot


@few
@given(robots)
def test_its_documents_are_the_same_to_the_byte(robot: Robot):
    again = compiled(write_spec(robot))
    robot.semantic = _in_order_of_a_spec(robot)
    for render in (render_urdf, render_srdf):
        try:
            document = render(robot)
        except RobotGeneratorError:
            continue
        assert render(again) == document


def _in_order_of_a_spec(robot: Robot):
    """Bring together what has one first name, in the order in which those names first come."""

    def together(parts, first):
        order = list(dict.fromkeys(map(first, parts)))
        return sorted(parts, key=lambda part: order.index(first(part)))

    semantic = robot.semantic
    return replace(
        semantic,
        group_states=together(semantic.group_states, lambda state: state.group),
        disabled_collisions=together(semantic.disabled_collisions, lambda pair: pair.link1),
        joint_properties=together(semantic.joint_properties, lambda remark: remark.joint_name),
    )


@few
@given(robots)
def test_what_is_written_of_what_was_written_is_the_same(robot: Robot):
    text = write_spec(robot)
    assert write_spec(compiled(text)) == text


def test_a_robot_with_every_feature_comes_back_unchanged():
    robot = everything()
    again = compiled(write_spec(robot))
    assert again == robot
    assert render_urdf(again) == render_urdf(robot)
    assert render_srdf(again) == render_srdf(robot)


@given(strategies.semantics)
def test_a_semantic_part_of_any_kind_comes_back(semantic):
    robot = Robot("r", semantic=semantic)
    assume(is_sayable(robot) and len(set(semantic.passive_joints)) == len(semantic.passive_joints))
    again = compiled(write_spec(robot))
    assert again.normalized().semantic == robot.normalized().semantic
