"""Why no inertia can be computed from a mesh."""

from __future__ import annotations

from enum import StrEnum

from linkforge_compile.core.exceptions import RobotPhysicsError, ValidationErrorCode


class MeshFault(StrEnum):
    """The faults of a mesh from which no inertia can be computed."""

    NO_LIBRARY = "no library"
    NO_FORMAT = "no format"
    UNREADABLE = "unreadable"
    TOO_LARGE = "too large"
    EMPTY = "empty"
    OPEN = "open"
    TWISTED = "twisted"
    INSIDE_OUT = "inside out"
    FLAT = "flat"


_CODES = {
    MeshFault.EMPTY: ValidationErrorCode.VALUE_EMPTY,
    MeshFault.OPEN: ValidationErrorCode.MESH_BOUNDARY_EDGE,
    MeshFault.TWISTED: ValidationErrorCode.MESH_INCONSISTENT_WINDING,
    MeshFault.INSIDE_OUT: ValidationErrorCode.MESH_INCONSISTENT_WINDING,
    MeshFault.FLAT: ValidationErrorCode.MESH_DEGENERATE,
}


class MeshError(RobotPhysicsError):
    """A mesh that is no solid, or cannot be read; `message` is such as "4 of its 36 edges are open"."""

    def __init__(self, fault: MeshFault, message: str) -> None:
        super().__init__(_CODES.get(fault, ValidationErrorCode.INVALID_VALUE), message, target="Mesh")
        self.fault = fault
