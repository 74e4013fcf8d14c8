"""For launch files of ROS 2: a robot compiled when it is launched, its spec's parameters being launch arguments.

from linkforge_compile.launch import RobotDescription

robot = RobotDescription("robots/arm.robot.yaml")
LaunchDescription([
    *robot.arguments,
    Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[robot.description]),
])
"""

from linkforge_compile.launch.robot_description import RobotDescription

__all__ = ["RobotDescription"]
