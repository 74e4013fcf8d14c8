"""The text of a `disabled_collisions` section."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby

from linkforge_compile.collisions.matrix import Names
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.writer import write

_GENERATED = SourceFile("<generated>", "").whole


def section_text(pairs: Mapping[Names, str | None]) -> str:
    """Return the section as lines of YAML, to be put below `semantic`."""
    return write(_map({"disabled_collisions": pairs_node(pairs)}))


def pairs_node(pairs: Mapping[Names, str | None]) -> YamlMap:
    """Return pairs as a map of maps: first link, second link, reason."""
    by_first = groupby(pairs.items(), key=lambda item: item[0][0])
    return _map({first: _map({pair[1]: _reason(why) for pair, why in each}) for first, each in by_first})


def _map(entries: Mapping[str, YamlNode]) -> YamlMap:
    named = {name: YamlEntry(_text(name), value) for name, value in entries.items()}
    return YamlMap(named, _GENERATED)


def _reason(reason: str | None) -> YamlScalar:
    return YamlScalar("", None, _GENERATED) if reason is None else _text(reason)


def _text(text: str) -> YamlScalar:
    return YamlScalar(text, text, _GENERATED)
