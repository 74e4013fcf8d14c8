"""Shapes of links: mesh files that readers can load, and collisions that match the visuals."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from linkforge_compile.checks.mesh_files import MAX_WIDTH, MeshFinder, MeshShape, RobotMeshes
from linkforge_compile.core.models.geometry import Mesh, Vector3
from linkforge_compile.core.models.link import Collision, Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Code, Diagnostic, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.modules import UNSEEN_MESHES, UNSOUGHT_MESHES
from linkforge_compile.diagnostics.codes.physics import (
    CAD_MESH,
    FINE_COLLISIONS,
    HOLLOW_MESH_FILE,
    MIRRORED_COLLISIONS,
    MISSING_MESH,
    MISSPELT_PACKAGE,
    UNSEEN_COLLISIONS,
    UNTOUCHED_VISUALS,
    WIDE_MESH,
)
from linkforge_compile.diagnostics.entry_fixes import add_to_short_form
from linkforge_compile.diagnostics.grouping import SHOWN, join_names
from linkforge_compile.roots import is_folder
from linkforge_compile.source import Key

CAD_FORMATS = frozenset(
    ("step", "stp", "iges", "igs", "sldprt", "sldasm", "ipt", "iam", "catpart", "catproduct", "f3d", "3dm", "fcstd")
)
"""Endings of CAD files, which no URDF reader loads."""

MAX_SINGLE_FILES = 100
"""How many missing files of existing folders are reported one by one; the rest is reported by folder."""

FINE = 10_000
"""From so many triangles on, the mesh of a visual is a costly collision."""


def check_mesh_files(_: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A mesh file exists on this machine under exactly its name, and holds a shape.

    RViz shows a link without its mesh, and Gazebo refuses the link. A name in other capitals is found on Windows and
    macOS, and not on Linux. An empty file, the pointer that Git LFS leaves where nothing was fetched, and half of a
    binary STL hold no shape; a mesh more than 100 m wide is in millimetres: write `scale: 0.001`. Not checked are
    meshes of packages that this machine does not have, of schemes other than `package` and `file`, and outside of the
    folders that a spec may make us read. A package that is not found is reported if one with a similar name, declared
    or above the spec, has the file. Each file is reported once. The files of a missing folder are reported together,
    and so, after a hundred, are those of an existing one.
    """
    finder = meshes.finder
    missing: dict[Path, dict[str, Mesh]] = {}
    read_already = {each.mesh.resource for each in meshes.shapes if _is_read_for_inertia(each)}
    checked = [each for each in meshes.shapes if each.mesh.resource not in read_already]
    firsts: dict[tuple[str, Vector3], MeshShape] = {}
    for each in checked:
        firsts.setdefault((each.mesh.resource, each.mesh.scale), each)
    for each in firsts.values():
        path = finder.path(each.mesh.resource)
        if path and finder.names_instead_of(path) is not None:
            is_alone = len(missing) < MAX_SINGLE_FILES and is_folder(path.parent)
            together = missing.setdefault(path if is_alone else path.parent, {})
            together.setdefault(each.mesh.resource, each.mesh)
        elif diagnostic := _fault_in(meshes, each.mesh):
            yield diagnostic
    yield from _misspelt_packages(firsts.values(), finder)
    for path, by_resource in missing.items():
        yield _missing(path, by_resource.values(), finder)
    if forbidden := [each for each in checked if each.mesh.resource in finder.forbidden]:
        yield _report_meshes(forbidden, UNSEEN_MESHES, "file")
    if skipped := [each for each in checked if each.mesh.resource in finder.skipped]:
        count = len({finder.skipped[each.mesh.resource] for each in skipped})
        packages = f"{count:,} package{'s' if count > 1 else ''}"
        yield _report_meshes(skipped, UNSOUGHT_MESHES, "file", packages=packages)


def _misspelt_packages(shapes: Iterable[MeshShape], finder: MeshFinder) -> Iterator[Diagnostic]:
    """Yield one diagnostic for each package that is misspelt in the paths of meshes."""
    found: dict[tuple[str, str], dict[str, Mesh]] = {}
    for each in shapes:
        if names := finder.misspelt_package(each.mesh.resource):
            found.setdefault(names, {}).setdefault(each.mesh.resource, each.mesh)
    for (package, similar), by_resource in found.items():
        first, *others = by_resource.values()
        notes = _places_of(others, "mesh '{}' is in it, too", "and {:,} more")
        yield MISSPELT_PACKAGE.at(first.source, "file", path=first.resource, name=package, near=[similar], notes=notes)


def _places_of(meshes: Sequence[Mesh], words: str, more_words: str) -> list[Note]:
    """Return a note for each of the first meshes, and one with the number of the others."""
    shown = [(words.format(mesh.resource), mesh.source) for mesh in meshes[:SHOWN]]
    notes = [Note(message, source.at("file") if source else None) for message, source in shown]
    return [*notes, Note(more_words.format(more))] if (more := len(meshes) - SHOWN) > 0 else notes


