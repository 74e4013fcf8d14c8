"""The names of robots' files."""

from __future__ import annotations

from pathlib import Path


def stem_of(robot: str | Path) -> str:
    """Return the name of a robot's file without its endings: arm for arm.robot.yaml, arm.xml and arm.urdf.xacro."""
    name = Path(robot).name
    for ending in (".yaml", ".yml", ".robot", ".xacro", ".xml", ".urdf"):
        name = name.removesuffix(ending)
    return name
