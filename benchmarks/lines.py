"""How many lines our examples take, beside the public xacro of the same robots.

    python benchmarks/lines.py

Counted are lines that are neither blank nor comments only. Ours are counted anew on each run; those of the public files
were counted once, by hand, in the text of the commits named below, and what the two sides do not share is said.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

EXAMPLES = Path(__file__).parents[1] / "examples"


class PublicFile(NamedTuple):
    """A file of a public repository, and how many lines of it are neither blank nor comments only."""

    path: str
    commit: str
    lines: int


class Robot(NamedTuple):
    """A robot that both sides describe; `differences` says where their scope is not the same."""

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


def lines_of(path: Path) -> int:
    lines = (line.strip() for line in path.read_text("utf-8").splitlines())
    return sum(1 for line in lines if line and not line.startswith("#"))


def main() -> None:
    for robot in ROBOTS:
        ours = sum(lines_of(EXAMPLES / path) for path in robot.ours)
        theirs = sum(file.lines for file in robot.theirs)
        print(f"{robot.name}: {ours} lines of ours, {theirs} of {robot.repository}")
        for file in robot.theirs:
            print(f"  {file.lines:5} {file.path} at {file.commit}")
        print(f"  {robot.differences}")


if __name__ == "__main__":
    main()
