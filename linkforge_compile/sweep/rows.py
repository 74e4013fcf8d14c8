"""What the table says of a robot: its figures, the counts of its diagnostics, and a digest of its outputs."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from hashlib import sha256
from typing import TYPE_CHECKING, TypeAlias

from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.models.link import InertiaTensor
from linkforge_compile.core.physics import shifted
from linkforge_compile.core.poses import Pose
from linkforge_compile.diagnostics import Severity
from linkforge_compile.overview.extent import farthest, reaches_from, zero_poses
from linkforge_compile.overview.figures import mass_of

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.diagnostics import Diagnostic

Cell: TypeAlias = None | bool | int | float | str
Row: TypeAlias = dict[str, Cell]

_MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")

FIGURES: Mapping[str, str] = {
    "robot_mass": "kg",
    **{f"robot_com_{axis}": "m" for axis in "xyz"},
    **{f"robot_{name}": "kg*m^2" for name in _MOMENTS},
    "robot_reach": "m",
}
"""The columns of numbers with their units."""

COUNTS = ("robot_dof", "robot_links", "errors", "warnings")
TEXTS = ("diagnostics", "digest")


def reserved_columns() -> frozenset[str]:
    """Return the names that a parameter's column cannot have."""
    return frozenset(("index", "variant", *FIGURES, *COUNTS, *TEXTS))


def figures_row(robot: Robot) -> Row:
    """Return the figures of a robot with every joint at 0, in the frame of its root.

    The inertia is about the centre of mass, along the axes of the root. A robot without mass has neither.
    """
    poses = zero_poses(robot)
    mass = mass_of(robot, poses)
    row: Row = {
        "robot_mass": mass.total,
        "robot_reach": farthest(reaches_from(robot, next(iter(poses)))).bound,
        "robot_dof": sum(joint.degrees_of_freedom for joint in robot.joints if not joint.mimic),
        "robot_links": len(robot.links),
    }
    if mass.centre is not None:
        row |= {f"robot_com_{axis}": at for axis, at in zip("xyz", mass.centre, strict=True)}
        row |= {f"robot_{name}": value for name, value in _inertia(robot, poses, mass.centre).items()}
    return row


def _inertia(robot: Robot, poses: Mapping[str, Pose], centre: Sequence[float]) -> dict[str, float]:
    """Return the moments and products of inertia about a point, in the axes of the root [kg·m²]."""
    total = dict.fromkeys(_MOMENTS, 0.0)
    for link in robot.links:
        if link.mass:
            pose = poses[link.name].times(Pose.of(link.inertial_origin))
            arm = Vector3(*(at - to for at, to in zip(pose.xyz, centre, strict=True)))
            tensor = shifted(_turned(link.inertia, pose), link.mass, arm)
            for name in _MOMENTS:
                total[name] += getattr(tensor, name)
    return total


def _turned(tensor: InertiaTensor, pose: Pose) -> InertiaTensor:
    """Return a tensor in the axes of the frame around a pose."""
    rows = [pose.turn.turned(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]  # columns of R
    inner = (
        (tensor.ixx, tensor.ixy, tensor.ixz),
        (tensor.ixy, tensor.iyy, tensor.iyz),
        (tensor.ixz, tensor.iyz, tensor.izz),
    )

    def entry(i: int, j: int) -> float:
        return sum(rows[k][i] * inner[k][m] * rows[m][j] for k in range(3) for m in range(3))

    return InertiaTensor(entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2))


def diagnostics_row(diagnostics: Iterable[Diagnostic], hide: str = "") -> Row:
    """Return the counts of errors and warnings, and all as JSON; `hide` is omitted from paths."""
    listed = [
        {
            "severity": one.severity.value,
            "code": one.code.id,
            "message": one.message.replace(hide, "") if hide else one.message,
            "file": None if one.span is None else one.span.file.shown.replace(hide, ""),
            "line": one.span and one.span.line,
            "column": one.span and one.span.column,
        }
        for one in diagnostics
    ]
    return counted(listed)


def counted(listed: Sequence[Mapping[str, object]]) -> Row:
    """Return the columns of diagnostics as JSON has them."""
    severities = [one["severity"] for one in listed]
    return {
        "errors": severities.count(Severity.ERROR.value),
        "warnings": severities.count(Severity.WARNING.value),
        "diagnostics": json.dumps(listed, ensure_ascii=False),
    }


def digest_of(files: Mapping[str, str]) -> str:
    """Return the SHA-256 of the names and contents of some files."""
    hashed = sha256()
    for name, text in sorted(files.items()):
        hashed.update(f"{name}\0{len(text)}\0{text}".encode("utf-8", "backslashreplace"))
    return hashed.hexdigest()
