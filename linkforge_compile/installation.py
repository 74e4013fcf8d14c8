"""What is installed: linkforge, the packages that it needs and those of its extras."""

from __future__ import annotations

import re
from importlib.metadata import PackageNotFoundError, requires, version
from typing import NamedTuple

DISTRIBUTION = "linkforge-compile"

_REQUIREMENT = re.compile(r"([\w.-]+)(?:\[([\w,-]+)\])?([^;]*)(?:;.*?\bextra == ['\"]([\w-]+)['\"])?")
"""A requirement in the metadata of a package: its name, extras, versions, and the extra that it is of."""


class Requirement(NamedTuple):
    """A package that linkforge or one of its extras needs; `version` is the installed one, None if it is missing."""

    name: str
    versions: str
    version: str | None


def requirements() -> dict[str, list[Requirement]]:
    """Return what linkforge needs (under "") and what each extra needs, by the metadata that pip installed.

    Empty without metadata. An extra that is made of others has what they need.
    """
    found: dict[str, list[Requirement]] = {"": []}
    included: dict[str, list[str]] = {}
    try:
        listed = requires(DISTRIBUTION) or []
    except PackageNotFoundError:
        return {}
    for text in listed:
        if not (match := _REQUIREMENT.match(text)):
            continue
        name, extras, versions, extra = match.groups()
        if name == DISTRIBUTION:
            included.setdefault(extra, []).extend(extras.split(","))
        else:
            found.setdefault(extra or "", []).append(Requirement(name, versions.strip(), installed_version(name)))
    for extra, others in included.items():
        found[extra] = [*found.get(extra, []), *(one for other in others for one in found.get(other, []))]
    return found


def installed_version(name: str) -> str | None:
    """Return the version of an installed package, None if it is missing."""
    try:
        return version(name)
    except PackageNotFoundError:
        return None
