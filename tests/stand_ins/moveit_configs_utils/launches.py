from launch import LaunchDescription
from launch_ros.actions import Node


def generate_rsp_launch(moveit_config):
    publisher = Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        parameters=[moveit_config.robot_description, {"publish_frequency": 15.0}],
    )
    return LaunchDescription([publisher])


def generate_spawn_controllers_launch(moveit_config):
    manager = moveit_config.trajectory_execution.get("moveit_simple_controller_manager", {})
    names = [*manager.get("controller_names", []), "joint_state_broadcaster"]
    return LaunchDescription(
        [Node(package="controller_manager", executable="spawner", arguments=[one]) for one in names]
    )


def generate_move_group_launch(moveit_config):
    parameters = [moveit_config.to_dict(), {"publish_robot_description_semantic": True}]
    return LaunchDescription([Node(package="moveit_ros_move_group", executable="move_group", parameters=parameters)])
