"""The exceptions of the model, with a code, the field at fault and the value found."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Self, TypeAlias

FieldPath: TypeAlias = tuple[str | int, ...]
"""The way from an object to its field at fault, in the keys of the spec language: ("limits", "upper")."""


class ValidationErrorCode(StrEnum):
    """Why something was refused; stable, for programs."""

    INVALID_NAME = "invalid_name"
    DUPLICATE_NAME = "duplicate_name"
    NAME_EMPTY = "name_empty"
    NOT_FOUND = "not_found"
    HAS_CYCLE = "has_cycle"
    NO_ROOT = "no_root"
    MULTIPLE_ROOTS = "multiple_roots"
    OUT_OF_RANGE = "out_of_range"
    VALUE_EMPTY = "value_empty"
    INVALID_VALUE = "invalid_value"
    PHYSICS_VIOLATION = "physics_violation"
    INERTIA_TRIANGLE_INEQUALITY = "inertia_triangle_inequality"
    MESH_UNWELDED = "mesh_unwelded"
    MESH_DUPLICATE_FACE = "mesh_duplicate_face"
    MESH_DEGENERATE = "mesh_degenerate"
    MESH_BOUNDARY_EDGE = "mesh_boundary_edge"
    MESH_NON_MANIFOLD = "mesh_non_manifold"
    MESH_INCONSISTENT_WINDING = "mesh_inconsistent_winding"
    MESH_SLIVER = "mesh_sliver"
    GENERIC_FAILURE = "generic_failure"


class LinkForgeError(Exception):
    """Anything that LinkForge refuses. Every error pickles, so that a process pool hands it back whole."""

    def __reduce__(self) -> tuple[object, ...]:
        # Exception.__reduce__ calls the constructor with the finished sentence, which most of these do not accept.
        return _revive, (type(self), self.args, self.__dict__)


def _revive(kind: type[LinkForgeError], args: tuple[object, ...], facts: dict[str, object]) -> LinkForgeError:
    error = kind.__new__(kind, *args)
    error.__dict__.update(facts)
    return error


class RobotModelError(LinkForgeError):
    """A robot or a part of one that is not valid.

    `message` is the sentence by itself, `str(error)` the sentence with code, target and value around it.
    `target` names the rule's subject for programs ("JointLimits"), `value` is what was found; None for neither.
    """

    code: ValidationErrorCode = ValidationErrorCode.GENERIC_FAILURE
    target: str | None = None
    value: object = None
    field: FieldPath = ()

    def __init__(self, *args: object) -> None:
        super().__init__(*args)
        self.message = str(args[0]) if args else ""


class _CodedModelError(RobotModelError):
    """A model error with its facts; `prefix` precedes the code in the text."""

    prefix = ""

    def __init__(
        self,
        code: ValidationErrorCode,
        message: str,
        target: str | None = None,
        value: object = None,
        *,
        field: FieldPath = (),
    ) -> None:
        text = f"[{self.prefix}{code.name}] {message}"
        if target:
            text += f" (target: {target})"
        if value is not None:
            text += f" (value: {value})"
        super().__init__(text)
        self.code = code
        self.message = message
        self.target = target
        self.value = value
        self.field = field

    @classmethod
    def invalid(cls, message: str, target: str, value: object = None, *field: str | int) -> Self:
        """Return the error INVALID_VALUE; `field` are the keys of its path."""
        return cls(ValidationErrorCode.INVALID_VALUE, message, target, value, field=field)

    @classmethod
    def empty(cls, message: str, target: str, value: object = None, *field: str | int) -> Self:
        """Return the error VALUE_EMPTY."""
        return cls(ValidationErrorCode.VALUE_EMPTY, message, target, value, field=field)

    @classmethod
    def out_of_range(cls, message: str, target: str, value: object = None, *field: str | int) -> Self:
        """Return the error OUT_OF_RANGE."""
        return cls(ValidationErrorCode.OUT_OF_RANGE, message, target, value, field=field)

    @classmethod
    def not_found(cls, message: str, target: str, value: object = None, *field: str | int) -> Self:
        """Return the error NOT_FOUND."""
        return cls(ValidationErrorCode.NOT_FOUND, message, target, value, field=field)


class RobotValidationError(_CodedModelError):
    """A name, a reference or a value that breaks the rules of the model."""


class RobotPhysicsError(_CodedModelError):
    """A size or a mass that is physically impossible."""

    prefix = "PHYSICS_"


class RobotMathError(_CodedModelError):
    """A number that is NaN, infinite, or beyond a double."""

    prefix = "MATH_"


class RobotSecurityError(RobotModelError):
    """A path outside of the allowed folders."""

    def __init__(self, path: str = "unknown", reason: str = "violation") -> None:
        super().__init__(f"Security Violation: {reason} (path: {path})")
        self.path = path
        self.reason = reason


class RobotGeneratorError(LinkForgeError):
    """A robot that cannot be written."""


class RobotGeneratorUnsupportedTypeError(RobotGeneratorError):
    """Content that a generator cannot write."""

    def __init__(self, content_type: object, generator_name: str) -> None:
        super().__init__(f"{generator_name} cannot write content of type '{content_type}'")
        self.content_type = content_type
        self.generator_name = generator_name


class RobotParserError(LinkForgeError):
    """A text that cannot be read as a robot."""


class RobotParserIOError(RobotParserError):
    """A file that cannot be read at all."""

    def __init__(self, filepath: Path | str = "unknown", reason: str = "error") -> None:
        super().__init__(f"cannot read {filepath}: {reason}")
        self.filepath = filepath
        self.reason = reason


class RobotParserXMLRootError(RobotParserError):
    """An XML document about something else."""

    def __init__(self, actual_tag: str = "unknown", expected_tag: str = "robot") -> None:
        super().__init__(f"the root element must be <{expected_tag}>, found <{actual_tag}>")
        self.actual_tag = actual_tag
        self.expected_tag = expected_tag


class RobotParserUnexpectedError(RobotParserError):
    """A failure of reading without a class of its own; `original_error` is None if unknown."""

    def __init__(self, source_area: str = "unknown", original_error: object = None) -> None:
        reason = f": {original_error}" if original_error else ""
        super().__init__(f"reading failed unexpectedly in {source_area}{reason}")
        self.source_area = source_area
        self.original_error = original_error


class RobotXacroError(RobotParserError):
    """A xacro file that cannot be expanded; `context` is the place in it, None if unknown."""

    def __init__(self, message: str = "failure", context: str | None = None) -> None:
        place = f" (at {context})" if context else ""
        super().__init__(f"XACRO error: {message}{place}")
        self.context = context


class RobotXacroRecursionError(RobotXacroError):
    """Xacro macros or includes that never end."""

    def __init__(self, depth: int | str = "unknown", reason: str | None = None) -> None:
        why = f" ({reason})" if reason else ""
        super().__init__(f"Recursion depth exceeded: {depth}{why}")
        self.depth = depth
        self.reason = reason


class RobotXacroExpressionError(RobotXacroError):
    """A `${...}` of xacro that has no value."""

    def __init__(self, expression: str = "unknown", reason: str = "error") -> None:
        super().__init__(f"Expression evaluation failed: ${{{expression}}}: {reason}")
        self.expression = expression
        self.reason = reason


class XacroDetectedError(RobotParserError):
    """Xacro where plain URDF was expected."""

    def __init__(self, message: str = "XACRO detected") -> None:
        super().__init__(f"this is xacro, not URDF: {message}; expand it first")


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


_MESH_CODES = {
    MeshFault.EMPTY: ValidationErrorCode.VALUE_EMPTY,
    MeshFault.OPEN: ValidationErrorCode.MESH_BOUNDARY_EDGE,
    MeshFault.TWISTED: ValidationErrorCode.MESH_INCONSISTENT_WINDING,
    MeshFault.INSIDE_OUT: ValidationErrorCode.MESH_INCONSISTENT_WINDING,
    MeshFault.FLAT: ValidationErrorCode.MESH_DEGENERATE,
}


class MeshError(RobotPhysicsError):
    """A mesh that is no solid, or cannot be read; `message` is such as "4 of its 36 edges are open"."""

    def __init__(self, fault: MeshFault, message: str) -> None:
        super().__init__(_MESH_CODES.get(fault, ValidationErrorCode.INVALID_VALUE), message, target="Mesh")
        self.fault = fault
