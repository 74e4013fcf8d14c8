"""What the objects of one file need to know of the file that they stand in."""

from __future__ import annotations

import posixpath
from collections.abc import Mapping
from dataclasses import dataclass, field

from linkforge_compile.core.models.material import Material
from linkforge_compile.diagnostics import Gaps


@dataclass(frozen=True, slots=True)
class FileScope:
    """`mesh_base` is as in Instance, `materials` are those that the file declares, without those that are lost."""

    mesh_base: str = ""
    materials: Mapping[str, Material] = field(default_factory=dict)
    lost_materials: Gaps = field(default_factory=Gaps)

    def resource(self, path: str) -> str:
        """Return a relative path as the compiled file would write it; a URI or an absolute path as written."""
        if not self.mesh_base or "://" in path or path.startswith("/"):
            return path
        whole = self.mesh_base + path
        package, separator, inside = _in_package(whole)
        normal = posixpath.normpath(inside)
        climbs_out = separator and normal.startswith("..")
        return whole if climbs_out else package + separator + normal


def _in_package(path: str) -> tuple[str, str, str]:
    """Split `package://NAME/PATH` behind the name; "" and "" before a path of files."""
    if not path.startswith("package://"):
        return "", "", path
    name, separator, inside = path.removeprefix("package://").partition("/")
    return f"package://{name}", separator, inside
