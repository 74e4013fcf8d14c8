"""Building robots in Python, call by call: `RobotBuilder("arm").link("base").visual(box(1, 1, 1)).mass(2.0)…`."""

from linkforge_compile.core.builders.link_builder import IComposer, LinkBuilder
from linkforge_compile.core.builders.robot_builder import RobotBuilder
from linkforge_compile.core.builders.semantic_builder import SemanticBuilder
from linkforge_compile.core.builders.shapes import box, capsule, cylinder, mesh, sphere

__all__ = [
    "IComposer",
    "LinkBuilder",
    "RobotBuilder",
    "SemanticBuilder",
    "box",
    "capsule",
    "cylinder",
    "mesh",
    "sphere",
]
