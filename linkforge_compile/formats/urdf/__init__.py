"""URDF: the robot with its meshes, controllers and sensors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

from linkforge_compile.formats.format import Option, Rendering, TemplateFormat

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.format import Options
    from linkforge_compile.formats.views import View


Gazebo: TypeAlias = Literal["gz", "classic"]
"""The simulator whose dialect the tags of sensors have: Gazebo Sim (Harmonic) or Gazebo Classic (11)."""

GAZEBO = Option("gazebo", ("gz", "classic"), "gz", "the simulator that reads the sensors (default: gz)")


class Urdf(TemplateFormat):
    """The format URDF."""

    name = "urdf"
    suffix = ".urdf"
    share_folder = "urdf"
    description = "the robot with its meshes, controllers and sensors"
    keeps = "links, joints, inertias, shapes, materials, sensors, transmissions, ros2_control, Gazebo and raw XML"
    loses = "the semantic part, which is for SRDF; with --gazebo, sensors that the simulator does not have"
    is_default = True
    has_urdf = True
    has_relative_paths = True
    options = (GAZEBO,)

    def limits(self, robot: Robot, options: Options) -> Iterator[Diagnostic]:
        from linkforge_compile.formats.urdf.limits import urdf_limits

        yield from urdf_limits(robot, GAZEBO.value(options), lambda: self.text(robot, Rendering(options)))

    def root_view(self, robot: Robot, options: Options) -> View:
        from linkforge_compile.formats.urdf.view import robot_view

        return robot_view(robot, GAZEBO.value(options))
