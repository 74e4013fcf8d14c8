"""joint_limits.yaml: the limits of joints, for MoveIt."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.format import Format

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.format import Document, Options, Rendering
    from linkforge_compile.formats.views import View


class JointLimitsYaml(Format):
    """The joint_limits.yaml of MoveIt."""

    name = "joint_limits"
    suffix = "_joint_limits.yaml"
    description = "the limits of joints, for MoveIt"
    keeps = "the maximum velocity, acceleration, deceleration and jerk of each joint with one position"
    loses = "position limits and efforts, which MoveIt reads from the URDF"

    def missing(self, robot: Robot) -> Diagnostic | None:
        from linkforge_compile.formats.joint_limits.limits import missing_joints

        return missing_joints(robot)

    def limits(self, robot: Robot, options: Options) -> Iterator[Diagnostic]:
        from linkforge_compile.formats.joint_limits.limits import check_limits

        return check_limits(robot)

    def render(self, robot: Robot, rendering: Rendering) -> tuple[Document, ...]:
        from linkforge_compile.formats.yaml_document import render_yaml

        return (render_yaml(self, "joint_limits.yaml.j2", robot, rendering),)

    def view(self, robot: Robot, options: Options) -> View:
        from linkforge_compile.formats.joint_limits.limits import limits_view

        return limits_view(robot)
