"""Plugins of a simulator name joints that are there, and those that hardware needs are loaded."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from linkforge_compile.checks.references import Use, unknown
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.names import UNKNOWN_PLUGIN_JOINT
from linkforge_compile.diagnostics.codes.physics import NO_SIMULATOR_PLUGIN

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboPlugin
    from linkforge_compile.core.part import Part
    from linkforge_compile.source import Span

SIMULATED_HARDWARE = {
    "gz_ros2_control": "gz_ros2_control-system",
    "ign_ros2_control": "ign_ros2_control-system",
    "gazebo_ros2_control": "libgazebo_ros2_control.so",
}
"""The file of the Gazebo plugin in which the hardware of a package runs, by the package."""


def check_plugin_joints(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """What a plugin is told by `joint_name`, `left_joint` and the like is a joint of this robot.

    A plugin that finds no such joint does nothing, or stops the simulator. Correct the name; a joint of a module
    bears the module's prefix, which `$(joint('name'))` adds. Nothing is wrong if the joint is one of another
    model in the simulator.
    """
    plugins = [*_plugins(robot)]
    below = _joints_below(robot) if plugins else {}
    for plugin in plugins:
        uses, offered = _named_joints(plugin), below.get(_trail(plugin), ())
        yield from unknown(
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


def _named_joints(plugin: GazeboPlugin) -> Iterator[Use]:
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


def _named(plugin: GazeboPlugin, text: str, path: tuple[str | int, ...]) -> Iterator[Use]:
    name = text.strip()
    # `model::joint` is a joint of another model, and a switch or a number is no name.
    if name.replace("_", "a").replace("-", "a").isalnum() and name not in {"true", "false"} and not name.isdecimal():
        yield Use(name, f"plugin '{plugin.name}'", plugin.source, path)


def check_simulated_hardware(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """Hardware of ros2_control that is Gazebo's has its plugin in the robot.

    `gz_ros2_control/GazeboSimSystem` and its like are no hardware to a controller manager of its own: the plugin
    starts one inside the simulator, which loads them. Add it to `gazebo` at top level, with its `filename`.
    Silent where raw XML may hold it, and while part of the robot could not be read.
    """
    raw = [*robot.extra_elements, *(text for each in robot.gazebo_elements for text in each.extra_elements)]
    is_loaded = any("ros2_control" in plugin.filename for plugin in _plugins(robot))
    if unresolved or is_loaded or any("ros2_control" in text for text in raw):
        return
    for control in robot.ros2_controls:
        needed = SIMULATED_HARDWARE.get(control.hardware_plugin.partition("/")[0])
        if needed:
            use = Use(control.name, f"ros2_control '{control.name}'", control.source, ("hardware_plugin",))
            yield use.told(NO_SIMULATOR_PLUGIN, plugin=control.hardware_plugin, needed=needed)
