"""Run the head under ros2_control, on mock hardware: `ros2 launch pan_tilt_description control.launch.py`.

The URDF and the parameters of the controllers are made of one spec when it is launched. Where one robot is enough,
name urdf/pan_tilt.urdf and config/pan_tilt_controllers.yaml, which the build has compiled.
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
            Node(
                package="controller_manager",
                executable="ros2_control_node",
                parameters=[head.description, head.file("ros2_controllers")],
            ),
            Node(
                package="controller_manager",
                executable="spawner",
                arguments=["joint_state_broadcaster", "head_controller"],
            ),
        ]
    )
