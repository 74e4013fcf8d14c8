"""Two robots drawn over each other: the scenes of the new and the old robot, and their differences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkforge_compile.compare import Difference, Kind, RemovedName, removed_parts
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.view.files import MAX_ALL_BYTES, RobotFiles, collect_files
from linkforge_compile.view.scene import Scene, SceneDifference, SceneLink, make_scene

_STRENGTH = (Kind.CHANGED, Kind.RENAMED, Kind.MOVED, Kind.ADDED, Kind.REMOVED)
"""If a link has several kinds of differences, the one that comes last here is shown."""


def make_comparison(
    before: Robot,
    after: Robot,
    labels: tuple[str, str],
    differences: Sequence[Difference],
    removed: Sequence[RemovedName] = (),
) -> tuple[Scene, RobotFiles]:
    """Return the scene of two robots with the files of both.

    `labels` are the names of the robots in headings, `differences` those of `compare`, and `removed` the public names
    that were removed. A difference in a joint is shown at its child link.
    """
    found = [_scene_difference(one, before, after) for one in differences]
    # Files with the same name may have different contents.
    files_before, files = (collect_files(robot, MAX_ALL_BYTES // 2) for robot in (before, after))
    scene_before, scene = make_scene(before, files_before), make_scene(after, files)
    found += _other_contents(scene_before, scene, found)
    missing = [one for one in scene_before["missing"] if one not in scene["missing"]]
    both: Scene = {
        **scene,
        "files": {**scene_before["files"], **scene["files"]},
        "missing": [*scene["missing"], *missing],
        "comparison": {
            "before": {**scene_before, "files": {}, "missing": []},
            "labels": labels,
            "differences": found,
            "removed": [{"kind": kind, "text": text} for kind, text in removed_parts(removed)],
            "kinds": _kinds(found),
            "links": _renamed("links", differences),
            "joints": _renamed("joints", differences),
        },
    }
    return both, files._replace(files={**files_before.files, **files.files})


def _other_contents(before: Scene, after: Scene, found: Sequence[SceneDifference]) -> Iterator[SceneDifference]:
    """Yield a difference for each link of which only the content of files changed."""
    known, was = {one["link"] for one in found}, {link["name"]: link for link in before["links"]}
    for link in after["links"]:
        other = was.get(link["name"])
        if other and link["name"] not in known and _files_of(other) != _files_of(link):
            path = f"links/{link['name']}"
            text = "the content of its meshes or textures differs"
            yield {"kind": Kind.CHANGED, "path": path, "text": text, "link": link["name"], "is_whole": False}


def _files_of(link: SceneLink) -> list[str | None]:
    shapes = (*link["visuals"], *link["collisions"])
    return [digest for shape in shapes for digest in (shape.get("file"), shape.get("texture"))]


def _scene_difference(difference: Difference, before: Robot, after: Robot) -> SceneDifference:
    path = "/".join(difference.path)
    return {
        "kind": difference.kind,
        "path": path,
        "text": difference.text,
        "link": _link(difference, before, after),
        "is_whole": len(difference.path) == 2,
    }


def _link(difference: Difference, before: Robot, after: Robot) -> str | None:
    """Return the link at which a difference is shown; None for one of another section."""
    match difference.path:
        case ("links", name, *_):
            return name
        case ("joints", name, *_):
            owner = after if name in after.joints else before
            return owner.joints[name].child if name in owner.joints else None
    return None


def _kinds(differences: Sequence[SceneDifference]) -> dict[str, str]:
    """Return what happened to each link that differs; a new or removed part of a link is a change of the link."""
    kinds: dict[str, Kind] = {}
    for one in differences:
        if (link := one["link"]) is None:
            continue
        is_of_link = one["is_whole"] and one["path"].startswith("links/")
        kind = Kind(one["kind"]) if is_of_link else Kind.CHANGED
        kinds[link] = max(kinds.get(link, kind), kind, key=_STRENGTH.index)
    return {link: kind.value for link, kind in kinds.items()}


def _renamed(section: str, differences: Sequence[Difference]) -> dict[str, str]:
    """Return the new names of links or joints by the old ones."""
    renamed = (one for one in differences if one.kind is Kind.RENAMED and one.path[0] == section)
    return {str(one.before): one.path[1] for one in renamed}
