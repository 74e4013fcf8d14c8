"""The view of a robot that the templates of SDF lay out."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.sensor import Sensor, SensorType
from linkforge_compile.formats.element import attributes_at, placed
from linkforge_compile.formats.kinematic_tree import leader_of
from linkforge_compile.formats.sdf.elements import pose
from linkforge_compile.formats.sdf.layout import Layout
from linkforge_compile.formats.sdf.links import Links, MeshUris, joint_frame, joint_view, link_frame
from linkforge_compile.formats.sdf.models import ROBOT, Model, Models
from linkforge_compile.formats.sdf.part_names import PartNames
from linkforge_compile.formats.sdf.settings import model_elements, nested_model_elements
from linkforge_compile.formats.urdf.gazebo import plugin_view, sensor_view
from linkforge_compile.formats.urdf.view import UrdfViews
from linkforge_compile.formats.views import View
from linkforge_compile.formats.xml_text import NOTHING, Xml

WITH_MIMIC = "1.11"
"""The first version of SDF with mimic joints, which Gazebo Harmonic reads."""

COMMON = "1.9"
"""The version that Gazebo Fortress reads, and each later one."""


class SdfChoices(NamedTuple):
    """The user's choices: a version of SDF, None for the least that holds the robot, and what meshes refer to.

    If `is_nested`, each module is a model.
    """

    version: str | None = None
    has_files: bool = False
    is_nested: bool = False


def sdf_version(robot: Robot, choices: SdfChoices) -> str:
    """Return the version of the document."""
    return choices.version or (WITH_MIMIC if any(leader_of(joint, robot) for joint in robot.joints) else COMMON)


def robot_view(robot: Robot, choices: SdfChoices) -> View:
    """Return what templates see of a robot in SDF: its version, and the view of the outermost model."""
    version, layout = sdf_version(robot, choices), Layout.of(robot)
    models = Models(layout, is_nested=choices.is_nested)
    uris = MeshUris(robot, is_resolved=choices.has_files)
    views = _ModelViews(layout, models, uris, has_mimic=version == WITH_MIMIC)
    attributes = attributes_at(robot.source, "name", name=robot.name, canonical_link=models.canonical_link(ROBOT))
    plugins = [
        plugin_view(plugin) for block in robot.gazebo_elements if block.reference is None for plugin in block.plugins
    ]
    of_robot = model_elements(layout.settings.get(None, ()))
    return View(version=version, model=views.view(ROBOT, attributes, NOTHING, of_robot, plugins))


class _ModelViews:
    """Makes the views of models, with the parts in them and the models inside."""

    def __init__(self, layout: Layout, models: Models, uris: MeshUris, *, has_mimic: bool) -> None:
        robot, settings = layout.robot, layout.settings
        self._models, self._flags = models, nested_model_elements(settings.get(None, ()))
        links = Links(layout, models, uris)
        on_links, in_joints = _sensors(robot, layout, links.names)
        self._frames: dict[Model, list[Xml]] = defaultdict(list)
        self._links: dict[Model, list[View]] = defaultdict(list)
        self._joints: dict[Model, list[View]] = defaultdict(list)
        for joint in robot.joints:
            if layout.is_joint(joint):
                found = settings.get(joint.name, ()), in_joints.get(joint.name, ())
                view = joint_view(joint, layout, models, *found, has_mimic=has_mimic)
                self._joints[models.of_joint(joint)].append(view)
            else:
                self._frames[models.of_joint(joint)].append(joint_frame(joint, layout, models))
        for name in layout.frames:
            self._frames[models.of_link(name)].append(link_frame(name, layout, models))
        for link in robot.links:
            if layout.is_body(link):
                self._links[models.of_link(link.name)].append(links.view(link, on_links))

    def view(self, model: Model, attributes: Xml, pose: Xml, settings: Xml, plugins: Sequence[View] = ()) -> View:
        return View(
            attributes=attributes,
            pose=pose,
            settings=settings,
            frames=self._frames[model],
            links=self._links[model],
            joints=self._joints[model],
            models=[
                self.view(inner, self._models.attributes(inner), self._models.pose(inner), self._flags)
                for inner in self._models.inside(model)
            ],
            plugins=plugins,
        )


def _sensors(
    robot: Robot, layout: Layout, names: PartNames
) -> tuple[Mapping[str, list[View]], Mapping[str, list[View]]]:
    """Return the sensors of each link, and those of each joint, which has the frame of the link below it."""
    on_links: dict[str, list[View]] = defaultdict(list)
    in_joints: dict[str, list[View]] = defaultdict(list)
    views = UrdfViews(robot, None, "gz")
    for sensor in robot.sensors:
        if sensor.type != SensorType.FORCE_TORQUE:
            on_links[sensor.link_name].append(_sensor(sensor, views, layout, names))
        elif joint := layout.above.get(sensor.link_name):
            in_joints[joint.name].append(_sensor(sensor, views, layout, names))
    return on_links, in_joints


def _sensor(sensor: Sensor, views: UrdfViews, layout: Layout, names: PartNames) -> View:
    """Return a sensor as in a URDF for Gazebo Sim, which is SDF, where it is exactly."""
    view = sensor_view(views, sensor, layout.robot, "gz")
    # A joint has the frame of the link below it.
    is_on_frame = sensor.link_name in layout.frames and sensor.type != SensorType.FORCE_TORQUE
    view.pose = pose(sensor.origin, relative_to=sensor.link_name if is_on_frame else None)
    contact = sensor.contact_info
    if contact and view.info:
        name = names.collision(sensor.link_name, contact.collision) or contact.collision
        view.info.collision = placed(name, contact.source, "collision")
    return view
