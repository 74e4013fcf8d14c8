"""The words that an editor completes in a spec: the names of its robot's parts, its parameters and its modules'."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.diagnostics.suggest import suggestion_budget
from linkforge_compile.expand import Arguments, Instance, Unset, expand
from linkforge_compile.expand.instance import joint_name_of
from linkforge_compile.fresh_stack import on_fresh_stack
from linkforge_compile.listing import ListedParameter, Listing, list_parameters, list_used
from linkforge_compile.load import Loader
from linkforge_compile.lower import lower
from linkforge_compile.roots import Roots
from linkforge_compile.schema.shapes import Shape, shapes
from linkforge_compile.syntax import YamlMap, YamlScalar

Entries: TypeAlias = Mapping[str, "Sequence[str] | Entries"]
"""Names by section, as an override addresses them; those of `semantic` are a map by its own sections."""


class UsedFile(NamedTuple):
    """The parameters of a file that a spec uses as a module, the names in it, and those of its macros."""

    parameters: tuple[ListedParameter, ...] = ()
    entries: Entries = MappingProxyType({})
    macros: Mapping[str, tuple[ListedParameter, ...]] = MappingProxyType({})


@dataclass(frozen=True)
class Vocabulary:
    """The words of one spec.

    `files` are the spec and the files it includes, relative to the workspace, with `/`. `names` are final names with
    their prefixes, by kind of part, in the robot's order. `used` are the files that it uses as modules, by the text of
    `use`. `entries` are the names in the spec itself, which an override of it can address.
    `is_whole` is False if names are missing because of errors; those that depend on a parameter without a value are
    missing in any case. `has_name` is False if the spec is a part that other specs include.
    """

    files: tuple[str, ...]
    names: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    parameters: tuple[ListedParameter, ...] = ()
    used: Mapping[str, UsedFile] = field(default_factory=dict)
    entries: Entries = field(default_factory=dict)
    is_whole: bool = True
    has_name: bool = True


def read_vocabulary(
    path: Path, root: Path, packages: Mapping[str, Path] | None = None, *, runs_xacro: bool = True
) -> Vocabulary:
    """Return the words of a spec, also of one with errors; `root` is the folder of the workspace.

    `packages` are the folders of `package://`. Meshes are not read, since they declare no names. Unless `runs_xacro`,
    the names in xacro files are missing.
    """
    return on_fresh_stack(lambda: _read_vocabulary(path, root, packages or {}, runs_xacro=runs_xacro))


@suggestion_budget()
def _read_vocabulary(path: Path, root: Path, packages: Mapping[str, Path], *, runs_xacro: bool) -> Vocabulary:
    found = Vocabulary((_relative(path, root),), is_whole=False)
    sink, loader = Diagnostics(), Loader(packages, Roots.around(path, (root, *packages.values())))
    loader.runs_xacro = runs_xacro
    try:
        spec = loader.open(path, sink)
        if spec is None:
            return found
        included = (part.path for part in spec.included if part.path)
        files = dict.fromkeys((*found.files, *(_relative(part, root) for part in included)))
        own = list_parameters(spec, loader, Diagnostics()).parameters
        used = {use: _used_file(listing) for use, listing in list_used(spec, loader).items()}
        has_name = spec.tree.get("name") is not None
        found = replace(found, files=tuple(files), parameters=own, used=used, has_name=has_name)
        expanded = expand(spec, Arguments(), loader, sink, unset=Unset.NOTE)
        robot = lower(_without_meshes(expanded), sink).robot
    except BeyondLimitError:
        return found
    is_whole = robot is not None and not sink.has_errors
    names = names_by_kind(robot) if robot else {}
    return replace(found, names=names, used=_used(expanded, used), entries=entries_of(expanded), is_whole=is_whole)


def _used_file(listing: Listing) -> UsedFile:
    return UsedFile(listing.parameters, macros={name: listing.settable(name) for name in listing.macros})


def _without_meshes(instance: Instance) -> Instance:
    modules = tuple(map(_without_meshes, instance.modules))
    return replace(instance, find_mesh=lambda _path, _where, _sink: None, modules=modules)


def _used(instance: Instance, listed: Mapping[str, UsedFile]) -> dict[str, UsedFile]:
    """Return the used files with the names in each, those of the first module that could be read."""
    found = {**listed}
    for module in instance.modules:
        use = module.entry.node.child("use") if module.entry else None
        if isinstance(use, YamlScalar) and module.tree and module.entry and module.entry.node.child("macro") is None:
            one = found.setdefault(use.text, UsedFile())
            found[use.text] = one if one.entries else one._replace(entries=entries_of(module))
    return found


def entries_of(instance: Instance) -> Entries:
    """Return the names in each section of a file; for an override, a frame is a link and a joint."""
    if instance.tree is None:
        return {}
    frames = instance.tree.get("frames")
    joined = [entry for entry in frames if isinstance(entry.value, YamlMap)] if isinstance(frames, YamlMap) else []
    more = {
        "links": _without_expressions(entry.name for entry in joined),
        "joints": _without_expressions(joint_name_of(entry.name, entry.value) for entry in joined),
        "modules": _without_expressions(module.name for module in instance.modules),
    }
    names = _names_in(instance.tree, shapes().under("modules").under("").under("override"))
    return {**names, **{section: (*names.get(section, ()), *added) for section, added in more.items() if added}}


def _names_in(node: YamlMap, shape: Shape) -> dict[str, Sequence[str] | Entries]:
    """Return the names in each section of an object, and in those of the objects in it."""
    found: dict[str, Sequence[str] | Entries] = {}
    for key in shape.keys:
        section, inner = node.get(key), shape.under(key)
        if isinstance(section, YamlMap):
            is_section = inner.has_names
            own = _without_expressions(entry.name for entry in section) if is_section else _names_in(section, inner)
            found |= {key: own} if own else {}
    return found


def _without_expressions(names: Iterable[str]) -> tuple[str, ...]:
    return tuple(name for name in names if "$(" not in name)


def names_by_kind(robot: Robot) -> dict[str, tuple[str, ...]]:
    """Return the final names of a robot's parts by their kind; a sensor is one of ros2_control."""
    return {
        "link": tuple(link.name for link in robot.links),
        "joint": tuple(joint.name for joint in robot.joints),
        "material": tuple(robot.materials),
        "group": tuple(group.name for group in robot.semantic.groups),
        "sensor": tuple(sensor.name for system in robot.ros2_controls for sensor in system.sensors),
    }


def _relative(path: Path, root: Path) -> str:
    return Path(os.path.relpath(path, root)).as_posix()
