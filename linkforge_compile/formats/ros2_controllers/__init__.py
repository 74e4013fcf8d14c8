"""controllers.yaml: the parameters of a controller manager and of its controllers, for ros2_control."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.format import Format

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.format import Document, Options, Rendering
    from linkforge_compile.formats.views import View


class Ros2Controllers(Format):
    """The parameters of the controllers that a controller manager loads."""

    name = "ros2_controllers"
    suffix = "_controllers.yaml"
    description = "the controllers of ros2_control"
    keeps = "the controllers of the spec, or one for each planning group, with their joints, interfaces and parameters"
    loses = "the hardware, which the controller manager reads from the URDF"

    def missing(self, robot: Robot) -> Diagnostic | None:
        from linkforge_compile.formats.ros2_controllers.complete import missing_hardware

        return missing_hardware(robot)

    def limits(self, robot: Robot, options: Options) -> Iterator[Diagnostic]:
        from linkforge_compile.formats.ros2_controllers.limits import check_controllers

        return check_controllers(robot)

    def render(self, robot: Robot, rendering: Rendering) -> tuple[Document, ...]:
        from linkforge_compile.formats.yaml_document import render_yaml

        return (render_yaml(self, "controllers.yaml.j2", robot, rendering),)

    def view(self, robot: Robot, options: Options) -> View:
        from linkforge_compile.formats.ros2_controllers.view import controllers_view

        return controllers_view(robot)
