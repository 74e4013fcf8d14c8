"""What a sweep was requested to do, as its folder has it, and how another request differs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linkforge_compile.sweep.bundle import changed_files
from linkforge_compile.sweep.wording import Wording

_OPTIONS = {
    "options": "options of formats",
    "parameters": "-p",
    "set": "--set",
    "values": "--values",
    "variants": "--variant",
    "where": "--where",
    "sample": "--sample",
    "seed": "--seed",
    "formats": "--format",
    "packages": "--package",
    "allow_outside": "--allow-outside",
    "chunk": "--chunk",
    "output": "--pack or --table-only",
}
"""Entries that the command has an option for, under another name."""

_FOLLOWING = ("points", "robots", "chunk", "function_source")
"""Entries that follow from others, unless they are all that differs."""


def with_files(manifest: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """Return a manifest with the files of another one as well."""
    return {**manifest, "files": dict(sorted({**other.get("files", {}), **manifest["files"]}.items()))}


def differences(theirs: Mapping[str, Any], ours: Mapping[str, Any], words: Wording) -> list[str]:
    """Return a line for each difference of what was requested; a file that only later robots read is read here."""
    gone = {path: digest for path, digest in theirs["files"].items() if path not in ours["files"]}
    changed = [path for path, digest in ours["files"].items() if theirs["files"].get(path) != digest]
    lines = [f"'{path}' changed" for path in sorted((*changed, *changed_files(gone)))]
    names = [name for name in ours if name != "files" and theirs.get(name) != ours[name]]
    if lines or set(names).difference(_FOLLOWING):
        names = [name for name in names if name not in _FOLLOWING]
    return [*lines, *(f"{_named(name, words)}: {_difference(name, theirs.get(name), ours[name])}" for name in names)]


def _difference(name: str, theirs: Any, ours: Any) -> str:
    if name == "values":  # a digest
        return "another table, or none" if None in (theirs, ours) else "the table changed"
    if name == "function_source":
        return "it changed"
    before, now = _beyond(theirs, ours), _beyond(ours, theirs)
    if before == now:  # in another order
        before, now = theirs, ours
    return f"{_shown(before)} before, {_shown(now)} now"


def _named(entry: str, words: Wording) -> str:
    if entry == "linkforge":
        return "the version of linkforge"
    if entry == "function_source":
        return "function"
    if words.is_python:
        return "grid" if entry == "set" else entry
    return _OPTIONS.get(entry, entry)


def _beyond(one: Any, other: Any) -> Any:
    """Return what the first of two lists or maps has beyond the other; a value as it is."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return [f"{name}={text}" for name, text in one.items() if other.get(name) != text]
    if isinstance(one, list) and isinstance(other, list):
        return [text for text in one if text not in other]
    return one


def _shown(value: Any) -> str:
    if not value and not isinstance(value, int):
        return "nothing"
    text = " ".join(value) if isinstance(value, list) else str(value)
    return text if len(text) <= 100 else f"{text[:60]}…{text[-30:]}"
