"""The model alone: robots as values that can be built, merged, checked and written without YAML.

Names, fields and behaviour are those of `linkforge.core`. Each name is imported when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from linkforge_compile.core import models

if TYPE_CHECKING:
    from linkforge_compile.core import builders as builders
    from linkforge_compile.core import constants as constants
    from linkforge_compile.core import exceptions as exceptions
    from linkforge_compile.core import naming as naming
    from linkforge_compile.core import physics as physics
    from linkforge_compile.core import resolver as resolver
    from linkforge_compile.core.builders import *  # noqa: F403
    from linkforge_compile.core.constants import DEFAULT_LINK_MASS as DEFAULT_LINK_MASS
    from linkforge_compile.core.constants import EPSILON as EPSILON
    from linkforge_compile.core.constants import GRAVITY_ENABLED as GRAVITY_ENABLED
    from linkforge_compile.core.constants import PI as PI
    from linkforge_compile.core.exceptions import *  # noqa: F403
    from linkforge_compile.core.models import *  # noqa: F403
    from linkforge_compile.core.naming import is_valid_name as is_valid_name
    from linkforge_compile.core.physics import calculate_inertia as calculate_inertia
    from linkforge_compile.core.resolver import FileSystemResolver as FileSystemResolver
    from linkforge_compile.core.resolver import IResourceResolver as IResourceResolver

_SUBMODULES = ("builders", "constants", "exceptions", "models", "naming", "physics", "resolver")
_NAMES = {
    "builders": "IComposer LinkBuilder RobotBuilder SemanticBuilder box capsule cylinder mesh sphere",
    "constants": "DEFAULT_LINK_MASS EPSILON GRAVITY_ENABLED PI",
    "exceptions": "LinkForgeError RobotGeneratorError RobotGeneratorUnsupportedTypeError RobotMathError "
    "RobotModelError RobotParserError RobotParserIOError RobotParserUnexpectedError "
    "RobotParserXMLRootError RobotPhysicsError RobotSecurityError RobotValidationError RobotXacroError "
    "RobotXacroExpressionError RobotXacroRecursionError ValidationErrorCode XacroDetectedError",
    "models": " ".join(dir(models)),
    "naming": "is_valid_name",
    "physics": "calculate_inertia",
    "resolver": "FileSystemResolver IResourceResolver",
}
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names.split()}

if not TYPE_CHECKING:
    __all__ = list(_SUBMODULES) + list(_MODULE_OF)

    def __getattr__(name: str) -> object:
        if name in _SUBMODULES:
            return import_module(f"{__name__}.{name}")
        if name not in _MODULE_OF:
            raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
        return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)

    def __dir__() -> list[str]:
        return sorted(__all__)
