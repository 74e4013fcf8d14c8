"""Write a robot as a spec, and explain where its values come from."""

from __future__ import annotations

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.explain import Explanation, UnknownPathError, explain, parts_at
from linkforge_compile.export_spec.provenance import origin_of
from linkforge_compile.export_spec.robot import spec_of
from linkforge_compile.syntax.writer import write


def write_spec(robot: Robot, *, banner: str | None = None, origins: bool = False) -> str:
    """Return a robot as a flat spec; compiled, it gives an equal robot and the same URDF and SRDF (see `spec_of`).

    `banner` becomes a comment at the top. With `origins`, a comment above each part of a compiled robot shows where
    it was written.

    Raises:
        RobotGeneratorError: for two parts with the same name where a spec can hold only one.

    """
    builder = SpecBuilder()
    tree = spec_of(robot, builder)
    comments = {key: origin_of(source, robot.folder) for key, source in builder.parts.items()} if origins else {}
    heading = "".join(f"# {line}\n" for line in (banner or "").splitlines())
    return heading + write(tree, comments)
