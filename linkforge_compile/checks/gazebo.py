"""Gazebo's reading of URDF: links that it merges or drops, and blocks and tags that it loses with them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import takewhile
from typing import NamedTuple

from linkforge_compile.checks.names import Reference
from linkforge_compile.checks.tree import child_reference
from linkforge_compile.core.constants import WORLD
from linkforge_compile.core.models.gazebo import BLOCK_THAT_KEEPS_JOINT, KEEP_FIXED_JOINT, GazeboElement
from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_down, walk_up
from linkforge_compile.core.models.joint import Joint, JointType
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.part import FreePart
from linkforge_compile.diagnostics import Diagnostic, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.model import TAG_OF_TWO_BLOCKS
from linkforge_compile.diagnostics.codes.physics import (
    BLOCK_OF_MERGED_JOINT,
    MASSLESS_BODY,
    MASSLESS_ROOT,
    MERGED_LINK_NAMED,
    TINY_MASS,
)
from linkforge_compile.diagnostics.entry_fixes import add_entry
from linkforge_compile.diagnostics.grouping import SHOWN, join_names
from linkforge_compile.source import SourceRef
from linkforge_compile.units import number_text

NEGLIGIBLE_MASS = 1e-6
"""A mass that Gazebo treats as none [kg]."""

LOOKS_UP_A_LINK = frozenset(("link_name", "linkName", "body_name", "parent_link"))
"""The tags by which plugins name a link that they search for in the simulation."""


def check_massless_bodies(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A link that a joint moves has mass, if a link below it has; and so has the root.

    A link without mass is a frame, and normal. But Gazebo leaves out a link that moves, or is the root, and has no
    mass, nor anything fixed to it that has, and with it all that hangs below. Give it, or a link that is fixed to it,
    an `inertial`; or make its joint fixed. A root named `world` is Gazebo's own. Reported for the first link of a
    chain, with the joints that are dropped; for the root only if the robot has Gazebo blocks or sensors. Not checked
    while part of the robot could not be read.
    """
    if unresolved:
        return
    above = parent_joints(robot.joints)
    weights = _merged_weights(robot, above)
    if all(weights.values()):
        return
    below, loaded = child_joints(robot.joints), _links_that_carry_mass(robot, above)
    is_for_gazebo = bool(robot.gazebo_elements or robot.sensors)
    roots = [link.name for link in robot.links if link.name not in above]
    dropped: set[str] = set()
    for name in (*roots, *(joint.child for joint in walk_down(roots, child_joints(above.values())))):
        joint = above.get(name)
        if joint and joint.parent in dropped:
            dropped.add(name)
        elif name in loaded and weights.get(name, 1.0) == 0 and (joint or is_for_gazebo) and name != WORLD:
            dropped.add(name)
            moving = [one for one in walk_down([name], below) if one.type != JointType.FIXED]
            yield _report_dropped(robot.links[name], joint, moving)


def _report_dropped(link: Link, joint: Joint | None, moving: Sequence[Joint]) -> Diagnostic:
    also = f", joint{'s' if len(moving) > 1 else ''} {join_names([one.name for one in moving])} too" if moving else ""
    notes = [child_reference(one).note(f"joint '{one.name}' is lost") for one in moving[:SHOWN]]
    if joint is None:
        return MASSLESS_ROOT.at(link.source, "inertial", "mass", link=link.name, also=also, notes=notes)
    where = ("inertial", "mass")
    return MASSLESS_BODY.at(link.source, *where, joint=joint.name, link=link.name, also=also, notes=notes)


