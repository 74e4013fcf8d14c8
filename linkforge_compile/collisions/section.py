"""The text of a `disabled_collisions` section."""

from __future__ import annotations

from collections.abc import Mapping

from linkforge_compile.collisions.pairs import Names
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.writer import write

_GENERATED = SourceFile("<generated>", "").whole


def section_text(pairs: Mapping[Names, str | None]) -> str:
    """Return the section as lines of YAML, to be put below `semantic`."""
    by_first: dict[str, dict[str, YamlNode]] = {}
    for (first, second), reason in pairs.items():
        by_first.setdefault(first, {})[second] = _reason(reason)
    return write(_map({"disabled_collisions": _map({name: _map(each) for name, each in by_first.items()})}))


def entry_lines(pairs: Mapping[Names, str | None]) -> list[str]:
    """Return the lines below the key of the section, without their common indentation; none for no pairs."""
    return [line.removeprefix("  ") for line in section_text(pairs).splitlines()[1:]]


def _map(entries: Mapping[str, YamlNode]) -> YamlMap:
    named = {name: YamlEntry(_text(name), value) for name, value in entries.items()}
    return YamlMap(named, _GENERATED)


def _reason(reason: str | None) -> YamlScalar:
    return YamlScalar("", None, _GENERATED) if reason is None else _text(reason)


def _text(text: str) -> YamlScalar:
    return YamlScalar(text, text, _GENERATED)
