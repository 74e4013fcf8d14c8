"""Write an element of a robot as an object of a spec, as the specs of its class describe it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, TypeVar

from linkforge_compile.core.fields import (
    Child,
    Children,
    Colour,
    Data,
    Flag,
    Noise,
    Number,
    Parameters,
    Pose,
    Spec,
    Vector,
    field_specs,
    key_fields,
)
from linkforge_compile.core.models.gazebo import GazeboPlugin
from linkforge_compile.core.models.geometry import Box, Color, Geometry, Mesh, Sphere, Transform, Vector3
from linkforge_compile.core.models.ros2_control import Interface, Ros2Control
from linkforge_compile.core.models.sensor import Sensor
from linkforge_compile.core.models.srdf import SemanticRobotDescription
from linkforge_compile.core.part import Element, Part
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.units import Dimension, FieldUnit, Motion

E = TypeVar("E", bound=Element)

_ZERO = Vector3(0.0, 0.0, 0.0)

_FIRST_FIELDS: Mapping[type, tuple[str, ...]] = {
    Sensor: ("type", "link_name", "origin", "update_rate", "always_on", "visualize", "topic", "frame", "plugin"),
    Ros2Control: ("type", "hardware_plugin", "parameters"),
    SemanticRobotDescription: (
        "virtual_joints",
        "groups",
        "group_states",
        "end_effectors",
        "passive_joints",
        "disabled_collisions",
        "enabled_collisions",
        "no_default_collision_links",
        "joint_properties",
    ),
}
"""Fields that a spec writes first, for classes whose constructors have another order."""


def export_element(
    builder: SpecBuilder,
    part: Element,
    motion: Motion = Motion.OTHER,
    unit: FieldUnit | None = None,
    /,
    **entries: YamlNode | None,
) -> YamlMap:
    """Return the object of an element.

    `entries` take the place of the fields with their keys; those with other keys follow. Numbers are in the units of
    `motion`, or in `unit` if they are the noise on a value.
    """
    return builder.element(part, **{**export_fields(builder, part, motion, unit, given=entries), **entries})


def export_fields(
    builder: SpecBuilder,
    part: Part,
    motion: Motion = Motion.OTHER,
    unit: FieldUnit | None = None,
    /,
    *,
    given: Mapping[str, YamlNode | None] = MappingProxyType({}),
    without: Sequence[str] = (),
) -> dict[str, YamlNode | None]:
    """Return the entries of an element by key, except the keys `without`; None for defaults, unless stated.

    Entries that are `given` take their places in the order of the class.
    """
    specs, first = field_specs(type(part)), _FIRST_FIELDS.get(type(part), ())
    stated: Sequence[str] = getattr(part, "stated", ())
    entries: dict[str, YamlNode | None] = {}
    for name in dict.fromkeys((*first, *specs)):
        spec, value = specs[name], getattr(part, name)
        if not spec.key or spec.key in without:
            continue
        is_default = not isinstance(spec, Child) and value == spec.implied and name not in stated
        if spec.key in given:
            entries[spec.key] = given[spec.key]
        elif value is None or (is_default and not builder.full):
            entries[spec.key] = None
        else:
            entries[spec.key] = _export(builder, value, spec, motion, unit)
    return entries


def _export(
    builder: SpecBuilder,
    value: Any,  # of the type that the spec annotates
    spec: Spec,
    motion: Motion,
    unit: FieldUnit | None,
) -> YamlNode | None:
    match spec:
        case Number():
            return builder.quantity(value, (unit or spec.unit).dimension(motion))
        case Vector():
            return builder.numbers(value, spec.unit.dimension(motion))
        case Flag():
            return builder.flag(value)
        case Noise():
            return export_element(builder, value, Motion.UNKNOWN, spec.unit)
        case Pose():
            return _export_pose(builder, value)
        case Colour():
            return _export_color(builder, value)
        case Children(kinds=(kind,)) if kind is Interface:
            return _export_interfaces(builder, value)
        case Children():
            return export_children(builder, value, with_origins=False)
        case Child(kinds=(kind,)) if kind is GazeboPlugin:
            return export_plugin(builder, value, is_named=True)
        case Child():
            return export_element(builder, value, motion)
        case Parameters():
            return builder.free_map(value)
        case Data():
            return builder.data(value) if value else None
    return builder.texts(value) if spec.container else builder.text(value)


def _export_pose(builder: SpecBuilder, pose: Transform) -> YamlNode | None:
    """Return `[x, y, z]` for a pose without rotation, None for the identity."""
    if not (pose.is_written or builder.full):
        return None
    entries = export_fields(builder, pose)
    if builder.full:
        return builder.element(pose, **entries)
    if pose.rpy == _ZERO and not (pose.extra_elements or pose.extra_attributes):
        return builder.numbers(pose.xyz, Dimension.LENGTH)
    return builder.element(pose, **entries)


def _export_color(builder: SpecBuilder, color: Color) -> YamlNode:
    rgba = color.to_tuple()
    numbers = builder.numbers(rgba[:3] if color.a == 1 and not builder.full else rgba)
    return builder.alone(builder.element(color, rgba=numbers), "rgba")


def _export_interfaces(builder: SpecBuilder, names: Sequence[str]) -> YamlNode | None:
    """Return a list of names, or a map where an interface has parameters or extras."""
    interfaces = [Interface.of(name) for name in names]
    if not any(one.parameters or one.extra_attributes or one.extra_elements or one.extra_inside for one in interfaces):
        return builder.texts(interfaces)
    nodes = (
        (str(one), builder.element(one, **{name: builder.free(text) for name, text in one.parameters.items()}))
        for one in interfaces
    )
    return builder.named("interface", nodes, with_origins=False)


def export_children(
    builder: SpecBuilder,
    parts: Sequence[E],
    export: Callable[[SpecBuilder, E], YamlNode] = export_element,
    *,
    with_origins: bool = True,
) -> YamlNode | None:
    """Return a map of elements by name, or by two names, or a list where they have none; None for no elements."""
    if not parts:
        return None
    kind, nodes = type(parts[0]), [_in_short_form(builder, part, export(builder, part)) for part in parts]
    names = [[str(getattr(part, field)) for field in key_fields(kind)] for part in parts]
    noun = (kind.TITLE or kind.TAG.replace("_", " ")).partition(" '")[0]
    match key_fields(kind):
        case (_, _):
            pairs = ((outer, inner, node) for (outer, inner), node in zip(names, nodes, strict=True))
            return builder.nested(noun, pairs, first_origin_only=True)
        case (_,):
            return builder.named(noun, zip((name for [name] in names), nodes, strict=True), with_origins=with_origins)
    return builder.list_of(nodes)


def _in_short_form(builder: SpecBuilder, part: Element, node: YamlNode) -> YamlNode:
    """Return the value of an object that has only the field of the short form, null if it has none."""
    short = part.SHORT_FORM
    if not (short and isinstance(node, YamlMap) and node.entries.keys() <= {short}):
        return node
    entry = node.entries.get(short)
    return builder.located(entry.value if entry else builder.word(None), part.source, short)


def export_plugin(builder: SpecBuilder, plugin: GazeboPlugin, *, is_named: bool) -> YamlMap:
    """Return a plugin, with its name if it `is_named` by no key; content that was read as XML becomes `extra`."""
    if plugin.raw_xml is not None:
        plugin = plugin.with_fields(parameters={}, extra_elements=(plugin.raw_xml, *plugin.extra_elements))
    name = {"name": builder.text(plugin.name)} if is_named else {}
    return builder.element(plugin, **name, **export_fields(builder, plugin))


def export_geometry(builder: SpecBuilder, shape: Geometry) -> dict[str, YamlNode]:
    """Return the shape of a visual or collision under its key."""
    node: YamlNode
    match shape:
        case Box():
            node = builder.alone(export_element(builder, shape), "size")
        case Sphere():
            node = builder.alone(export_element(builder, shape), "radius")
        case Mesh():
            node = builder.alone(export_element(builder, shape, scale=_scale(builder, shape)), "file")
        case _:
            node = export_element(builder, shape)
    return {str(shape.type): node}


def _scale(builder: SpecBuilder, mesh: Mesh) -> YamlNode | None:
    """Return one number for three equal ones; None for a scale that is not written."""
    scale = mesh.scale
    if builder.full:
        return builder.numbers(scale)
    if not mesh.is_scale_written:
        return None
    return builder.number(scale.x) if scale.x == scale.y == scale.z else builder.numbers(scale)