def check_tiny_masses(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A link that a joint moves, with all links fixed to it, weighs more than a milligram.

    Gazebo treats 1e-6 kg and less as no mass and drops the link, with its joint and all that hangs below.
    Write a mass that a solver can handle next to those of its neighbours, or make the joint fixed.
    """
    if unresolved:
        return
    above = parent_joints(robot.joints)
    for name, weight in _merged_weights(robot, above).items():
        if 0 < weight <= NEGLIGIBLE_MASS and name in above:
            link = robot.links[name]
            mass = f"{weight:g}"
            yield TINY_MASS.at(link.source, "inertial", "mass", joint=above[name].name, link=name, mass=mass)


def check_merged_joints(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A Gazebo block is about a joint that Gazebo keeps.

    It merges the links of a fixed joint into one, and the settings for the joint are lost with it. Write
    `preserveFixedJoint: true` in the block, or remove the block.
    """
    merged = {joint.name for joint in _merged_joints(robot)} if robot.gazebo_elements else set()
    for block in robot.gazebo_elements:
        if block.reference in merged and block.reference not in robot.links and _has_settings(block):
            fault = BLOCK_OF_MERGED_JOINT.at(block.source, joint=block.reference)
            yield fault.with_fix(add_entry(block.source, entry="preserveFixedJoint: true"))


def check_merged_links(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """A link that a Gazebo plugin names is one that Gazebo keeps.

    It merges the child of a fixed joint into the link above, and a plugin that searches for it by name finds
    nothing. Name the link above, or write `preserveFixedJoint: true` in the `gazebo` of the joint.
    """
    plugins = [(block, plugin) for block in robot.gazebo_elements for plugin in block.plugins]
    merged = {joint.child: joint for joint in _merged_joints(robot)} if plugins else {}
    for block, plugin in plugins if merged else ():
        for path, name in _named_links(plugin.parameters):
            if joint := merged.get(name):
                ref = Reference(name, f"plugin '{plugin.name}'", plugin.source or block.source, ("parameters", *path))
                fault = ref.report(MERGED_LINK_NAMED, link=name, parent=joint.parent, joint=joint.name)
                yield fault.with_fix(add_entry(joint.source, entry=BLOCK_THAT_KEEPS_JOINT, after="type"))


class _Tag(NamedTuple):
    """A tag of Gazebo that holds one value: the link or joint that it applies to, and the field where it is written.

    `scope` is the object in which lowering has already reported a second tag of the same name.
    """

    reference: str
    name: str
    text: str
    source: SourceRef | None
    path: tuple[str, ...]
    scope: SourceRef | None

    def has_value_of(self, other: _Tag) -> bool:
        """Return whether Gazebo reads the same value from both."""
        return _as_gazebo_reads(self.text) == _as_gazebo_reads(other.text)

    def is_reported_with(self, first: _Tag) -> bool:
        whole = first.scope.node.span if first.scope else None
        return whole is not None and self.source is not None and self.source.node.span.lies_in(whole)


def check_tags_of_several_blocks(robot: Robot, _: UnresolvedNames) -> Iterator[Diagnostic]:
    """The Gazebo blocks of a link or joint, and a link's `physics`, do not contradict one another.

    Of a tag in two of them Gazebo uses the last one, with a line in its log at best. Write it once.
    """
    if not robot.gazebo_elements:
        return
    first_tags: dict[tuple[str, str], _Tag] = {}
    for tag in (*_tags_of_physics(robot), *_tags_of_blocks(robot)):
        first = first_tags.setdefault((tag.reference, tag.name), tag)
        if first is not tag and not tag.has_value_of(first) and not tag.is_reported_with(first):
            notes = [Note("the other block is here", first.source.at(*first.path))] if first.source else []
            facts = {"tag": tag.name, "owner": tag.reference, "found": tag.text, "first": first.text}
            yield TAG_OF_TWO_BLOCKS.at(tag.source, *tag.path, notes=notes, **facts)


def _tags_of_physics(robot: Robot) -> Iterator[_Tag]:
    """Yield the tags that the `physics` of links with blocks write."""
    from linkforge_compile.core.models.link import PHYSICS_TAGS

    with_blocks = {block.reference for block in robot.gazebo_elements}
    for link in [link for link in robot.links if link.name in with_blocks]:
        physics = link.physics
        for field, tag in PHYSICS_TAGS.items():
            if physics.is_written(field):
                yield _Tag(link.name, tag, _text(getattr(physics, field)), physics.source, (field,), link.source)


def _tags_of_blocks(robot: Robot) -> Iterator[_Tag]:
    """Yield the tags of the blocks that hold a value; one that holds elements, such as a sensor, may occur twice."""
    from linkforge_compile.core.models.gazebo import ELEMENT_TAGS

    for block in robot.gazebo_elements:
        about, source = block.reference, block.source
        if about is None:
            continue
        for field, tag in ELEMENT_TAGS.items():
            if (value := getattr(block, field)) is not None:
                yield _Tag(about, tag, _text(value), source, (field,), source)
        for tag, text in block.properties.items():
            is_key = source is not None and source.node.child(tag) is not None
            if isinstance(text, str):
                yield _Tag(about, tag, text, source, (tag,) if is_key else ("properties", tag), source)


def _text(value: str | bool | float) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return value if isinstance(value, str) else number_text(value)


def _as_gazebo_reads(text: str) -> str | float:
    """Return a number for the text of a number or boolean, to compare them: '1', '1.0' and 'true' are equal."""
    word = text.strip().lower()
    try:
        return _TRUTHS[word] if word in _TRUTHS else float(word)
    except ValueError:
        return text.strip()


_TRUTHS = {"true": 1.0, "yes": 1.0, "false": 0.0, "no": 0.0}


def _merged_joints(robot: Robot) -> Sequence[Joint]:
    """Return the fixed joints that no block keeps."""
    fixed = [joint for joint in robot.joints if joint.type == JointType.FIXED and joint.parent != WORLD]
    names = {joint.name for joint in fixed}
    blocks = [block for block in robot.gazebo_elements if block.reference in names]
    if not blocks:
        return fixed
    from linkforge_compile.core.models.gazebo import keeps_fixed_joint

    kept = {block.reference for block in blocks if keeps_fixed_joint([block])}
    return [joint for joint in fixed if joint.name not in kept]


def _merged_weights(robot: Robot, above: Mapping[str, Joint]) -> Mapping[str, float]:
    """Return the mass of each link that stays, together with all that is merged into it [kg]."""
    into = {joint.child: joint.parent for joint in _merged_joints(robot) if above[joint.child] is joint}
    weights = {link.name: 0.0 for link in robot.links if link.name not in into}
    for link in robot.links:
        *way, end = walk_up(link.name, into)
        into.update(dict.fromkeys(way, end))  # so that a chain is walked once
        if end in weights:
            weights[end] += link.mass
    return weights


def _links_that_carry_mass(robot: Robot, above: Mapping[str, Joint]) -> set[str]:
    """Return the links that have mass and all those above them."""
    parents = {name: joint.parent for name, joint in above.items()}
    carriers: set[str] = set()
    for link in robot.links:
        if link.mass:
            carriers.update(takewhile(lambda name: name not in carriers, walk_up(link.name, parents)))
    return carriers


def _has_settings(block: GazeboElement) -> bool:
    """Return whether a block holds more than whether to keep its joint."""
    fields = (block.material, block.static, block.stop_cfm, block.stop_erp, block.provide_feedback)
    is_more = any(field is not None for field in (*fields, block.implicit_spring_damper))
    return is_more or bool(block.plugins or block.extra_elements or block.properties.keys() - {*KEEP_FIXED_JOINT})


def _named_links(part: FreePart) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield the names of links that plugins search for, each with its path."""
    if isinstance(part, Mapping):
        for tag, inner in part.items():
            if isinstance(inner, str):
                if tag in LOOKS_UP_A_LINK:
                    yield (tag,), inner.strip()
            else:
                yield from (((tag, *path), name) for path, name in _named_links(inner))
    elif isinstance(part, tuple):
        for place, inner in enumerate(part):
            yield from (((place, *path), name) for path, name in _named_links(inner))
