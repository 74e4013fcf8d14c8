"""The robot that the page draws, as plain values for JSON; `page/src/scene.ts` has the same types.

All numbers are SI. A pose is in the frame of its parent, as in URDF, and a quaternion is [x, y, z, w].
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NotRequired, TypeAlias, TypedDict

from linkforge_compile.core.models.geometry import Box, Capsule, Cylinder, Material, Mesh, Sphere, Transform
from linkforge_compile.core.models.link import Collision, Visual
from linkforge_compile.core.poses import Pose
from linkforge_compile.formats.kinematic_tree import KinematicTree

if TYPE_CHECKING:
    from linkforge_compile.core.models.joint import Joint
    from linkforge_compile.core.models.link import Inertial, Link
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.source import SourceRef, Span
    from linkforge_compile.view.files import MissingFile, RobotFiles

Numbers: TypeAlias = Sequence[float]


class ScenePlace(TypedDict):
    """Where a part is written; `file` is the name in diagnostics."""

    file: str
    line: int
    column: int


class ScenePose(TypedDict):
    xyz: Numbers
    quaternion: Numbers


class SceneShape(TypedDict):
    """A visual or a collision; `size`, `radius` and `length` are full extents [m].

    `file` is the digest of a mesh, None for a missing one. `color` has the numbers of URDF, which are sRGB.
    """

    type: str
    origin: ScenePose
    name: NotRequired[str]
    size: NotRequired[Numbers]
    radius: NotRequired[float]
    length: NotRequired[float]
    file: NotRequired[str | None]
    scale: NotRequired[Numbers]
    color: NotRequired[Numbers]
    texture: NotRequired[str]


class SceneInertia(TypedDict):
    """The tensor ixx, iyy, izz, ixy, ixz, iyz about the centre of mass, in the axes of `origin` [kg·m²]."""

    origin: ScenePose
    moments: Numbers


class SceneLink(TypedDict):
    """A link; `parent` is the joint above it, and `module` the names of the modules that it is in: `left/arm`."""

    name: str
    parent: str | None
    mass: float | None
    center: Numbers | None
    inertia: SceneInertia | None
    visuals: list[SceneShape]
    collisions: list[SceneShape]
    source: ScenePlace | None
    module: str


class SceneMimic(TypedDict):
    joint: str
    multiplier: float
    offset: float


class SceneJoint(TypedDict):
    """A joint; `lower` and `upper` are None without limits of the position, and `value` is where it starts."""

    name: str
    type: str
    parent: str
    child: str
    origin: ScenePose
    axis: Numbers | None
    lower: float | None
    upper: float | None
    velocity: float | None
    effort: float | None
    mimic: SceneMimic | None
    value: float
    source: ScenePlace | None
    module: str


class SceneState(TypedDict):
    """A state of a group; each joint has as many numbers as degrees of freedom."""

    name: str
    group: str
    positions: dict[str, Numbers]


class SceneFile(TypedDict):
    """A file; `data` is its content in base64 where the page holds it, and `uses` the files that it names.

    `links` are those whose shapes name it, and `source` is the first place that does.
    """

    name: str
    kind: str
    size: int
    links: NotRequired[Sequence[str]]
    source: NotRequired[ScenePlace | None]
    data: NotRequired[str]
    uses: NotRequired[Mapping[str, str]]


class SceneMissing(TypedDict):
    """A file that is not shown, the reason, and the links that have it."""

    file: str
    reason: str
    links: Sequence[str]
    source: ScenePlace | None


class SceneCamera(TypedDict):
    """The camera: its angles [deg], azimuth from x to y; without `distance` the whole robot is visible."""

    azimuth: float
    elevation: float
    distance: NotRequired[float]
    target: NotRequired[Numbers]


class SceneView(TypedDict):
    """What the page shows first: positions of joints, the camera, layers, and whether there are panels."""

    pose: NotRequired[Mapping[str, float]]
    camera: NotRequired[SceneCamera]
    layers: NotRequired[Sequence[str]]
    panels: bool


class SceneDifference(TypedDict):
    """A difference from the robot before: what `linkforge diff` prints, and the link at which it is shown."""

    kind: str
    path: str
    text: str
    link: str | None
    is_whole: bool


class SceneRemoved(TypedDict):
    """Removed names that others may rely on, in a line: `kind` is what they name."""

    kind: str
    text: str


class SceneComparison(TypedDict):
    """The old robot, over which the new one is shown.

    `labels` are the names of both in headings. `kinds` has what happened to a link, by its name in the new robot, or
    in the old one for a removed link. `links` and `joints` are new names by old ones. The files are with those of the
    new robot.
    """

    before: Scene
    labels: tuple[str, str]
    differences: Sequence[SceneDifference]
    removed: Sequence[SceneRemoved]
    kinds: Mapping[str, str]
    links: Mapping[str, str]
    joints: Mapping[str, str]


class Scene(TypedDict):
    """Everything that the page draws; a joint comes after the joint above it, and `files` are by digest.

    `version` is that of a live viewer in which the scene was new.
    """

    name: str
    links: list[SceneLink]
    joints: list[SceneJoint]
    states: list[SceneState]
    files: dict[str, SceneFile]
    missing: list[SceneMissing]
    view: SceneView
    live: bool
    version: NotRequired[int]
    comparison: NotRequired[SceneComparison]


def make_scene(robot: Robot, files: RobotFiles, view: SceneView | None = None, *, is_live: bool = False) -> Scene:
    """Return the scene of a robot with the files of its shapes, which are those of `collect_files`.

    A second joint to the same link is omitted. The links of a cycle, which no root leads to, are roots.
    """
    tree = KinematicTree.of(robot)
    held = {node.link.name for node in tree.nodes}
    links = [_link(node.link, node.joint, files.digests) for node in tree.nodes]
    links += [_link(link, None, files.digests) for link in robot.links if link.name not in held]
    return {
        "name": robot.name,
        "links": links,
        "joints": [_joint(node.joint) for node in tree.nodes if node.joint],
        "states": list(_states(robot)),
        "files": {digest: _file(files, digest) for digest in files.files},
        "missing": [_missing(one) for one in files.missing],
        "view": view or {"panels": True},
        "live": is_live,
    }


def _link(link: Link, above: Joint | None, digests: Mapping[str, str]) -> SceneLink:
    inertial = link.inertial
    return {
        "name": link.name,
        "parent": above.name if above else None,
        "mass": inertial.mass if inertial else None,
        "center": inertial.origin.xyz.to_tuple() if inertial else None,
        "inertia": _inertia(inertial) if inertial else None,
        "visuals": [_shape(visual, digests) for visual in link.visuals],
        "collisions": [_shape(collision, digests) for collision in link.collisions],
        "source": _place(link.source),
        "module": _module(link.source),
    }


def _inertia(inertial: Inertial) -> SceneInertia:
    tensor = inertial.inertia
    moments = (tensor.ixx, tensor.iyy, tensor.izz, tensor.ixy, tensor.ixz, tensor.iyz)
    return {"origin": _pose(inertial.origin), "moments": moments}


def _joint(joint: Joint) -> SceneJoint:
    lower, upper = joint.bounds or (None, None)
    mimic = joint.mimic
    return {
        "name": joint.name,
        "type": joint.type,
        "parent": joint.parent,
        "child": joint.child,
        "origin": _pose(joint.origin),
        "axis": joint.axis.to_tuple() if joint.axis else None,
        "lower": lower,
        "upper": upper,
        "velocity": joint.limits.velocity if joint.limits else None,
        "effort": joint.limits.effort if joint.limits else None,
        "mimic": {"joint": mimic.joint, "multiplier": mimic.multiplier, "offset": mimic.offset} if mimic else None,
        "value": joint.default_position,
        "source": _place(joint.source),
        "module": _module(joint.source),
    }


def _shape(shape: Visual | Collision, digests: Mapping[str, str]) -> SceneShape:
    made: SceneShape = {"type": shape.geometry.TAG, "origin": _pose(shape.origin)}
    match shape.geometry:
        case Box(size=size):
            made["size"] = size.to_tuple()
        case Sphere(radius=radius):
            made["radius"] = radius
        case Cylinder(radius=radius, length=length) | Capsule(radius=radius, length=length):
            made["radius"], made["length"] = radius, length
        case Mesh(resource=resource, scale=scale):
            made["file"], made["scale"] = digests.get(resource), scale.to_tuple()
    if shape.name:
        made["name"] = shape.name
    if isinstance(shape, Visual) and shape.material:
        _add_material(made, shape.material, digests)
    return made


def _add_material(shape: SceneShape, material: Material, digests: Mapping[str, str]) -> None:
    if material.color:
        shape["color"] = material.color.to_tuple()
    if texture := digests.get(material.texture or ""):
        shape["texture"] = texture


def _states(robot: Robot) -> Iterator[SceneState]:
    for state in robot.semantic.group_states if robot.has_semantic else ():
        values = {joint: _numbers(values) for joint, values in state.joint_values.items()}
        yield {"name": state.name, "group": state.group, "positions": values}


def _numbers(values: Sequence[object]) -> Numbers:
    return [float(value) for value in values if isinstance(value, int | float)]


def _file(files: RobotFiles, digest: str) -> SceneFile:
    file = files.files[digest]
    made: SceneFile = {"name": file.name, "kind": file.kind, "size": len(file.content)}
    if use := files.users.get(digest):
        made |= {"links": use.links, "source": _place_at(use.place)}
    if file.uses:
        made["uses"] = file.uses
    return made


def _missing(missing: MissingFile) -> SceneMissing:
    links, place = missing.use.links, _place_at(missing.use.place)
    return {"file": missing.resource, "reason": missing.reason, "links": links, "source": place}


def _pose(origin: Transform) -> ScenePose:
    pose = Pose.of(origin)
    return {"xyz": pose.xyz, "quaternion": pose.turn}


def _place(source: SourceRef | None) -> ScenePlace | None:
    return _place_at(source.span if source else None)


def _place_at(span: Span | None) -> ScenePlace | None:
    return {"file": span.file.shown, "line": span.line, "column": span.column} if span else None


def _module(source: SourceRef | None) -> str:
    return "/".join(source.modules) if source else ""
