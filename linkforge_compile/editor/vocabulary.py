"""The words that an editor completes in a spec: the names of its robot's parts, its parameters and its modules'."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.diagnostics.suggest import suggestion_budget
from linkforge_compile.expand import (
    Arguments,
    Instance,
    Loader,
    Unset,
    expand,
)
from linkforge_compile.expand.listing import ListedParameter, list_parameters, list_used
from linkforge_compile.expand.uses import joint_name_of
from linkforge_compile.fresh_stack import on_fresh_stack
from linkforge_compile.lower import lower
from linkforge_compile.roots import Roots
from linkforge_compile.syntax import YamlEntry, YamlMap


@dataclass(frozen=True)
class Vocabulary:
    """The words of one spec.

    `files` are the spec and the files it includes, relative to the workspace, with `/`. `names` are final names with
    their prefixes, by kind of part, in the robot's order. `arguments` are the parameters of the modules that it uses,
    by the text of `use`. `entries` are the names in the spec itself, by section, which an override of it can address.
    `is_whole` is False if names are missing because of errors; those that depend on a parameter without a value are
    missing in any case. `has_name` is False if the spec is a part that other specs include.
    """

    files: tuple[str, ...]
    names: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    parameters: tuple[ListedParameter, ...] = ()
    arguments: Mapping[str, tuple[ListedParameter, ...]] = field(default_factory=dict)
    entries: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
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
        used = {use: listing.parameters for use, listing in list_used(spec, loader).items()}
        has_name = spec.tree.get("name") is not None
        found = replace(found, files=tuple(files), parameters=own, arguments=used, has_name=has_name)
        expanded = expand(spec, Arguments(), loader, sink, unset=Unset.NOTE)
        robot = lower(_without_meshes(expanded), sink).robot
    except BeyondLimitError:
        return found
    is_whole = robot is not None and not sink.has_errors
    return replace(found, names=_names(robot) if robot else {}, entries=_entries(expanded), is_whole=is_whole)


def _without_meshes(instance: Instance) -> Instance:
    modules = tuple(map(_without_meshes, instance.modules))
    return replace(instance, find_mesh=lambda _path, _where, _sink: None, modules=modules)


def _entries(instance: Instance) -> dict[str, tuple[str, ...]]:
    """Return the names in each section of a file; for an override, a frame is a link and a joint."""
    frames = _section(instance, "frames")
    names = {section: [entry.name for entry in _section(instance, section)] for section in _SECTIONS}
    names["links"] += [frame.name for frame in frames]
    names["joints"] += [joint_name_of(frame.name, frame.value) for frame in frames if isinstance(frame.value, YamlMap)]
    names["modules"] = [module.name for module in instance.modules]
    return {section: tuple(name for name in own if "$(" not in name) for section, own in names.items() if own}


_SECTIONS = ("links", "joints", "materials", "sensors", "transmissions", "ros2_control")


def _section(instance: Instance, name: str) -> tuple[YamlEntry, ...]:
    section = instance.tree.get(name) if instance.tree else None
    return tuple(section) if isinstance(section, YamlMap) else ()


def _names(robot: Robot) -> dict[str, tuple[str, ...]]:
    return {
        "link": tuple(link.name for link in robot.links),
        "joint": tuple(joint.name for joint in robot.joints),
        "material": tuple(robot.materials),
        "group": tuple(group.name for group in robot.semantic.groups),
    }


def _relative(path: Path, root: Path) -> str:
    return Path(os.path.relpath(path, root)).as_posix()
