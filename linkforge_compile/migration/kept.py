"""A spec that uses a xacro as it is, where the language has no form for what is in it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from linkforge_compile.importers.origin import relative_path
from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.migration.parameters import names_of
from linkforge_compile.migration.symbols import Symbol
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.writer import write

_MODULE = "robot"


def parameter_names(arguments: Iterable[str]) -> dict[str, str]:
    """Return the names of the parameters that arguments become."""
    symbols = {name: Symbol(name, "parameter") for name in arguments}
    names = names_of(symbols.values())
    return {name: names[symbol] for name, symbol in symbols.items()}


def kept_spec(xacro: Path, folder: Path, arguments: Mapping[str, str], head: str) -> str:
    """Return a spec in a folder that uses a xacro as its only module, with the arguments as parameters."""
    where = SourceFile("<migrated>", "").whole
    names = parameter_names(arguments)
    stem = xacro.name.partition(".")[0]
    given = {name: scalar(f"$({names[name]})", where) for name in arguments}
    entry = {
        "use": scalar(relative_path(folder, xacro), where),
        "prefix": scalar("", where),
        "with": map_of(given, where) if given else None,
    }
    declared = {names[name]: scalar(default, where) for name, default in arguments.items()}
    tree = {
        "linkforge": scalar("1", where, is_text=False),
        "name": scalar(stem, where),
        "parameters": map_of(declared, where) if declared else None,
        "modules": map_of({_MODULE: map_of(entry, where)}, where),
    }
    return f"{head}{write(map_of(tree, where))}"
