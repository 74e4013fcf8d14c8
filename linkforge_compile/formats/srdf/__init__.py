"""SRDF: the semantic part of a robot, for MoveIt."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile.formats.format import TemplateFormat

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.formats.format import Options
    from linkforge_compile.formats.views import View


class Srdf(TemplateFormat):
    """The format SRDF, of robots with a semantic part."""

    name = "srdf"
    suffix = ".srdf"
    share_folder = "urdf"
    description = "the semantic part of a robot, for MoveIt"
    keeps = "the semantic part: groups, their states, end effectors, virtual and passive joints, disabled collisions"
    loses = "everything else, which its readers take from the URDF"
    is_default = True

    def missing(self, robot: Robot) -> Diagnostic | None:
        if robot.has_semantic and not robot.semantic.is_empty:
            return None
        from linkforge_compile.diagnostics.codes.formats import NO_SEMANTIC_PART

        return NO_SEMANTIC_PART.at(robot.source, "name", robot=robot.name)

    def limits(self, robot: Robot, options: Options) -> Iterator[Diagnostic]:
        """Yield what rendering refuses."""
        if not robot.has_semantic:
            return  # `robot.semantic` would make an empty part
        from linkforge_compile.formats.limits import check_attributes, undeclared_prefixes
        from linkforge_compile.formats.parts import doubtful_parts_in, unwritable_texts

        doubtful = doubtful_parts_in(robot.semantic)
        yield from unwritable_texts(doubtful.parts)
        yield from undeclared_prefixes(robot.semantic, doubtful.with_extras)
        yield from check_attributes(doubtful.with_extras, robot, lambda: self.text(robot))

    def root_view(self, robot: Robot, options: Options) -> View:
        from linkforge_compile.formats.srdf.view import semantic_view

        return semantic_view(robot)

    def view(self, robot: Robot, options: Options) -> View | None:
        return self.root_view(robot, options) if robot.has_semantic else None
