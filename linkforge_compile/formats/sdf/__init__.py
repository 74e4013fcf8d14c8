"""SDF: the robot for Gazebo Sim."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.format import NO_YES, Option, Rendering, TemplateFormat

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.format import Options
    from linkforge_compile.formats.sdf.view import SdfChoices
    from linkforge_compile.formats.views import View


VERSION = Option(
    "sdf",
    ("least", "1.9", "1.11"),
    "least",
    "the version of SDF: 1.9 for Gazebo Fortress and later, 1.11 for Harmonic and later (default: 1.9, or 1.11 for a "
    "robot with mimic joints)",
)

MESHES = Option(
    "meshes",
    ("model", "file"),
    "model",
    "how SDF refers to meshes of packages: model://, which GZ_SIM_RESOURCE_PATH resolves, or files on this machine "
    "(default: model)",
)

NESTED = Option("nested", NO_YES, "no", "make each module a model inside that of the robot (default: one model)")


class Sdf(TemplateFormat):
    """The format SDF."""

    name = "sdf"
    suffix = ".sdf"
    share_folder = "sdf"
    description = "the robot for Gazebo Sim"
    keeps = "links, joints, inertials, shapes, materials, contact settings, sensors and plugins, with all their frames"
    loses = (
        "planar joints, safety controllers, calibrations, limits of acceleration and jerk, transmissions, materials of "
        "Gazebo Classic, plugins of links and joints, and raw XML of a URDF"
    )
    has_relative_paths = True
    options = (VERSION, MESHES, NESTED)

    def missing(self, robot: Robot) -> Diagnostic | None:
        from linkforge_compile.formats.sdf.limits import missing_body

        return missing_body(robot)

    @property
    def template_folders(self) -> tuple[str, ...]:
        return ("urdf", self.name)

    def limits(self, robot: Robot, options: Options) -> Iterator[Diagnostic]:
        from linkforge_compile.formats.sdf.limits import sdf_limits

        yield from sdf_limits(robot, self._choices(options), lambda: self.text(robot, Rendering(options)))

    def keeps_relative_paths(self, robot: Robot, options: Options) -> bool:
        return MESHES.value(options) != "file"

    def sought_files(self, robot: Robot, options: Options) -> tuple[Path, ...]:
        from linkforge_compile.formats.mesh_paths import mesh_paths, places_of_files, texture_paths

        if MESHES.value(options) != "file":
            return ()
        return places_of_files(robot, (*mesh_paths(robot), *texture_paths(robot)))

    def root_view(self, robot: Robot, options: Options) -> View:
        from linkforge_compile.formats.sdf.view import robot_view

        return robot_view(robot, self._choices(options))

    @staticmethod
    def _choices(options: Options) -> SdfChoices:
        from linkforge_compile.formats.sdf.view import SdfChoices

        version = VERSION.value(options)
        is_least = version == VERSION.default
        return SdfChoices(
            None if is_least else version, MESHES.value(options) == "file", NESTED.value(options) == "yes"
        )
