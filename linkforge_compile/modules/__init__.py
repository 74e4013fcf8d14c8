"""Many files and their parameters to one assembly: every use of every file, with every expression computed."""

from linkforge_compile.modules.arguments import (
    Arguments,
    Told,
    Unset,
    arguments_from_text,
    arguments_from_values,
)
from linkforge_compile.modules.assembly import Instance
from linkforge_compile.modules.expand import expand
from linkforge_compile.modules.loader import Loader, SpecFile, Used
from linkforge_compile.modules.uses import XACRO

__all__ = [
    "XACRO",
    "Arguments",
    "Instance",
    "Loader",
    "SpecFile",
    "Told",
    "Unset",
    "Used",
    "arguments_from_text",
    "arguments_from_values",
    "expand",
]
