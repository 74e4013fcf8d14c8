"""Many files and their parameters to one assembly: every use of every file, with every expression computed."""

from linkforge_compile.expand.arguments import (
    Arguments,
    Told,
    Unset,
    arguments_from_text,
    arguments_from_values,
)
from linkforge_compile.expand.assembly import Instance
from linkforge_compile.expand.expand import expand
from linkforge_compile.expand.loader import Loader, SpecFile, Used
from linkforge_compile.expand.uses import XACRO

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
