"""The files of meshes and textures on this machine, for formats whose readers do not look for packages."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from linkforge_compile.core.models.geometry import Material, Mesh
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.roots import exists

_PACKAGE = "package://"


class MeshPath(NamedTuple):
    """A mesh with the absolute path of its file, None for a file that is not found."""

    mesh: Mesh
    path: Path | None

    @property
    def resource(self) -> str:
        return self.mesh.resource


class TexturePath(NamedTuple):
    """A material with its texture and the absolute path of that, None for a file that is not found."""

    material: Material
    resource: str
    path: Path | None


def meshes_of(robot: Robot) -> Iterator[Mesh]:
    """Yield each mesh of a robot once, those of one file with different scales too, in the order of the links."""
    for mesh in dict.fromkeys(shape.geometry for link in robot.links for shape in link.shapes):
        if isinstance(mesh, Mesh):
            yield mesh


def mesh_paths(robot: Robot) -> Iterator[MeshPath]:
    """Yield each mesh of a robot with the path of its file, as `meshes_of` does."""
    for mesh in meshes_of(robot):
        yield MeshPath(mesh, find_file(robot, mesh.resource))


def texture_paths(robot: Robot) -> Iterator[TexturePath]:
    """Yield each material of a robot's visuals that has a texture once, in the order of the links."""
    for material in dict.fromkeys(visual.material for link in robot.links for visual in link.visuals):
        if material and material.texture:
            yield TexturePath(material, material.texture, find_file(robot, material.texture))


def places_of_files(robot: Robot, files: Iterable[MeshPath | TexturePath]) -> tuple[Path, ...]:
    """Return the absolute paths of files, of missing ones where they would be.

    One of a package that is not found may be in many places, and is omitted.
    """
    places = (file.path or _place_of_missing(robot, file.resource) for file in files)
    return tuple(dict.fromkeys(filter(None, places)))


def _place_of_missing(robot: Robot, resource: str) -> Path | None:
    if resource.startswith(_PACKAGE):
        package, _, inside = resource.removeprefix(_PACKAGE).partition("/")
        folder = find_file(robot, f"{_PACKAGE}{package}")
        return folder / inside if folder else None
    return Path(os.path.abspath(robot.folder / resource)) if robot.folder and is_relative(resource) else None  # noqa: PTH100


def find_file(robot: Robot, resource: str) -> Path | None:
    """Return the absolute path of a file that a robot refers to, such as a texture; None for one that is not found."""
    folder = robot.folder
    if folder and is_relative(resource) and not exists(folder / resource):
        return None  # the resolver looks in the working folder as well, where no reader of the output does
    try:
        return Path(os.path.normpath(robot.resource_resolver.resolve(resource, relative_to=folder)))
    except (OSError, ValueError):  # ValueError: a name that no file can have
        return None


def reason_not_found(robot: Robot, resource: str) -> str:
    """Return why a file that a robot refers to is not found, for a message."""
    scheme, separator, rest = resource.partition("://")
    if separator and scheme not in {"package", "file"}:
        is_of_web = scheme in {"http", "https"}
        fault = "nothing is downloaded" if is_of_web else f"files of '{scheme}://' are not looked for"
        return f"{fault}; save it next to the spec or in a package, and write that path"
    if resource.startswith(f"{_PACKAGE}/"):
        package = rest.lstrip("/").partition("/")[0]
        return f"'package:///' names no package, and RViz refuses it too; write 'package://{package}/…'"
    package = rest.partition("/")[0] if resource.startswith(_PACKAGE) else ""
    if package and find_file(robot, f"{_PACKAGE}{package}") is None:
        return f"package '{package}' is not found; specify its folder with `--package {package}=FOLDER`"
    return "the file is not found"


def is_relative(resource: str) -> bool:
    """Whether the path of a mesh starts at the folder of the file that contains it."""
    return not (resource.startswith("package:") or "://" in resource or Path(resource).is_absolute())
