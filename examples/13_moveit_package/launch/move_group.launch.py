"""Plan and move with MoveIt on mock hardware: `ros2 launch picker_moveit_config move_group.launch.py`.

In RViz, add the display MotionPlanning and choose `base_link` as the fixed frame. A robot with a virtual joint also
needs `generate_static_virtual_joint_tfs_launch(moveit)`.
"""

from launch import LaunchDescription
from launch_ros.actions import Node
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import (
    generate_move_group_launch,
    generate_rsp_launch,
    generate_spawn_controllers_launch,
)


def generate_launch_description() -> LaunchDescription:
    # Every MoveIt configuration has config/robot.urdf, config/robot.srdf and the same other files.
    moveit = MoveItConfigsBuilder("robot", package_name="picker_moveit_config").to_moveit_configs()
    controllers = str(moveit.package_path / "config" / "ros2_controllers.yaml")
    return LaunchDescription(
        [
            generate_rsp_launch(moveit),
            Node(
                package="controller_manager",
                executable="ros2_control_node",
                parameters=[controllers],
                # robot_state_publisher publishes the URDF. ROS 2 Humble needs moveit.robot_description as well.
                remappings=[("/controller_manager/robot_description", "/robot_description")],
            ),
            generate_spawn_controllers_launch(moveit),
            generate_move_group_launch(moveit),
            Node(
                package="rviz2",
                executable="rviz2",
                parameters=[moveit.planning_pipelines, moveit.robot_description_kinematics, moveit.joint_limits],
            ),
        ]
    )
