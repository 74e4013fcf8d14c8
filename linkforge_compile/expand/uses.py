"""From a path in a spec to the file that it names, and back to how that file's meshes are written."""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import NOT_A_SPEC, USE_OF_NOWHERE
from linkforge_compile.expand.loader import Loader, SpecFile, Used
from linkforge_compile.expand.paths import follow
from linkforge_compile.source import Span

if TYPE_CHECKING:
    from linkforge_compile.expand.packages import Package

SPEC_ENDINGS = (".yaml", ".yml")
"""How the names of spec files end."""
_URDF_ENDING = ".urdf"
XACRO = ".xacro"
"""How the name of a xacro file ends."""
_SCHEME = re.compile(r"([A-Za-z][\w+.-]+)://(.*)", re.DOTALL)
_PACKAGE_PATH = re.compile(r"([A-Za-z_][\w.-]*)/+([^/].*)", re.DOTALL)


@dataclass(frozen=True)
class UseSite:
    """A `use`, or another path, as it is written: in the file `user`, which declares where some packages are."""

    text: str
    where: Span
    user: SpecFile
    packages: Mapping[str, Path]

    @property
    def used(self) -> Used:
        return Used(self.text, self.where)


class Target(NamedTuple):
    """Where a path leads, and the package through which."""

    path: Path
    package: Package | None = None


_ZERO_BYTE = "no path holds a zero byte"


def open_use(site: UseSite, loader: Loader, sink: Diagnostics) -> SpecFile | None:
    """Read the file that a `use` names; None where there is none, which is reported there."""
    lowered = site.text.lower()
    if not lowered.endswith((*SPEC_ENDINGS, _URDF_ENDING)):
        sink.report(NOT_A_SPEC.at(site.where, path=site.text, hint=_hint_for(site.text)))
        return None
    target = locate(site, loader, sink)
    spec = loader.open(target.path, sink, package=target.package, used=site.used) if target else None
    return replace(spec, packages=site.packages) if spec else None


def _hint_for(no_spec: str) -> str:
    if no_spec.lower().endswith(".srdf"):
        return f"; write 'srdf: {no_spec}' next to the 'use' of its robot"
    return "" if "." in no_spec.rpartition("/")[2] else f"; write '{no_spec}.robot.yaml'"


def locate(site: UseSite, loader: Loader, sink: Diagnostics) -> Target | None:
    """Return where a path leads, be there a file or not; None where it leads nowhere, which is reported there."""
    if "\0" in site.text:
        return _nowhere(site, _ZERO_BYTE, sink)
    scheme = _SCHEME.match(site.text)
    if scheme is None:
        return _beside_the_user(site, sink)
    if scheme[1] == "package":
        return _in_package(site, scheme[2], loader, sink)
    if scheme[1] != "file":
        return _nowhere(site, "a file is named by a path, package:// or file://", sink)
    if not scheme[2].startswith("/"):
        return _nowhere(site, "file:// takes an absolute path", sink)
    # urllib.request costs 20 ms to import, and hardly a spec needs it.
    from urllib.request import url2pathname

    path = url2pathname(scheme[2])
    return _nowhere(site, _ZERO_BYTE, sink) if "\0" in path else Target(Path(path))


def mesh_base(module: SpecFile, compiled: SpecFile) -> str:
    """Return what makes a relative path of the module one of the compiled file: "", "../arm/" or "package://arm/".

    Whoever is reached through a package stays in it; what lies on no common drive has an absolute path.
    """
    assert module.folder is not None, "a module is a file and lies in a folder"
    if module.package:
        return f"package://{module.package.name}/{_steps(module.folder, module.package.folder)}"
    if compiled.folder is None:
        return f"{module.folder.absolute().as_posix()}/"
    return _steps(module.folder, compiled.folder)


def from_base(path: str, base: str) -> str:
    """Return a path behind what `mesh_base` gives for its file, in the shortest form; no relative one as written."""
    if not base or "://" in path or path.startswith("/"):
        return path
    whole = base + path
    package, separator, inside = _behind_the_package(whole)
    normal = posixpath.normpath(inside)
    climbs_out = separator and normal.startswith("..")
    return whole if climbs_out else package + separator + normal


def _behind_the_package(path: str) -> tuple[str, str, str]:
    """Split `package://NAME/PATH` behind the name; "" and "" before a path of files."""
    if not path.startswith("package://"):
        return "", "", path
    name, separator, inside = path.removeprefix("package://").partition("/")
    return f"package://{name}", separator, inside


def name_from(spec: SpecFile, compiled: SpecFile) -> str:
    """Return a file's name as seen from the compiled file."""
    return spec.file.name if spec.folder is None else mesh_base(spec, compiled) + Path(spec.file.name).name


def rebased(path: str, writer: Path | None, reader: SpecFile) -> str:
    """Return a relative path that was written in one folder as one that is read in a file of another."""
    if _SCHEME.match(path) or Path(path).is_absolute() or writer is None or reader.folder is None:
        return path
    if writer == reader.folder:
        return path
    target = follow(writer, path)
    if reader.package and not target.is_relative_to(reader.package.folder):
        return follow(Path(), str(target.absolute())).as_posix()
    return _steps(target, reader.folder).removesuffix("/")


def _steps(target: Path, start: Path) -> str:
    """Return the way from one folder to another with a slash behind every step; "" for none."""
    try:
        way = target.relative_to(start) if target.is_relative_to(start) else Path(os.path.relpath(target, start))
    except ValueError:  # two drives of Windows
        way = target.absolute()
    return f"{way.as_posix()}/" if way.parts else ""


def _beside_the_user(site: UseSite, sink: Diagnostics) -> Target | None:
    if Path(site.text).is_absolute():
        return Target(Path(site.text))
    user = site.user
    if user.folder is None:
        return _nowhere(site, "it is relative, and this text lies in no folder", sink)
    path = follow(user.folder, site.text)
    package = user.package if user.package is not None and path.is_relative_to(user.package.folder) else None
    return Target(path, package)


def _in_package(site: UseSite, path: str, loader: Loader, sink: Diagnostics) -> Target | None:
    match = _PACKAGE_PATH.fullmatch(path)
    if match is None:
        return _nowhere(site, "it takes the form package://NAME/PATH", sink)
    from linkforge_compile.expand.packages import Package, find_package, unknown_package

    name = match[1]
    declared = {**site.packages, **loader.packages}
    folder = find_package(name, declared, site.user.folder, loader.roots)
    if folder is None:
        sink.report(unknown_package(site.where, name, site.user.folder, loader, near=declared))
        return None
    return Target(follow(folder, match[2]), Package(name, folder))


def _nowhere(site: UseSite, reason: str, sink: Diagnostics) -> Target | None:
    sink.report(USE_OF_NOWHERE.at(site.where, path=site.text, reason=reason))
    return None
