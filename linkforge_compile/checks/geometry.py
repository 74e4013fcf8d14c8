"""Links have shapes to be seen and shapes to be touched."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkforge_compile.checks.references import SHOWN, listed
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Code, Diagnostic, Note, UnresolvedNames
from linkforge_compile.diagnostics.codes.physics import UNSEEN_COLLISIONS, UNTOUCHED_VISUALS
from linkforge_compile.source import Key


def check_untouched_visuals(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """What has mass and can be seen can be touched.

    A link with a visual and no collision passes through everything in a simulator, and planners never see it in
    their way. Write `collision: visual`, or simpler shapes. Told once for all such links; not where no link of the
    robot has a collision, nor of links without mass, which are ornaments.
    """
    if not unresolved and any(link.collisions for link in robot.links):
        links = [link for link in robot.links if link.mass and link.visuals and _has_no(link, "collision")]
        yield from _told_together(links, "visual", UNTOUCHED_VISUALS)


def check_unseen_collisions(robot: Robot, unresolved: UnresolvedNames) -> Iterator[Diagnostic]:
    """What has mass and can be touched can be seen.

    A link with a collision and no visual stops a robot at nothing that anybody sees. Give it a visual. Told once for
    all such links; not where no link of the robot has a visual, nor of links without mass.
    """
    if not unresolved and any(link.visuals for link in robot.links):
        links = [link for link in robot.links if link.mass and link.collisions and _has_no(link, "visual")]
        yield from _told_together(links, "collision", UNSEEN_COLLISIONS)


def _has_no(link: Link, key: str) -> bool:
    """Whether a link has no shape of a kind, and none that was left out because it was faulty."""
    shapes = link.collisions if key == "collision" else link.visuals
    return not shapes and (link.source is None or link.source.node.child(key) is None)


def _told_together(links: Sequence[Link], key: str, code: Code) -> Iterator[Diagnostic]:
    if not links:
        return
    first, *others = links
    notes = [Note(f"link '{link.name}'", link.source.at(Key(key))) for link in others[:SHOWN] if link.source]
    yield code.at(first.source, Key(key), links=_counted([link.name for link in links]), notes=notes)


def _counted(names: Sequence[str]) -> str:
    return f"link {listed(names)} has" if len(names) == 1 else f"links {listed(names)} have"
