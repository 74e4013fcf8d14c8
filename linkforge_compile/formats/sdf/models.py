"""The models of an SDF: that of the robot and, if requested, one for each module, nested as modules are."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import takewhile
from typing import TypeAlias

from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.ros2_control import Ros2ControlJoint
from linkforge_compile.core.naming import unique_name
from linkforge_compile.formats.element import attributes_at
from linkforge_compile.formats.kinematic_tree import WORLD, leader_of
from linkforge_compile.formats.sdf.elements import pose, pose_between, pose_of_frame
from linkforge_compile.formats.sdf.layout import MODEL, Layout, relative_pose
from linkforge_compile.formats.source_map import origin_of_use
from linkforge_compile.formats.xml_text import NOTHING, Xml

SEPARATOR = "::"
"""Between the names of a nested model and of a part of it."""

Model: TypeAlias = tuple[str, ...]
"""The modules that lead to the one of a model, the outermost first; () for the model of the robot."""

ROBOT: Model = ()


class Models:
    """Which model each link and joint is in, and how they refer to each other.

    An element of SDF may refer to what is in its own model, or in models inside that. So a frame is in the model of the
    body that holds it, and a joint in the innermost one that has both of its links, and the joint that it mimics. A
    joint that gz_ros2_control moves is in that of the robot, as the plugin looks into no other.
    `all` lists the models with bodies, each before those inside it. A model is where the root of its module is.
    """

    def __init__(self, layout: Layout, *, is_nested: bool) -> None:
        self._layout = layout
        self._roots: Mapping[Model, str] = {}
        modules: Mapping[str, Model] = {}
        if is_nested:
            modules, self._roots = _modules_with_roots(layout)
        self._of_links = {link: modules.get(layout.body_of(link), ROBOT) for link in layout.robot.links.names}
        self._of_joints = self._models_of_joints()
        bodies = (self._of_links[link.name] for link in layout.robot.links if layout.is_body(link))
        self.all = tuple(dict.fromkeys(model[:end] for model in (ROBOT, *bodies) for end in range(len(model) + 1)))
        self.names = self._unique_names()
        self._inside: dict[Model, list[Model]] = defaultdict(list)
        for model in self.all[1:]:
            self._inside[model[:-1]].append(model)

    def of_link(self, link: str) -> Model:
        """Return the model of a link, whether that is a body, a frame or the world."""
        return self._of_links.get(link, ROBOT)

    def of_joint(self, joint: Joint) -> Model:
        return self._of_joints[joint.name]

    def innermost(self, joint: Joint) -> Model:
        """Return the innermost model that has both links of a joint."""
        return _common(self.of_link(joint.parent), self.of_link(joint.child))

    def inside(self, model: Model) -> Sequence[Model]:
        """Return the models directly inside another."""
        return self._inside.get(model, ())

    def link_in(self, model: Model, link: str) -> str:
        """Return how a model refers to a link in it, or in one inside it."""
        return self._scoped(model, self.of_link(link), link)

    def leader(self, joint: Joint) -> str | None:
        """Return how the model of a joint refers to the one that it mimics; None for one that it cannot."""
        leader = leader_of(joint, self._layout.robot)
        if leader is None:
            return None
        return self._scoped(self.of_joint(joint), self.of_joint(leader), self._layout.joint_names[leader.name])

    def _scoped(self, model: Model, inner: Model, name: str) -> str:
        ends = range(len(model) + 1, len(inner) + 1)
        return SEPARATOR.join([*(self.names[inner[:end]] for end in ends), name])

    def place(self, link: str, model: Model, *, is_frame: bool = False) -> Xml:
        """Return the pose of a link, or of the model at it, in the model that holds it.

        That of a frame is in what it is attached to, unless it says that it is in the model.
        """
        joint, root = self._layout.above.get(link), self._root(model)
        if joint and self.of_joint(joint) == model:
            return pose_of_frame(self._layout.joint_names[joint.name])
        if joint is None or link == root:
            return pose_of_frame(MODEL) if is_frame else NOTHING
        if joint.parent == root:
            return pose(joint.origin, relative_to=MODEL)
        return pose_between(relative_pose(link, root, self._layout.above), relative_to=MODEL)

    def attributes(self, model: Model) -> Xml:
        """Return the attributes of a nested model."""
        root = self._layout.robot.links[self._root(model)]
        uses = root.source.trail[-len(model) :] if root.source else ()
        attributes = attributes_at(None, name=self.names[model], canonical_link=self.canonical_link(model))
        return Xml(origin_of_use(uses) + attributes)

    def pose(self, model: Model) -> Xml:
        """Return the pose of a nested model in that around it."""
        return self.place(self._root(model), model[:-1])

    def canonical_link(self, model: Model) -> str | None:
        """Return the link that the frame of a model moves with; None for the first one, as is the default."""
        layout = self._layout
        body = layout.body_of(self._root(model))
        if not layout.robot.has_link(body) or layout.is_world(body) or self.of_link(body)[: len(model)] != model:
            return None
        own = (link for link in layout.robot.links if layout.is_body(link) and self.of_link(link.name) == model)
        first = next(own, None)
        return None if first and first.name == body else self.link_in(model, body)

    def _root(self, model: Model) -> str:
        if model:
            return self._roots[model]
        return next((link.name for link in self._layout.robot.links if link.name not in self._layout.above), "")

    def _models_of_joints(self) -> Mapping[str, Model]:
        joints = self._layout.robot.joints
        models = {one.name: self.innermost(one) for one in joints}
        models |= {one.name: ROBOT for one in moved_by_gazebo(self._layout.robot)}
        leaders = {one.name: one.mimic.joint for one in joints if one.mimic and one.mimic.joint in models}
        for _ in leaders:  # one that is mimicked may mimic another
            raised = {name: _common(models[name], models[leader]) for name, leader in leaders.items()}
            if all(models[name] == model for name, model in raised.items()):
                break
            models |= raised
        return models

    def _unique_names(self) -> Mapping[Model, str]:
        """Return the names of nested models: those of the modules, unless a link or joint has that."""
        layout = self._layout
        of_parts = {*layout.robot.links.names, *layout.joint_names.values()} - {WORLD}
        taken: dict[Model, set[str]] = defaultdict(of_parts.copy)
        names: dict[Model, str] = {}
        for model in self.all[1:]:
            name, around = model[-1], taken[model[:-1]]
            names[model] = unique_name(f"{name}_model" if name in of_parts else name, around)
            around.add(names[model])
        return names


def moved_by_gazebo(robot: Robot) -> Iterator[Ros2ControlJoint]:
    """Yield the joints of a robot that gz_ros2_control moves."""
    for hardware in robot.ros2_controls:
        if hardware.hardware_plugin.startswith(_OF_GAZEBO):
            yield from (joint for joint in hardware.joints if robot.has_joint(joint.name))


_OF_GAZEBO = ("gz_ros2_control/", "ign_ros2_control/")


def _common(one: Model, other: Model) -> Model:
    return tuple(name for name, _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))


def _modules_with_roots(layout: Layout) -> tuple[Mapping[str, Model], Mapping[Model, str]]:
    """Return the module of each link, and the link of each that is above all others of it.

    A module is a tree when it is read; one that is changed to be several trees counts as part of that around it.
    """
    own: dict[str, Model] = {}
    for link in layout.robot.links:
        own[link.name] = link.source.modules if link.source and not layout.is_world(link.name) else ROBOT
    roots: dict[Model, list[str]] = defaultdict(list)
    for name, module in own.items():
        joint = layout.above.get(name)
        outer = own.get(joint.parent, ROBOT) if joint else ROBOT
        for end in range(len(_common(module, outer)) + 1, len(module) + 1):
            roots[module[:end]].append(name)
    trees = {module: names[0] for module, names in roots.items() if len(names) == 1}

    def in_trees(module: Model) -> Model:
        ends = takewhile(lambda end: module[:end] in trees, range(1, len(module) + 1))
        return module[: max(ends, default=0)]

    return {name: in_trees(module) for name, module in own.items()}, trees
