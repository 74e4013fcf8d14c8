"""Sensors and plugins of simulators: the links, joints, frames and topics that they name."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from linkforge_compile.checks.names import Reference, report_unknown
from linkforge_compile.core.models.gazebo import GazeboPlugin
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.sensor import INFO_FIELDS
from linkforge_compile.core.part import Part
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import SCANNER_WITHOUT_RAYS
from linkforge_compile.diagnostics.codes.names import (
    REFUSED_TOPIC,
    SHARED_TOPIC,
    UNKNOWN_COLLISION,
    UNKNOWN_FRAME,
    UNKNOWN_GAZEBO_REFERENCE,
    UNKNOWN_LINK,
    UNKNOWN_PLUGIN_JOINT,
)
from linkforge_compile.diagnostics.codes.physics import NO_SIMULATOR_PLUGIN, UNRESOLVED_PACKAGE
from linkforge_compile.diagnostics.entry_fixes import add_entry
from linkforge_compile.source import Span

_STRANGE = re.compile(r"[^A-Za-z0-9_/~{}]")
_SUBSTITUTION = re.compile(r"\{[A-Za-z_][A-Za-z0-9_]*\}")
_BRACE = re.compile(r"[{}]")
_NUMBERED = re.compile(r"(?:^|/)([0-9][^/]*)")


def check_sensor_links(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The link of a sensor is a link of this robot.

    A simulator drops a sensor whose link it does not know, mostly without a message. Correct the `link`.
    """
    links = (
        Reference(sensor.link_name, f"sensor '{sensor.name}'", sensor.source, ("link",)) for sensor in robot.sensors
    )
    yield from report_unknown(links, UNKNOWN_LINK, robot.links.names, unresolved)


