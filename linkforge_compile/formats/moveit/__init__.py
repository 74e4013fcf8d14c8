"""The configuration of MoveIt: the folder `config` of a package, as `moveit_configs_utils` reads it."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

from linkforge_compile.formats.format import Format
from linkforge_compile.formats.joint_limits import JointLimitsYaml
from linkforge_compile.formats.ros2_controllers import Ros2Controllers
from linkforge_compile.formats.srdf import Srdf
from linkforge_compile.formats.urdf import Urdf

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.format import Document, Options, Rendering
    from linkforge_compile.formats.views import View


_WHOLE_FILES: Mapping[str, Format] = {
    "config/robot.urdf": Urdf(),
    "config/robot.srdf": Srdf(),
    "config/joint_limits.yaml": JointLimitsYaml(),
    "config/ros2_controllers.yaml": Ros2Controllers(),
}
"""Files that are the documents of other formats."""

_OWN_FILES = ("kinematics.yaml", "moveit_controllers.yaml", "initial_positions.yaml", "pilz_cartesian_limits.yaml")
"""Files in `config` of which there is a template each."""


class MoveIt(Format):
    """What MoveItConfigsBuilder("robot", package_name="NAME_moveit_config") looks for in a package."""

    name = "moveit"
    suffix = "_moveit_config"
    share_folder = ""
    files = (*_WHOLE_FILES, *(f"config/{name}" for name in _OWN_FILES))
    description = "the configuration of MoveIt, with the URDF and the SRDF"
    keeps = "the URDF, the SRDF, kinematics solvers, limits of joints, controllers and initial positions"
    loses = (
        "planning pipelines, for which MoveIt has defaults; launch files, the configuration of RViz and sensors, which "
        "are the package's own"
    )
    has_relative_paths = True
    has_urdf = True
    options = Urdf.options

    @property
    def template_folders(self) -> tuple[str, ...]:
        return (*chain.from_iterable(one.template_folders for one in _WHOLE_FILES.values()), self.name)

    def missing(self, robot: Robot) -> Diagnostic | None:
        from linkforge_compile.formats.moveit.limits import missing_groups

        return missing_groups(robot)

    def limits(self, robot: Robot, options: Options) -> Iterator[Diagnostic]:
        from linkforge_compile.formats.moveit.limits import (
            check_adjacent_links,
            check_execution,
            check_joint_states,
            check_solvers,
        )

        others = (one.limits(robot, options) for one in _WHOLE_FILES.values())
        return chain(
            *others,
            check_solvers(robot),
            check_joint_states(robot),
            check_execution(robot),
            check_adjacent_links(robot),
        )

    def render(self, robot: Robot, rendering: Rendering) -> tuple[Document, ...]:
        from linkforge_compile.formats.yaml_document import render_yaml

        whole = (one.render(robot, rendering)[0]._replace(name=name) for name, one in _WHOLE_FILES.items())
        own = (render_yaml(self, f"{name}.j2", robot, rendering, f"config/{name}") for name in _OWN_FILES)
        return (*whole, *own)

    def view(self, robot: Robot, options: Options) -> View:
        from linkforge_compile.formats.moveit.view import moveit_view

        return moveit_view(robot)
