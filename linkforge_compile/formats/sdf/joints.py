"""Joints in SDF, and the frames that fixed joints of links without mass, floating and planar ones become."""

from __future__ import annotations

from collections.abc import Sequence

from linkforge_compile.core.models.joint import AXES, Joint, JointType
from linkforge_compile.formats.element import attributes_at
from linkforge_compile.formats.kinematic_tree import WORLD
from linkforge_compile.formats.sdf.elements import parent, pose, text
from linkforge_compile.formats.sdf.layout import MODEL, Layout
from linkforge_compile.formats.sdf.models import Models
from linkforge_compile.formats.sdf.settings import Settings, joint_physics, spring_elements
from linkforge_compile.formats.views import View
from linkforge_compile.formats.xml_text import NOTHING, Xml

_TYPES = {JointType.CONTINUOUS: "revolute"}


def joint_view(
    joint: Joint, layout: Layout, models: Models, settings: Settings, sensors: Sequence[View], *, has_mimic: bool
) -> View:
    """Return a joint; its frame is that of its child, as in URDF, so that the axis has the same numbers."""
    is_on_world, model = layout.is_world(joint.parent), models.of_joint(joint)
    above = models.link_in(model, joint.parent)
    return View(
        attributes=attributes_at(
            joint.source, name=layout.joint_names[joint.name], type=_TYPES.get(joint.type, joint.type)
        ),
        pose=pose(joint.origin, relative_to=MODEL if is_on_world else above),
        parent=text("parent", WORLD if is_on_world else above, joint.source, "parent"),
        child=text("child", models.link_in(model, joint.child), joint.source, "child"),
        axis=NOTHING if joint.type == JointType.FIXED else _axis(joint, models, settings, has_mimic=has_mimic),
        physics=joint_physics(settings),
        sensors=sensors,
    )


def _axis(joint: Joint, models: Models, settings: Settings, *, has_mimic: bool) -> Xml:
    """Return an axis; a missing limit is 0, as to URDF readers, and a continuous joint has none."""
    limits, dynamics, source = joint.limits, joint.dynamics, joint.source
    of_limits: list[Xml] = []
    if limits:
        if joint.type != JointType.CONTINUOUS:
            of_limits.append(text("lower", limits.lower or 0.0, limits.source, "lower"))
            of_limits.append(text("upper", limits.upper or 0.0, limits.source, "upper"))
        of_limits.append(text("effort", limits.effort, limits.source, "effort"))
        of_limits.append(text("velocity", limits.velocity, limits.source, "velocity"))
    of_dynamics = list(spring_elements(settings))
    if dynamics:
        of_dynamics.append(text("damping", dynamics.damping, dynamics.source, "damping"))
        of_dynamics.append(text("friction", dynamics.friction, dynamics.source, "friction"))
    return parent(
        "axis",
        text("xyz", joint.axis or AXES["x"], source, "axis"),
        parent("limit", *of_limits),
        parent("dynamics", *of_dynamics),
        _mimic(joint, models) if has_mimic else NOTHING,
    )


def _mimic(joint: Joint, models: Models) -> Xml:
    mimic = joint.mimic
    if mimic is None or (leader := models.leader(joint)) is None:
        return NOTHING
    source = mimic.source
    inner = (
        text("multiplier", mimic.multiplier, source, "multiplier"),
        text("offset", mimic.offset, source, "offset"),
        text("reference", 0.0, source),
    )
    return Xml(f"<mimic{attributes_at(source, joint=leader)}>{''.join(inner)}</mimic>")


def joint_frame(joint: Joint, layout: Layout, models: Models) -> Xml:
    """Return the frame of a joint that is none in SDF."""
    is_on_world = layout.is_world(joint.parent)
    attached_to = None if is_on_world else models.link_in(models.of_joint(joint), joint.parent)
    attributes = attributes_at(joint.source, name=layout.joint_names[joint.name], attached_to=attached_to)
    return Xml(f"<frame{attributes}>{pose(joint.origin)}</frame>")


def link_frame(name: str, layout: Layout, models: Models) -> Xml:
    """Return the frame of a link without a body: at its joint, and on what carries it if that is below it."""
    link, joint, model = layout.robot.links[name], layout.above.get(name), models.of_link(name)
    if name in layout.carriers:
        attributes = attributes_at(link.source, name=name, attached_to=layout.carriers[name])
        return Xml(f"<frame{attributes}>{models.place(name, model, is_frame=True)}</frame>")
    where = layout.joint_names[joint.name] if joint else MODEL
    return Xml(f"<frame{attributes_at(link.source, name=name, attached_to=where)}/>")
