"""The view of the semantic part of a robot that the templates of SRDF lay out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import GroupState
from linkforge_compile.formats.element import attributes_of, placed
from linkforge_compile.formats.source_map import origin_of
from linkforge_compile.formats.views import View, Views
from linkforge_compile.formats.xml_text import Xml, spelled


class SrdfViews(Views):
    """Makes views of the semantic part of a robot."""

    def group_state(self, state: GroupState) -> View:
        """Return a state; its `joint_values` are names and their positions as one text."""
        values = state.joint_values.items()
        texts = [(placed(joint, state.source, joint), " ".join(map(spelled, positions))) for joint, positions in values]
        return self.view(state, joint_values=texts)

    makers: ClassVar[Mapping[type, Callable[[Any, Any], object]]] = {GroupState: group_state}


def semantic_view(robot: Robot) -> View:
    """Return what templates see of the semantic part of a robot."""
    semantic, links = robot.semantic, robot.links
    origin = origin_of(robot.source, "name", of="robot")
    return SrdfViews().view(
        semantic,
        attributes=Xml(origin + attributes_of(semantic, name=semantic.robot_name or robot.name)),
        # Names alone, collected from all modules: all that is known of each is where its link was written.
        no_default_collision_links=[
            placed(name, links[name].source if name in links else None) for name in semantic.no_default_collision_links
        ],
    )
