"""Modules that declare pairs of their own links: what they know of themselves is not sampled again."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkforge_compile.core.models.robot import Robot
    from linkforge_compile.core.models.srdf_collisions import CollisionPair


def is_own(pair: CollisionPair) -> bool:
    """Whether a pair is declared in the compiled file or its includes, and not by a module."""
    return pair.source is None or not pair.source.modules


class KnownModules:
    """The modules of a robot that declare pairs."""

    def __init__(self, robot: Robot) -> None:
        known = {pair.source.modules for pair in robot.semantic.disabled_collisions if pair.source and not is_own(pair)}
        self._modules: dict[str, set[tuple[str, ...]]] = {}
        for link in robot.links:
            own = link.source.modules if link.source else ()
            self._modules[link.name] = {module for module in known if own[: len(module)] == module}

    def hold(self, one: str, other: str) -> bool:
        """Whether two links are in one module that declares pairs, or in modules that it uses."""
        return bool(self._modules[one] & self._modules[other])
