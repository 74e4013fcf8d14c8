"""MJCF: the robot for MuJoCo."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.format import Option, TemplateFormat

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.format import Options
    from linkforge_compile.formats.views import View


BASE = Option("base", ("fixed", "free"), "fixed", "whether the robot floats in MuJoCo (default: fixed)")


class Mjcf(TemplateFormat):
    """The format MJCF; its suffix is `.mjcf`, as a file that ends in `.xml` is a URDF."""

    name = "mjcf"
    suffix = ".mjcf"
    share_folder = "mjcf"
    description = "the robot for MuJoCo"
    keeps = (
        "links, joints, inertias, shapes, meshes, mimic joints, command interfaces as actuators, IMUs, force-torque "
        "sensors, cameras, disabled collisions and group states"
    )
    loses = (
        "velocity limits, messages of sensors, safety controllers, transmissions, settings and plugins of Gazebo, "
        "other sensors, gpios, textures of single shapes and raw XML"
    )
    has_relative_paths = True
    options = (BASE,)

    def limits(self, robot: Robot, options: Options) -> Iterator[Diagnostic]:
        from linkforge_compile.formats.mjcf.limits import mjcf_limits

        yield from mjcf_limits(robot, is_free=BASE.value(options) == "free")

    def keeps_relative_paths(self, robot: Robot, options: Options) -> bool:
        from linkforge_compile.formats.mjcf.view import mesh_assets

        return mesh_assets(robot).folder is None

    def sought_files(self, robot: Robot, options: Options) -> tuple[Path, ...]:
        from linkforge_compile.formats.mesh_paths import mesh_paths, places_of_files

        return places_of_files(robot, mesh_paths(robot))

    def root_view(self, robot: Robot, options: Options) -> View:
        from linkforge_compile.formats.mjcf.view import robot_view

        return robot_view(robot, is_free=BASE.value(options) == "free")
