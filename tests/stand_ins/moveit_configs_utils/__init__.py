from pathlib import Path

import yaml
from ament_index_python.packages import get_package_share_directory


class MoveItConfigsBuilder:
    """Reads `config/` of a package, by the names that its files must have."""

    def __init__(self, robot_name, *, package_name=None):
        self._package = Path(get_package_share_directory(package_name or f"{robot_name}_moveit_config"))
        self._name = robot_name

    def to_moveit_configs(self):
        return MoveItConfigs(self._package, self._name)


class MoveItConfigs:
    def __init__(self, package, name):
        self.package_path = package
        folder = package / "config"
        self.robot_description = {"robot_description": (folder / f"{name}.urdf").read_text("utf-8")}
        self.robot_description_semantic = {"robot_description_semantic": (folder / f"{name}.srdf").read_text("utf-8")}
        self.robot_description_kinematics = {"robot_description_kinematics": _read(folder / "kinematics.yaml")}
        self.joint_limits = {"robot_description_planning": _read(folder / "joint_limits.yaml")}
        self.planning_pipelines = {"planning_pipelines": ["ompl"], "default_planning_pipeline": "ompl"}
        self.pilz_cartesian_limits = _read(folder / "pilz_cartesian_limits.yaml")
        self.trajectory_execution = {"moveit_manage_controllers": True, **_read(_controllers_in(folder, name))}

    def to_dict(self):
        planning = {**self.joint_limits["robot_description_planning"], **self.pilz_cartesian_limits}
        return {
            **self.robot_description,
            **self.robot_description_semantic,
            **self.robot_description_kinematics,
            **self.planning_pipelines,
            **self.trajectory_execution,
            "robot_description_planning": planning,
        }


def _controllers_in(folder, name):
    """Return the file of controllers that is MoveIt's; several of which none is are an error."""
    found = {path.name.removesuffix("_controllers.yaml"): path for path in folder.glob("*_controllers.yaml")}
    if len(found) == 1:
        return next(iter(found.values()))
    return next(found[one] for one in ("moveit", "moveit2", name) if one in found)


def _read(file):
    return yaml.safe_load(file.read_text("utf-8"))
