"""Relative paths of meshes, which are relative to the output, wherever that is written."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from linkforge_compile.core.models.geometry import Mesh
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Code, Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import MESH_BESIDE_THE_SPEC
from linkforge_compile.formats import Options, format_named
from linkforge_compile.formats.mesh_paths import is_relative

_SHOWN = 3


def check_relative_mesh_paths(
    robot: Robot,
    folder: Path,
    code: Code = MESH_BESIDE_THE_SPEC,
    *,
    start: Path | None = None,
    document: str = "URDF",
    may_move: bool = True,
) -> Iterator[Diagnostic]:
    """Yield one warning about relative paths of meshes that exist next to the robot's file but not from `folder`.

    `folder` is where the other file with the same paths is written: the `document` of a spec, or the spec of a URDF, by
    `code`. A mesh that is in neither place is reported as missing elsewhere. `start` is where the paths of a robot
    without a file start, None if that is not known. `may_move` is whether the other file may be written elsewhere.
    """
    start = robot.folder or start
    if start is None:
        return
    missing = [
        mesh
        for path, mesh in _relative_meshes(robot).items()
        if _is_file(start / path) and not _is_beside(folder, path)
    ]
    if missing:
        first, *others = missing
        notes = [Note(f"nor '{mesh.resource}'", mesh.source.at("file") if mesh.source else None) for mesh in others]
        more = [Note(f"nor {len(others) - _SHOWN} more")] if len(others) > _SHOWN else []
        back = Path(os.path.relpath(start)).as_posix()
        elsewhere = f", or the {document} into '{back}'" if may_move else ""
        facts = {"path": first.resource, "folder": folder.as_posix(), "document": document, "elsewhere": elsewhere}
        yield code.at(first.source, "file", notes=notes[:_SHOWN] + more, **facts)


def check_mesh_paths_of_formats(
    robot: Robot, folders: Mapping[str, Path], options: Options, *, start: Path | None
) -> Iterator[Diagnostic]:
    """Check the paths for each folder, by the name of the format, in which a document has them; once for one folder."""
    checked = set[Path]()
    for name, folder in folders.items():
        one = format_named(name)
        if folder not in checked and one.keeps_relative_paths(robot, options):
            checked.add(folder)
            document = Path(one.files[0] if one.files else f"NAME{one.suffix}").suffix.removeprefix(".").upper()
            yield from check_relative_mesh_paths(robot, folder, start=start, document=document, may_move=not one.files)


def _relative_meshes(robot: Robot) -> dict[str, Mesh]:
    links = robot.links
    geometries = [visual.geometry for link in links for visual in link.visuals]
    geometries += [collision.geometry for link in links for collision in link.collisions]
    meshes = (geometry for geometry in geometries if isinstance(geometry, Mesh))
    first: dict[str, Mesh] = {}
    for mesh in (mesh for mesh in meshes if is_relative(mesh.resource)):
        first.setdefault(mesh.resource, mesh)
    return first


def _is_beside(folder: Path, path: str) -> bool:
    # Joined as text: before the folder is made, the file system leads nowhere from it, not even by `..`.
    return _is_file(Path(os.path.normpath(os.path.realpath(folder) + os.sep + path)))


def _is_file(path: Path) -> bool:
    # os.path answers for names that no file can have, where pathlib raises.
    return os.path.isfile(path)  # noqa: PTH113
