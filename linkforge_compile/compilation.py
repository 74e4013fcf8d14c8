"""The result of a compile."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Severity


class CompileError(Exception):
    """Raised for the robot of a spec with errors; `diagnostics` has all of them."""

    def __init__(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        self.diagnostics = diagnostics
        super().__init__("\n".join(str(diagnostic) for diagnostic in diagnostics))

    def __reduce__(self) -> tuple[type[CompileError], tuple[tuple[Diagnostic, ...]]]:
        return CompileError, (self.diagnostics,)


@dataclass(frozen=True)
class Compilation:
    """The robot of one compile and all diagnostics of its spec.

    `robot` is None if the spec has errors, and if a check left out what depends on parameters without a value. `files`
    lists every file that it was made from: the compiled one first, what it includes, uses and reads values from, then
    the meshes read for their inertia. `unread` lists the files that could not be read: once one of them exists, the
    result is another.
    """

    robot: Robot | None
    diagnostics: tuple[Diagnostic, ...]
    files: tuple[Path, ...] = ()
    unread: tuple[Path, ...] = ()

    @property
    def has_errors(self) -> bool:
        return any(diagnostic.severity is Severity.ERROR for diagnostic in self.diagnostics)

    def result(self) -> Robot:
        """Return the robot; raise CompileError if there is none."""
        if self.robot is None:
            raise CompileError(self.diagnostics)
        return self.robot
