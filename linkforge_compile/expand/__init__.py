"""Turn a spec, its parameters and the files it uses into a tree of Instances with every expression computed."""

from linkforge_compile.expand.arguments import (
    Arguments,
    CliArgument,
    Unset,
    arguments_from_text,
    arguments_from_values,
)
from linkforge_compile.expand.assembly import Instance
from linkforge_compile.expand.expand import expand
from linkforge_compile.expand.loader import ImportSite, Loader, SpecFile
from linkforge_compile.expand.uses import XACRO

__all__ = [
    "XACRO",
    "Arguments",
    "CliArgument",
    "ImportSite",
    "Instance",
    "Loader",
    "SpecFile",
    "Unset",
    "arguments_from_text",
    "arguments_from_values",
    "expand",
]
