"""`variants`: named sets of parameter values, of which the compiled file takes one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.diagnostics.codes.files import UNKNOWN_VARIANT
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.arguments import COMMAND_LINE
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.uses import XACRO
from linkforge_compile.schema.words import alternatives
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode

_MOST_LISTED = 8


class Variants(NamedTuple):
    """What each variant of a file sets, and the name of the chosen one, None for the defaults."""

    by_name: Mapping[str, YamlMap] = MappingProxyType({})
    chosen: str | None = None

    def value_of(self, parameter: str) -> YamlNode | None:
        """Return what the chosen variant gives to a parameter, None where it says nothing of it."""
        variant = None if self.chosen is None else self.by_name.get(self.chosen)
        return None if variant is None else variant.get(parameter)

    def other_values_of(self, parameter: str) -> tuple[YamlNode, ...]:
        """Return what the variants that were not chosen give to a parameter."""
        others = (variant.get(parameter) for name, variant in self.by_name.items() if name != self.chosen)
        return tuple(value for value in others if value is not None)

    def entries(self) -> Iterator[YamlEntry]:
        """Yield every setting of every variant."""
        for variant in self.by_name.values():
            yield from variant


def variants_of(spec: SpecFile) -> dict[str, YamlMap]:
    """Return the variants of a file by name; one that says nothing is the defaults."""
    section = spec.tree.get("variants")
    return {
        entry.name: entry.value if isinstance(entry.value, YamlMap) else YamlMap({}, entry.value.span)
        for entry in (section if isinstance(section, YamlMap) else ())
    }


def names_of_variants(path: Path, loader: Loader) -> Iterable[str]:
    """Return the names of the variants of a file, none where it cannot be read: then its check says so."""
    if path.suffix.lower() == XACRO:
        return ()
    try:
        spec = loader.open(path, Diagnostics())
    except BeyondLimitError:
        return ()
    return variants_of(spec) if spec else ()


def tell_unknown_variant(name: str, spec: SpecFile, sink: Diagnostics) -> None:
    """Report a variant that the compiled file does not have, as it was typed."""
    text = f"--variant {name}"
    file = SourceFile(COMMAND_LINE, text)
    where = Span(file, 1, len(text) - len(name) + 1, 1, len(text) + 1)
    known = variants_of(spec)
    names = [f"'{each}'" for each in known]
    shown = [*names[:_MOST_LISTED], f"{len(names) - _MOST_LISTED} more"] if len(names) > _MOST_LISTED else names
    hint = f"; its variants are {alternatives(shown, 'and')}" if shown else "; it declares no variants"
    near = nearest(name, known)
    sink.report(UNKNOWN_VARIANT.at(where, spec=spec.file.name, name=name, hint="" if near else hint, near=known))