def check_sensor_frames(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The frame of a sensor's messages is a link of this robot.

    robot_state_publisher publishes the frames of links only, so measurements in another frame cannot be shown or
    used, unless another node publishes that frame. Correct the name, or add the frame under
    `frames`.
    """
    frames = (
        Reference(sensor.frame, f"sensor '{sensor.name}'", sensor.source, ("frame",))
        for sensor in robot.sensors
        if sensor.frame
    )
    yield from report_unknown(frames, UNKNOWN_FRAME, robot.links.names, unresolved)


def check_scanners(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A laser scanner has rays.

    Gazebo gives a sensor without a scan no rays, so that it measures nothing. `lidar: {}` has the defaults.
    """
    for sensor in robot.sensors:
        if INFO_FIELDS[sensor.type] == "lidar_info" and sensor.lidar_info is None and not sensor.extra_elements:
            fault = SCANNER_WITHOUT_RAYS.at(sensor.source, "type", name=sensor.name, type=sensor.type)
            yield fault.with_fix(add_entry(sensor.source, entry="lidar: {}", after="type"))


def check_contacts(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The collision of a contact sensor is the name of a collision of the robot.

    The sensor of an unknown collision never reports a contact. Gazebo also generates names from a URDF, of the link and
    `_collision`, and others where it merges fixed joints: names that may be generated are not reported.
    """
    names = [collision.name for link in robot.links for collision in link.collisions if collision.name]
    contacts = (
        Reference(sensor.contact_info.collision, f"sensor '{sensor.name}'", sensor.contact_info.source, ("collision",))
        for sensor in robot.sensors
        if sensor.contact_info and not _may_be_generated(sensor.contact_info.collision, robot)
    )
    yield from report_unknown(contacts, UNKNOWN_COLLISION, names, unresolved)


def _may_be_generated(name: str, robot: Robot) -> bool:
    link, suffix, _ = name.partition("_collision")
    return "_lump__" in name or bool(suffix and link in robot.links)


def check_topics(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The topic of a sensor is a valid ROS 2 topic name.

    Names between slashes hold ASCII letters, digits and `_`, and do not begin with a digit; `~` is at the
    very start, before a `/`; `{name}` is a substitution. Gazebo accepts more (`front-camera`), but the bridge to
    ROS 2 then fails. A prefix that begins with a digit spoils the topics of its module.
    """
    for sensor in robot.sensors:
        if sensor.topic and (reason := _refusal(sensor.topic)):
            ref = Reference(sensor.name, f"sensor '{sensor.name}'", sensor.source, ("topic",))
            yield ref.report(REFUSED_TOPIC, topic=sensor.topic, reason=reason)


def _refusal(topic: str) -> str | None:
    plain = _SUBSTITUTION.sub("x", topic)
    if strange := _STRANGE.search(topic) or _BRACE.search(plain):
        return f"'{strange[0]}' is not allowed" if strange[0] not in "{}" else "its braces contain no name"
    if "~" in plain[1:] or (plain[0] == "~" and plain[1:2] not in {"", "/"}):
        return "'~' is allowed only at the start, before '/'"
    if "//" in plain:
        return "there is no name between '//'"
    if plain.endswith("/"):
        return "it ends with '/'"
    numbered = _NUMBERED.search(plain)
    return f"'{numbered[1]}' begins with a digit" if numbered else None


def check_shared_topics(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """Sensors publish on different topics.

    Readers get the messages of both in turn and cannot tell them apart; of two kinds of message one is lost.
    Give each sensor a topic of its own. A relative topic in a module gets the prefix of its use, an absolute
    one (`/camera`) does not, and is reported for each import of the module.
    """
    first: dict[str, Reference] = {}
    for sensor in robot.sensors:
        if not sensor.topic:
            continue
        ref = Reference(sensor.name, f"sensor '{sensor.name}'", sensor.source, ("topic",))
        earlier = first.setdefault(sensor.topic.removeprefix("/"), ref)
        if earlier is not ref and (ref.source is None or ref.place != earlier.place):
            notes = earlier.notes(f"sensor '{earlier.name}' publishes here")
            yield ref.report(SHARED_TOPIC, first=earlier.name, second=sensor.name, topic=sensor.topic, notes=notes)


SIMULATED_HARDWARE = {
    "gz_ros2_control": "gz_ros2_control-system",
    "ign_ros2_control": "ign_ros2_control-system",
    "gazebo_ros2_control": "libgazebo_ros2_control.so",
}
"""The file of the Gazebo plugin in which the hardware of a package runs, by the package."""


def check_plugin_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """The `joint_name`, `left_joint` and similar parameters of a plugin name joints of this robot.

    A plugin that finds no such joint does nothing, or stops the simulator. Correct the name; a joint of a module
    bears the module's prefix, which `$(joint('name'))` adds. Nothing is wrong if the joint is one of another
    model in the simulator.
    """
    plugins = [*_plugins(robot)]
    below = _joints_below(robot) if plugins else {}
    for plugin in plugins:
        uses, offered = _named_joints(plugin), below.get(_trail(plugin), ())
        yield from report_unknown(
            uses, UNKNOWN_PLUGIN_JOINT, robot.joints.names, unresolved, offered=offered, plugin=plugin.name
        )


def _joints_below(robot: Robot) -> Mapping[tuple[Span, ...], Sequence[str]]:
    """Return the joints that a file brings in, with its modules, by the uses that brought in the file.

    A plugin of the root may mean any joint, one of an arm none of the other arm.
    """
    below: defaultdict[tuple[Span, ...], list[str]] = defaultdict(list)
    for joint in robot.joints:
        trail = _trail(joint)
        for inner in range(len(trail) + 1):  # a trail ends with the use that the root wrote
            below[trail[inner:]].append(joint.name)
    return below


def _trail(part: Part) -> tuple[Span, ...]:
    return part.source.trail if part.source else ()


def _plugins(robot: Robot) -> Iterator[GazeboPlugin]:
    for element in robot.gazebo_elements:
        yield from element.plugins
    for sensor in robot.sensors:
        if sensor.plugin:
            yield sensor.plugin


def _named_joints(plugin: GazeboPlugin) -> Iterator[Reference]:
    for key, value in plugin.parameters.items():
        if key != "joint_name" and not key.endswith("_joint"):
            continue
        path = ("parameters", key)
        if isinstance(value, str):
            yield from _named(plugin, value, path)
        elif isinstance(value, Sequence):
            for place, each in enumerate(value):
                if isinstance(each, str):
                    yield from _named(plugin, each, (*path, place))


def _named(plugin: GazeboPlugin, text: str, path: tuple[str | int, ...]) -> Iterator[Reference]:
    name = text.strip()
    # `model::joint` is a joint of another model, and a switch or a number is no name.
    if name.replace("_", "a").replace("-", "a").isalnum() and name not in {"true", "false"} and not name.isdecimal():
        yield Reference(name, f"plugin '{plugin.name}'", plugin.source, path)


def check_simulated_hardware(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """Hardware of ros2_control that is Gazebo's has its plugin in the robot.

    `gz_ros2_control/GazeboSimSystem` and its like are no hardware to a controller manager of its own: the plugin
    starts one inside the simulator, which loads them. Add it to `gazebo` at top level, with its `filename`.
    Not checked if raw XML may hold it, or while part of the robot could not be read.
    """
    raw = [*robot.extra_elements, *(text for each in robot.gazebo_elements for text in each.extra_elements)]
    is_loaded = any("ros2_control" in plugin.filename for plugin in _plugins(robot))
    if unresolved or is_loaded or any("ros2_control" in text for text in raw):
        return
    for control in robot.ros2_controls:
        needed = SIMULATED_HARDWARE.get(control.hardware_plugin.partition("/")[0])
        if needed:
            ref = Reference(control.name, f"ros2_control '{control.name}'", control.source, ("hardware_plugin",))
            yield ref.report(NO_SIMULATOR_PLUGIN, plugin=control.hardware_plugin, needed=needed)


def check_plugin_files(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The `parameters` of a plugin that runs ros2_control in Gazebo are names of files as they are, not `package://`.

    The plugin hands them to ROS, which opens them under just that name: without the file, Gazebo runs without
    controllers. In a spec, `$(path('package://robot_bringup/config/controllers.yaml'))` is the file on this machine.
    """
    for plugin in _plugins(robot):
        files = plugin.parameters.get("parameters", ()) if "ros2_control" in plugin.filename else ()
        for path, text in [((), files)] if isinstance(files, str) else [((at,), one) for at, one in enumerate(files)]:
            if isinstance(text, str) and text.strip().startswith("package://"):
                name = text.strip()
                package = name.removeprefix("package://").partition("/")[0]
                place = ("parameters", "parameters", *path)
                ref = Reference(plugin.name, f"plugin '{plugin.name}'", plugin.source, place)
                yield ref.report(UNRESOLVED_PACKAGE, plugin=plugin.name, path=name, package=package)


def check_gazebo_references(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A Gazebo block with a reference is about a link or joint of this robot.

    Simulators drop other blocks in silence, and with them what they were to set. Correct the reference, or
    remove the block.
    """
    references = (
        Reference(element.reference, "Gazebo block", element.source, ("reference",))
        for element in robot.gazebo_elements
        if element.reference is not None
    )
    known = (*robot.links.names, *robot.joints.names) if robot.gazebo_elements else ()
    yield from report_unknown(references, UNKNOWN_GAZEBO_REFERENCE, known, unresolved)
