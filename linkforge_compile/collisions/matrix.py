"""Decide which pairs of a robot's links need no check: those that a file declares, and those found by sampling."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkforge_compile.collisions.meshes import find_meshes
from linkforge_compile.collisions.sampling import ALWAYS_SHARE, Finding, Progress, SamplingSettings, find_reasons
from linkforge_compile.collisions.scene import KnownModules, Names, Reason, comparable_pairs, is_own, make_scene
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf_collisions import CollisionPair
from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.collisions import HIDDEN_COLLISIONS


class Matrix(NamedTuple):
    """The pairs that the file of a robot should disable, with their reasons, and the sampled ones that need a check.

    Their links are in the order of the robot's. The pairs that modules declare are in neither.
    """

    disabled: Mapping[Names, str | None]
    checked: tuple[Names, ...]


def find_matrix(
    robot: Robot, settings: SamplingSettings, progress: Progress, sink: Diagnostics, *, is_all: bool = False
) -> Matrix | None:
    """Sample a robot that has no errors; None if a shape is unknown, which is reported.

    A pair that its file declares with a reason of its own stays, and one that it enables is not disabled. A module
    that declares pairs knows itself: pairs inside it are not sampled, unless with `is_all`.
    """
    paths = find_meshes(robot, sink)
    if sink.has_errors:
        return None
    scene = make_scene(robot, paths)
    names = _Names(robot)
    declared = {names.ordered(pair.link1, pair.link2): pair for pair in robot.semantic.disabled_collisions}
    enabled = {names.ordered(pair.link1, pair.link2) for pair in robot.semantic.enabled_collisions}
    modules = KnownModules(robot)
    comparable = {
        names.ordered(scene[one].link, scene[other].link): (one, other) for one, other in comparable_pairs(scene)
    }
    unknown = [
        pair for pair in comparable if not _is_settled(declared.get(pair)) and (is_all or not modules.hold(*pair))
    ]
    sampled = [pair for pair in unknown if pair not in enabled]
    findings = find_reasons(scene, [comparable[pair] for pair in sampled], settings, progress)
    found = {pair: findings[comparable[pair]] for pair in sampled if comparable[pair] in findings}
    sink.report_all(_hidden_collisions(robot, found, declared))
    with_shapes = {body.link for body in scene if body.shapes}
    kept = {
        pair: each.reason
        for pair, each in declared.items()
        if is_own(each) and pair not in unknown and (_is_settled(each) or with_shapes.issuperset(pair))
    }
    reasons = {pair: str(finding.reason) for pair, finding in found.items()} | kept
    disabled = {pair: reasons[pair] for pair in sorted(reasons, key=names.order)}
    return Matrix(disabled, tuple(sorted((pair for pair in unknown if pair not in found), key=names.order)))


def _hidden_collisions(
    robot: Robot, found: Mapping[Names, Finding], declared: Mapping[Names, CollisionPair]
) -> Iterator[Diagnostic]:
    """Yield the pairs whose check is off because of the default pose, although most samples are free."""
    for pair, finding in found.items():
        if finding.reason == Reason.DEFAULT and finding.share is not None and finding.share < ALWAYS_SHARE:
            place = (declared[pair].source,) if pair in declared else (robot.source, "name")
            yield HIDDEN_COLLISIONS.at(*place, pair=" and ".join(pair))


def _is_settled(pair: CollisionPair | None) -> bool:
    """Whether a declared pair is not sampled: a module declares it, or a person gave its reason."""
    return pair is not None and (not is_own(pair) or pair.reason not in set(Reason))


def own_pairs(robot: Robot) -> dict[Names, str | None]:
    """Return the pairs that the file of a robot declares, and not its modules, with their reasons."""
    names = _Names(robot)
    return {
        names.ordered(pair.link1, pair.link2): pair.reason
        for pair in robot.semantic.disabled_collisions
        if is_own(pair)
    }


class _Names:
    """The order of a robot's links."""

    def __init__(self, robot: Robot) -> None:
        self._places = {link.name: place for place, link in enumerate(robot.links)}

    def order(self, pair: Names) -> tuple[int, int]:
        return self._place(pair[0]), self._place(pair[1])

    def ordered(self, one: str, other: str) -> Names:
        return (one, other) if self._place(one) < self._place(other) else (other, one)

    def _place(self, link: str) -> int:
        # The SRDF of a vendor may name links that the robot lacks.
        return self._places.get(link, len(self._places))
