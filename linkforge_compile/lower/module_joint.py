"""The joint between a module and the link that it hangs on, as the module's entry says it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.model import JOINT_WITHOUT_PARENT
from linkforge_compile.expand.assembly import Instance, joint_name_of
from linkforge_compile.lower.elements import lower_origin
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.joint import JointEnds, joint_between
from linkforge_compile.syntax.nodes import YamlMap, YamlScalar

if TYPE_CHECKING:
    from linkforge_compile.core.models.gazebo import GazeboElement


class ModuleJoint(NamedTuple):
    """The name of a module's joint, the joint, None where it is lost, and what a simulator is told about it."""

    name: str
    joint: Joint | None
    gazebo: tuple[GazeboElement, ...] = ()


def module_fields(module: Instance, sink: Diagnostics) -> Fields | None:
    """Return the entry of `modules` that a module was used by, None for the compiled file itself."""
    entry = module.entry
    if entry is None or not isinstance(entry.node, YamlMap):
        return None
    return Fields(entry.node, f"module '{module.name}'", sink, entry.trail, entry.key)


def lower_module_joint(module: Instance, root: str | None, sink: Diagnostics) -> ModuleJoint | None:
    """Lower the joint from a module's `parent` to its root link (final name; None where it has no single one).

    Returns None for a module without `parent`, which is the base of the robot that uses it; one that says all the
    same how it hangs lost its joint.
    """
    written = module_fields(module, sink)
    if written is None:
        return None
    if written.node.get("parent") is None:
        said = [(field, node) for field in ("joint", "origin") if (node := written.node.get(field)) is not None]
        for field, node in said:
            written.report(JOINT_WITHOUT_PARENT, node, owner=written.owner, field=field)
        return ModuleJoint(joint_name_of(module.name, written.node), None) if said else None
    default = f"{module.name}_joint"
    name = _name(written, default)
    joint = _as_joint(written, name or default)
    joint_type = JointType.FIXED if joint.node.get("type") is None else joint.choice("type", JointType)
    ends = JointEnds(joint.text("parent"), root, lower_origin(joint))
    return ModuleJoint(name or default, joint_between(joint, name, joint_type, ends), gazebo_of(joint, name or default))


def gazebo_of(joint: Fields, name: str) -> tuple[GazeboElement, ...]:
    """Lower what a simulator is told of a joint that stands in no section of joints."""
    if joint.node.get("gazebo") is None:
        return ()
    from linkforge_compile.lower.gazebo import lower_gazebo

    return tuple(lower_gazebo(joint, name, {name: joint.node}))


def _name(module: Fields, default: str) -> str | None:
    """Read the joint's name: `joint` itself, or `name` in it; None where its fault has been told."""
    said = module.node.get("joint")
    if isinstance(said, YamlMap):
        joint = module.map_at(said, "joint")
        if joint and said.get("name") is not None:
            return joint.name("name", "joint")
    elif said is not None:
        return module.name("joint", "joint")
    return default if module.name_is_valid(default, "joint") else None


def _as_joint(module: Fields, name: str) -> Fields:
    """Return the entry as if its joint stood among the joints: what `joint` says, with `parent` and `origin`."""
    said = module.node.get("joint")
    fields = said.entries if isinstance(said, YamlMap) else {}
    ends = {key: entry for key in ("parent", "origin") if (entry := module.node.entries.get(key))}
    named = said if isinstance(said, YamlScalar) else said and said.child("name")
    node = YamlMap({**fields, **ends}, module.node.span)
    return Fields(node, f"joint '{name}'", module.sink, module.trail, named or module.key)
