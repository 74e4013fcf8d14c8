"""Locate what the paths in a spec name, and write paths relative to another file."""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple, TypeAlias

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import NOT_A_SPEC, USE_OF_NOWHERE
from linkforge_compile.limits import MAX_FILE_BYTES
from linkforge_compile.load.loader import ImportSite, Loader, SpecFile
from linkforge_compile.paths import Package, find_package, follow, split_package_path, unknown_package
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import UnreadableError
from linkforge_compile.source.read_file import read_bytes
from linkforge_compile.source.xacro_content import find_xacro

SPEC_ENDINGS = (".yaml", ".yml")
_URDF_ENDING = ".urdf"
XACRO = ".xacro"
_XML_OF_ROBOTS = (_URDF_ENDING, ".srdf")
_SCHEME = re.compile(r"([A-Za-z][\w+.-]+)://(.*)", re.DOTALL)
_ZERO_BYTE = "a path cannot contain a zero byte"


@dataclass(frozen=True)
class PathSite:
    """A path as written in the file `user`, which declares the folders of `packages`."""

    text: str
    where: Span
    user: SpecFile
    packages: Mapping[str, Path]

    @property
    def used(self) -> ImportSite:
        return ImportSite(self.text, self.where)


class Target(NamedTuple):
    """Where a path leads, and the package whose `package://` it went through."""

    path: Path
    package: Package | None = None


def is_xacro(path: Path) -> bool:
    """Whether xacro expands a file: by its name, or a URDF or SRDF whose root declares xacro and that is not expanded.

    A file that cannot be read is none; whatever reads it next reports that.
    """
    name = path.name.lower()
    if name.endswith(XACRO):
        return True
    if not name.endswith(_XML_OF_ROBOTS):
        return False
    try:
        content = read_bytes(path, MAX_FILE_BYTES, only_regular=True) or b""
    except UnreadableError:
        return False
    found = find_xacro(content)
    return found.has_definition or (f"{XACRO}." in name and found.has_substitution)


def names_xacro(site: PathSite, loader: Loader) -> bool:
    """Whether a site names a xacro; of a file outside of the roots nothing but its name is looked at."""
    target = locate(site, loader, Diagnostics())
    if target is None or not loader.roots.hold(target.path):
        return site.text.lower().endswith(XACRO)
    return is_xacro(target.path)


def open_use(site: PathSite, loader: Loader, sink: Diagnostics) -> SpecFile | None:
    """Read the spec or URDF that a `use` names; None after a reported error."""
    lowered = site.text.lower()
    if not lowered.endswith((*SPEC_ENDINGS, _URDF_ENDING)):
        sink.report(NOT_A_SPEC.at(site.where, path=site.text, hint=_hint_for(site.text)))
        return None
    target = locate(site, loader, sink)
    spec = loader.open(target.path, sink, package=target.package, used=site.used) if target else None
    return replace(spec, packages=site.packages) if spec else None


def _hint_for(path: str) -> str:
    if path.lower().endswith(".srdf"):
        return f"; write 'srdf: {path}' next to the 'use' of its robot"
    return "" if "." in path.rpartition("/")[2] else f"; write '{path}.robot.yaml'"


def locate(site: PathSite, loader: Loader, sink: Diagnostics) -> Target | None:
    """Return where a path leads, whether or not a file exists there; None after a reported error."""
    if "\0" in site.text:
        return _report_unusable(site, _ZERO_BYTE, sink)
    scheme = _SCHEME.match(site.text)
    if scheme is None:
        return _locate_file(site, sink)
    if scheme[1] == "package":
        return _locate_in_package(site, scheme[2], loader, sink)
    if scheme[1] != "file":
        return _report_unusable(site, "a file is named by a path, package:// or file://", sink)
    if not scheme[2].startswith("/"):
        return _report_unusable(site, "file:// takes an absolute path", sink)
    from urllib.request import url2pathname  # 20 ms to import, and few specs need it

    path = url2pathname(scheme[2])
    return _report_unusable(site, _ZERO_BYTE, sink) if "\0" in path else Target(Path(path))


def _locate_file(site: PathSite, sink: Diagnostics) -> Target | None:
    if Path(site.text).is_absolute():
        return Target(Path(site.text))
    user = site.user
    if user.folder is None:
        return _report_unusable(site, "it is relative, and this text is not in a folder", sink)
    path = follow(user.folder, site.text)
    package = user.package if user.package is not None and path.is_relative_to(user.package.folder) else None
    return Target(path, package)


