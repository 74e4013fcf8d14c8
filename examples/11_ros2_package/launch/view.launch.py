"""Show the head in RViz, as it is with the arguments of the launch: `ros2 launch pan_tilt_description view.launch.py`.

The spec is compiled when it is launched, so `--show-args` lists its parameters and `stalk:=10cm` is another robot.
Where one robot is enough, let robot_state_publisher read urdf/pan_tilt.urdf, which the build has compiled.
"""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node

from linkforge_compile.launch import RobotDescription


def generate_launch_description() -> LaunchDescription:
    share = Path(get_package_share_directory("pan_tilt_description"))
    head = RobotDescription(share / "robots" / "pan_tilt.robot.yaml", {"hardware": "mock"})
    return LaunchDescription(
        [
            *head.arguments,
            Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[head.description]),
            Node(package="joint_state_publisher_gui", executable="joint_state_publisher_gui"),
            Node(package="rviz2", executable="rviz2"),
        ]
    )
