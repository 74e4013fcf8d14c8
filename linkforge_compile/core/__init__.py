"""The IR, standing alone: robots as values that can be built, joined, checked and written, with no YAML in sight.

Names, fields and behaviour are those of `linkforge.core`. Each is imported when it is first asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from linkforge_compile.core import models

if TYPE_CHECKING:
    from linkforge_compile.core import builders, constants, exceptions, naming, physics, resolver
    from linkforge_compile.core.builders import (
        IComposer,
        LinkBuilder,
        RobotBuilder,
        SemanticBuilder,
        box,
        capsule,
        cylinder,
        mesh,
        sphere,
    )
    from linkforge_compile.core.constants import DEFAULT_LINK_MASS, EPSILON, GRAVITY_ENABLED, PI
    from linkforge_compile.core.exceptions import (
        LinkForgeError,
        RobotGeneratorError,
        RobotGeneratorUnsupportedTypeError,
        RobotMathError,
        RobotModelError,
        RobotParserError,
        RobotParserIOError,
        RobotParserUnexpectedError,
        RobotParserXMLRootError,
        RobotPhysicsError,
        RobotSecurityError,
        RobotValidationError,
        RobotXacroError,
        RobotXacroExpressionError,
        RobotXacroRecursionError,
        ValidationErrorCode,
        XacroDetectedError,
    )
    from linkforge_compile.core.models import *  # noqa: F403 its __all__ is ours, below
    from linkforge_compile.core.naming import is_valid_name
    from linkforge_compile.core.physics import calculate_inertia
    from linkforge_compile.core.resolver import FileSystemResolver, IResourceResolver

_SUBMODULES = "builders constants exceptions naming physics resolver"
_HOMES = {
    "builders": "IComposer LinkBuilder RobotBuilder SemanticBuilder box capsule cylinder mesh sphere",
    "constants": "DEFAULT_LINK_MASS EPSILON GRAVITY_ENABLED PI",
    "exceptions": "LinkForgeError RobotGeneratorError RobotGeneratorUnsupportedTypeError RobotMathError "
    "RobotModelError RobotParserError RobotParserIOError RobotParserUnexpectedError RobotParserXMLRootError "
    "RobotPhysicsError RobotSecurityError RobotValidationError RobotXacroError RobotXacroExpressionError "
    "RobotXacroRecursionError ValidationErrorCode XacroDetectedError",
    "models": " ".join(models.__all__),
    "naming": "is_valid_name",
    "physics": "calculate_inertia",
    "resolver": "FileSystemResolver IResourceResolver",
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = [
    "DEFAULT_LINK_MASS",
    "EPSILON",
    "GRAVITY_ENABLED",
    "PI",
    "FileSystemResolver",
    "IComposer",
    "IResourceResolver",
    "LinkBuilder",
    "LinkForgeError",
    "RobotBuilder",
    "RobotGeneratorError",
    "RobotGeneratorUnsupportedTypeError",
    "RobotMathError",
    "RobotModelError",
    "RobotParserError",
    "RobotParserIOError",
    "RobotParserUnexpectedError",
    "RobotParserXMLRootError",
    "RobotPhysicsError",
    "RobotSecurityError",
    "RobotValidationError",
    "RobotXacroError",
    "RobotXacroExpressionError",
    "RobotXacroRecursionError",
    "SemanticBuilder",
    "ValidationErrorCode",
    "XacroDetectedError",
    "box",
    "builders",
    "calculate_inertia",
    "capsule",
    "constants",
    "cylinder",
    "exceptions",
    "is_valid_name",
    "mesh",
    "models",
    "naming",
    "physics",
    "resolver",
    "sphere",
]
__all__ += models.__all__


def __getattr__(name: str) -> object:
    if name in _HOME_OF:
        return getattr(import_module(f"{__name__}.{_HOME_OF[name]}"), name)
    if name in _SUBMODULES.split():
        return import_module(f"{__name__}.{name}")
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)