def _locate_in_package(site: PathSite, path: str, loader: Loader, sink: Diagnostics) -> Target | None:
    parts = split_package_path(path)
    if parts is None or not parts[1]:
        return _report_unusable(site, "it takes the form package://NAME/PATH", sink)
    (name, inside), start, roots = parts, site.user.folder, loader.roots
    declared = {**site.packages, **loader.packages}
    folder = find_package(name, declared, start, roots)
    if folder is None:
        sink.report(unknown_package(site.where, name, start, roots, loader.nearby_packages, near=declared))
        return None
    return Target(follow(folder, inside), Package(name, folder))


def _report_unusable(site: PathSite, reason: str, sink: Diagnostics) -> Target | None:
    sink.report(USE_OF_NOWHERE.at(site.where, path=site.text, reason=reason))
    return None


# Meshes

FindMesh: TypeAlias = Callable[[str, Span, Diagnostics], Path | None]
"""Returns where the mesh with the path written at a place should be; None after a reported error."""

Writers: TypeAlias = Mapping[SourceFile, tuple[SpecFile, Mapping[str, Path]]]
"""By each file that may have written a path of one use: the file as reached, and the package folders known there."""


def mesh_finder(writers: Writers, loader: Loader) -> FindMesh:
    """Return what finds the meshes of one use."""

    def find(path: str, where: Span, sink: Diagnostics) -> Path | None:
        if where.file not in writers:
            return no_mesh(path, where, sink)
        site = PathSite(path, where, *writers[where.file])
        target = locate(site, loader, sink)
        return target.path if target and loader.may_read(target.path, site.used, sink) else None

    return find


def no_mesh(path: str, where: Span, sink: Diagnostics) -> Path | None:
    """Report that a path that no file wrote leads nowhere."""
    sink.report(USE_OF_NOWHERE.at(where, path=path, reason="it is written in no file"))
    return None


# Paths relative to another file


def mesh_base(module: SpecFile, compiled: SpecFile) -> str:
    """Return the prefix that makes the module's relative paths relative to the compiled file.

    For example "", "../arm/", or "package://arm/" for a module that was reached through a package; absolute if there
    is no relative path between the two.
    """
    assert module.folder is not None, "a module is a file and lies in a folder"
    if module.package:
        return f"package://{module.package.name}/{_steps(module.folder, module.package.folder)}"
    if compiled.folder is None:
        return f"{module.folder.absolute().as_posix()}/"
    return _steps(module.folder, compiled.folder)


def from_base(path: str, base: str) -> str:
    """Return a relative path with the prefix of `mesh_base`, normalized; any other path unchanged."""
    if not base or "://" in path or path.startswith("/"):
        return path
    whole = base + path
    package, separator, inside = _split_package(whole)
    normal = posixpath.normpath(inside)
    climbs_out = separator and normal.startswith("..")
    return whole if climbs_out else package + separator + normal


def _split_package(path: str) -> tuple[str, str, str]:
    """Split `package://NAME/PATH` at the slash after the name; a file path comes last, after two empty strings."""
    if not path.startswith("package://"):
        return "", "", path
    name, separator, inside = path.removeprefix("package://").partition("/")
    return f"package://{name}", separator, inside


def name_from(spec: SpecFile, compiled: SpecFile) -> str:
    """Return a file's name as seen from the compiled file."""
    return spec.file.name if spec.folder is None else mesh_base(spec, compiled) + Path(spec.file.name).name


def rebased(path: str, writer: Path | None, reader: SpecFile) -> str:
    """Return a relative path written in the folder `writer` as one relative to the folder of `reader`."""
    if _SCHEME.match(path) or Path(path).is_absolute() or writer is None or reader.folder is None:
        return path
    if writer == reader.folder:
        return path
    target = follow(writer, path)
    if reader.package and not target.is_relative_to(reader.package.folder):
        return follow(Path(), str(target.absolute())).as_posix()
    return _steps(target, reader.folder).removesuffix("/")


def _steps(target: Path, start: Path) -> str:
    """Return the path from one folder to another with a slash after every part; "" for the same folder."""
    try:
        way = target.relative_to(start) if target.is_relative_to(start) else Path(os.path.relpath(target, start))
    except ValueError:  # another drive of Windows
        way = target.absolute()
    return f"{way.as_posix()}/" if way.parts else ""
