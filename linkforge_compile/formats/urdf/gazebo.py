"""Gazebo's tags as URDF writes them: what the author wrote, and the physics of links."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from linkforge_compile.core.models.gazebo import ELEMENT_TAGS, GazeboElement, GazeboPlugin
from linkforge_compile.core.models.link import PHYSICS_TAGS, Link, LinkPhysics
from linkforge_compile.formats.element import attributes, attributes_at, elements, placed
from linkforge_compile.formats.parameters import parameter_elements
from linkforge_compile.formats.source_map import active_origins
from linkforge_compile.formats.urdf.link import says_physics
from linkforge_compile.formats.xml_text import Xml, spelled


class PluginView(NamedTuple):
    """`<plugin>`; `content` is its raw XML, or its parameters as elements."""

    attributes: Xml
    content: Xml
    elements: Xml


class GazeboView(NamedTuple):
    """`<gazebo>`; `tags` are names and texts of the children that the model has fields for."""

    attributes: Xml
    tags: tuple[tuple[str, str], ...]
    properties: Xml
    plugins: tuple[PluginView, ...]
    elements: Xml


def physics_views(links: Iterable[Link]) -> tuple[GazeboView, ...]:
    """Return a block for each link whose physics say something, with what they say."""
    return tuple(
        GazeboView(
            attributes_at(link.physics.source, reference=link.name), _physics_tags(link.physics), Xml(), (), Xml()
        )
        for link in links
        if says_physics(link)
    )


def gazebo_views(blocks: Iterable[GazeboElement]) -> tuple[GazeboView, ...]:
    return tuple(
        GazeboView(
            attributes(block, reference=block.reference),
            tuple(
                (tag, placed(spelled(value), block.source, name))
                for name, tag in ELEMENT_TAGS.items()
                if (value := getattr(block, name)) is not None
            ),
            _properties(block),
            tuple(map(plugin_view, block.plugins)),
            elements(block),
        )
        for block in blocks
    )


def plugin_view(plugin: GazeboPlugin) -> PluginView:
    return PluginView(
        attributes(plugin, name=plugin.name, filename=plugin.filename), _parameters(plugin), elements(plugin)
    )


def _parameters(plugin: GazeboPlugin) -> Xml:
    if plugin.raw_xml is None:
        return parameter_elements(plugin.parameters, plugin.source, "parameters")
    from linkforge_compile.formats.raw import raw_elements

    return raw_elements(plugin.raw_xml)


def _properties(block: GazeboElement) -> Xml:
    if not active_origins():
        return parameter_elements(block.properties)
    # Tags of Gazebo that are keys of the language stand in the block itself, others in its `properties`.
    own = block.source.node if block.source else None
    return Xml(
        "\n".join(
            parameter_elements({tag: part}, block.source, *(() if own and own.child(tag) else ("properties",)))
            for tag, part in block.properties.items()
        )
    )


def _physics_tags(physics: LinkPhysics) -> tuple[tuple[str, str], ...]:
    return tuple(
        (tag, placed(spelled(getattr(physics, name)), physics.source, name))
        for name, tag in PHYSICS_TAGS.items()
        if physics.is_written(name)
    )
