"""Modules that declare pairs of their own links: what they know of themselves is not sampled again."""

from __future__ import annotations

from collections import defaultdict
from typing import NamedTuple

from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf_collisions import CollisionPair
from linkforge_compile.source import SourceRef, Span


def is_own(pair: CollisionPair) -> bool:
    """Whether a pair is declared in the compiled file or its includes, and not by a module."""
    return pair.source is None or not pair.source.trail


class _Module(NamedTuple):
    """A module that is used once: the `use` that led to it, from the inside out, and the prefix of its names.

    Several modules that a `for` makes have the same `use`.
    """

    trail: tuple[Span, ...]
    prefix: str


class KnownModules:
    """The modules of a robot that declare pairs."""

    def __init__(self, robot: Robot) -> None:
        known = {_module_of(pair.source, pair.link2) for pair in robot.semantic.disabled_collisions if not is_own(pair)}
        self._modules: dict[str, set[_Module]] = defaultdict(set)
        for link in robot.links:
            self._modules[link.name] = {module for module in known if module and _holds(module, link)}

    def hold(self, one: str, other: str) -> bool:
        """Whether two links are in one module that declares pairs, or in modules that it uses."""
        return bool(self._modules[one] & self._modules[other])


def _module_of(source: SourceRef | None, name: str) -> _Module | None:
    """Return the module that declares a link or a pair with this last name."""
    # The node of a key is a scalar of YAML or of a URDF, whose text is the name without prefixes.
    written = getattr(source.key, "text", None) if source else None
    return _Module(source.trail, name.removesuffix(written)) if source and isinstance(written, str) else None


def _holds(module: _Module, link: Link) -> bool:
    own = _module_of(link.source, link.name)
    if own is None or own.trail[-len(module.trail) :] != module.trail or not link.name.startswith(module.prefix):
        return False
    return len(own.trail) > len(module.trail) or own.prefix == module.prefix
