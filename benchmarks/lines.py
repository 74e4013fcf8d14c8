"""Count the lines of our examples and of the public xacro of the same robots.

    python benchmarks/lines.py

Counted are lines that are neither blank nor comments only. Ours are counted anew on each run; those of the public files
were counted once, by hand, in the text of the commits named below, and what the two sides do not share is said. Robots
of our own design have no public xacro: two of them we wrote in `xacro/` as well, as one would (macros for shapes, one
file a part), and a test holds that they give the same URDF as the specs.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"


class PublicFile(NamedTuple):
    """A file of a public repository, with its number of lines that are neither blank nor only a comment."""

    path: str
    commit: str
    lines: int


class Robot(NamedTuple):
    """A robot that both sides describe; `differences` are those in scope."""

    name: str
    ours: tuple[str, ...]
    repository: str
    theirs: tuple[PublicFile, ...]
    differences: str


ROBOTS = (
    Robot(
        "Robotiq 2F-85",
        ("05_gripper/robotiq_2f_85.robot.yaml",),
        "PickNikRobotics/ros2_robotiq_gripper",
        (
            PublicFile("robotiq_description/urdf/robotiq_2f_85_gripper.urdf.xacro", "463cf6e74bc5bc9b", 9),
            PublicFile("robotiq_description/urdf/robotiq_2f_85_macro.urdf.xacro", "77e60927cd5cdcc7", 276),
            PublicFile("robotiq_description/urdf/2f_85.ros2_control.xacro", "b27e8d914749f76a", 85),
        ),
        "ours gives the URDF that theirs gave at 3b6cf8f, with mock hardware, and the SRDF; theirs chooses between the "
        "real driver, Gazebo, Isaac and mock hardware, and has no SRDF",
    ),
    Robot(
        "Universal Robots' family, without its tables of numbers",
        ("04_ur_family/ur.robot.yaml",),
        "UniversalRobots/Universal_Robots_ROS2_Description",
        (
            PublicFile("urdf/ur.urdf.xacro", "9d77b9858b01aca3", 126),
            PublicFile("urdf/ur_macro.xacro", "e08e81aba13a27ab", 382),
            PublicFile("urdf/inc/ur_common.xacro", "a0c29082ac321c44", 190),
        ),
        "ours has three models, mock hardware and the SRDF; theirs has a dozen models, safety controllers, and the "
        "arguments of a driver, a tool and two Gazebos, and its ros2_control file is not counted",
    ),
)


class Twin(NamedTuple):
    """A robot of ours that we wrote in xacro as well."""

    name: str
    ours: tuple[str, ...]
    xacro: tuple[str, ...]


TWINS = (
    Twin("Rover", ("06_rover/rover.robot.yaml",), ("rover.urdf.xacro", "shapes.xacro")),
    Twin(
        "Quadruped",
        ("07_quadruped/quadruped.robot.yaml", "07_quadruped/leg.robot.yaml"),
        ("quadruped.urdf.xacro", "leg.xacro", "shapes.xacro"),
    ),
)


def lines_of(path: Path) -> int:
    text = path.read_text("utf-8")
    if path.suffix == ".xacro":
        text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    lines = (line.strip() for line in text.splitlines())
    return sum(1 for line in lines if line and not line.startswith("#"))


def of_ours(robot: Robot | Twin) -> int:
    return sum(lines_of(EXAMPLES / path) for path in robot.ours)


def of_xacro(robot: Robot | Twin) -> int:
    if isinstance(robot, Twin):
        return sum(lines_of(HERE / "xacro" / path) for path in robot.xacro)
    return sum(file.lines for file in robot.theirs)


def main() -> None:
    for robot in ROBOTS:
        print(f"{robot.name}: {of_ours(robot)} lines of ours, {of_xacro(robot)} of {robot.repository}")
        for file in robot.theirs:
            print(f"  {file.lines:5} {file.path} at {file.commit}")
        print(f"  {robot.differences}")
    for twin in TWINS:
        print(f"{twin.name}: {of_ours(twin)} lines with the SRDF, {of_xacro(twin)} of xacro without it")
        for path in twin.xacro:
            print(f"  {lines_of(HERE / 'xacro' / path):5} {path}")


if __name__ == "__main__":
    main()