def _missing(path: Path, meshes: Iterable[Mesh], finder: MeshFinder) -> Diagnostic:
    """Report a missing file, or once all missing files of a folder."""
    first, *others = meshes
    if is_folder(path):
        path = finder.path(first.resource) or path
    near = finder.names_instead_of(path) or ()
    notes = [Note(f"looked for it at {path}"), *_places_of(others, "nor '{}'", "and {:,} more in this folder")]
    return MISSING_MESH.at(first.source, "file", path=first.resource, name=path.name, near=near, notes=notes)


def _fault_in(meshes: RobotMeshes, mesh: Mesh) -> Diagnostic | None:
    scan, box = meshes.scan(mesh), meshes.box(mesh)
    if scan and scan.fault:
        return HOLLOW_MESH_FILE.at(mesh.source, "file", path=mesh.resource, reason=scan.fault)
    widest = max(box.sides) if box else 0.0
    if widest <= MAX_WIDTH:
        return None
    fault = WIDE_MESH.at(mesh.source, "file", path=mesh.resource, size=f"{widest:.2g}")
    return fault.with_fix(add_to_short_form(mesh.source, "file", "scale: 0.001"))


def check_mesh_formats(_: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A mesh is in a format of triangles: .stl, .dae or .obj.

    RViz, Gazebo and MoveIt load no files of CAD programs. Export the part as a mesh, in metres.
    """
    for each in meshes.shapes:
        ending = each.mesh.resource.rpartition(".")[2].lower()
        if ending in CAD_FORMATS:
            yield CAD_MESH.at(each.mesh.source, "file", path=each.mesh.resource, ending=ending)


def check_mirrored_collisions(_: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A collision mesh is not mirrored.

    A negative `scale` turns the triangles of a mesh inside out, and Gazebo Sim makes no collision of such a mesh.
    Export a mirrored mesh for the other side, or take primitive shapes. Reported once for all links.
    """
    mirrored = [each for each in meshes.shapes if isinstance(each.shape, Collision) and math.prod(each.mesh.scale) < 0]
    if mirrored:
        yield _report_meshes(mirrored, MIRRORED_COLLISIONS, "scale")


def check_fine_collisions(_: Robot, meshes: RobotMeshes) -> Iterator[Diagnostic]:
    """A collision mesh is coarser than the visual.

    Contacts cost time for each triangle. Reported once for all links whose collision is the mesh of their visual, a
    binary STL file of 10,000 triangles or more. Take primitive shapes, the convex hull, or a mesh of some hundred
    triangles.
    """
    fine: list[tuple[MeshShape, int]] = []
    seen = {(each.link.name, each.mesh) for each in meshes.shapes if not isinstance(each.shape, Collision)}
    for each in meshes.shapes:
        is_both = isinstance(each.shape, Collision) and (each.link.name, each.mesh) in seen
        scan = meshes.scan(each.mesh) if is_both else None
        if scan and scan.triangles and scan.triangles >= FINE:
            fine.append((each, scan.triangles))
    if fine:
        triangles = f"{sum(count for _, count in fine):,}"
        yield _report_meshes([each for each, _ in fine], FINE_COLLISIONS, "file", triangles=triangles)


def _report_meshes(shapes: Sequence[MeshShape], code: Code, key: str, **facts: str) -> Diagnostic:
    sources = [(each.link.name, each.mesh.source) for each in shapes[1 : SHOWN + 1]]
    notes = [Note(f"link '{name}'", source.at(key)) for name, source in sources if source]
    links = join_names(dict.fromkeys(each.link.name for each in shapes))
    return code.at(shapes[0].mesh.source, key, near=(), notes=notes, links=links, **facts)


def _is_read_for_inertia(each: MeshShape) -> bool:
    """Return whether an inertia was to be computed from the mesh, so that lowering has reported its faults."""
    link, inertial = each.link, each.link.inertial
    if link.source is None or inertial is None or each.shape not in (link.collisions or link.visuals):
        return False
    return inertial.source is None or inertial.source.node.child("inertia") is None


def check_untouched_visuals(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A link with mass and a visual has a collision.

    A link without a collision passes through everything in a simulator, and planners ignore it. Write
    `collision: visual`, or simpler shapes. Reported once for all such links; not if no link of the robot has a
    collision, nor for links without mass, which are ornaments.
    """
    if not unresolved and any(link.collisions for link in robot.links):
        for link in robot.links:
            if link.mass and link.visuals and _has_no(link, "collision"):
                yield UNTOUCHED_VISUALS.at(link.source, Key("visual"), link=link.name)


def check_unseen_collisions(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """A link with mass and a collision has a visual.

    A link with a collision and no visual stops a robot at nothing visible. Give it a visual. Reported once for all
    such links; not if no link of the robot has a visual, nor for links without mass.
    """
    if not unresolved and any(link.visuals for link in robot.links):
        for link in robot.links:
            if link.mass and link.collisions and _has_no(link, "visual"):
                yield UNSEEN_COLLISIONS.at(link.source, Key("collision"), link=link.name)


def _has_no(link: Link, key: str) -> bool:
    """Return whether a link has no shape of a kind, not even one that was dropped because of an error."""
    shapes = link.collisions if key == "collision" else link.visuals
    return not shapes and (link.source is None or link.source.node.child(key) is None)
