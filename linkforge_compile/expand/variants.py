"""Read `variants`: named sets of parameter values, of which the compiled file selects one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.diagnostics.codes.modules import UNKNOWN_VARIANT
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.arguments import COMMAND_LINE
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.uses import XACRO
from linkforge_compile.schema.shapes import alternatives
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode

_MAX_LISTED = 8


class Variants(NamedTuple):
    """The settings of each variant of a file, and the name of the selected one, None for the defaults."""

    by_name: Mapping[str, YamlMap] = MappingProxyType({})
    selected: str | None = None

    def value_of(self, parameter: str) -> YamlNode | None:
        """Return what the selected variant sets a parameter to, None for nothing."""
        variant = None if self.selected is None else self.by_name.get(self.selected)
        return None if variant is None else variant.get(parameter)

    def other_values_of(self, parameter: str) -> tuple[YamlNode, ...]:
        """Return what the other variants set a parameter to."""
        others = (variant.get(parameter) for name, variant in self.by_name.items() if name != self.selected)
        return tuple(value for value in others if value is not None)

    def entries(self) -> Iterator[YamlEntry]:
        """Yield every setting of every variant."""
        for variant in self.by_name.values():
            yield from variant


def variants_of(spec: SpecFile) -> dict[str, YamlMap]:
    """Return the variants of a file by name; an empty one has no settings."""
    section = spec.tree.get("variants")
    return {
        entry.name: entry.value if isinstance(entry.value, YamlMap) else YamlMap({}, entry.value.span)
        for entry in (section if isinstance(section, YamlMap) else ())
    }


def names_of_variants(path: Path, loader: Loader) -> Iterable[str]:
    """Return the names of the variants of a file; none if it cannot be read, which its compile reports."""
    if path.suffix.lower() == XACRO:
        return ()
    try:
        spec = loader.open(path, Diagnostics())
    except BeyondLimitError:
        return ()
    return variants_of(spec) if spec else ()


def report_unknown_variant(name: str, spec: SpecFile, sink: Diagnostics) -> None:
    """Report a `--variant` that the compiled file does not have."""
    text = f"--variant {name}"
    file = SourceFile(COMMAND_LINE, text)
    where = Span(file, 1, len(text) - len(name) + 1, 1, len(text) + 1)
    known = variants_of(spec)
    names = [f"'{each}'" for each in known]
    shown = [*names[:_MAX_LISTED], f"{len(names) - _MAX_LISTED} more"] if len(names) > _MAX_LISTED else names
    hint = f"; its variants are {alternatives(shown, 'and')}" if shown else "; it declares no variants"
    near = nearest(name, known)
    sink.report(UNKNOWN_VARIANT.at(where, spec=spec.file.name, name=name, hint="" if near else hint, near=known))
