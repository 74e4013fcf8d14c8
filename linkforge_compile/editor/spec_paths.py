"""The specs of a workspace as its files name them, in definitions that files share.

A path from a file is `../` as often as one goes up to a folder, and the way down from there. So what is offered of a
folder is the same for all files that lie as far below it, and the schema grows with the specs, not with their square.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from linkforge_compile.editor.module_words import where_used
from linkforge_compile.editor.words import snippet
from linkforge_compile.schema.json_types import Json, Schema


class SpecPaths:
    """Offers for the specs of a workspace; `made` are the definitions that they need."""

    def __init__(self, entries: Mapping[str, Schema], *, kind: str = "spec", is_list: bool = False) -> None:
        """`entries` say for each spec, by its path from the workspace, what to offer where it is used.

        `kind` is what they are called; two of one kind would make definitions of the same names. Where `is_list`,
        files name several of them in a list.
        """
        self._kind = kind
        self._is_list = is_list
        self._entries = {spec: entries[spec] for spec in sorted(entries)}
        self._below: dict[str, tuple[str, ...]] = {}
        self._names: dict[tuple[object, ...], str] = {}
        self.made: Schema = {}

    def entries_from(self, folder: str) -> list[Json]:
        """Return what to offer in the entries that use a spec, as a file in the folder names it."""
        return [self._entries_below(above, steps_up) for above, steps_up, _ in _ways_up(folder)]

    def paths_from(self, folder: str, left_out: Collection[str]) -> Schema:
        """Return what offers a file in the folder the paths of specs, each once; an empty schema for none."""
        offers: list[Json] = []
        for above, steps_up, branch in _ways_up(folder):
            out = {*left_out, *(() if branch is None else self._specs_below(branch))}
            places = [place for place, spec in enumerate(self._specs_below(above)) if spec not in out]
            offers += [self._path_block(above, steps_up, *block) for block in _blocks(places)]
        return {"allOf": offers} if offers else {}

    def _specs_below(self, folder: str) -> Sequence[str]:
        if folder not in self._below:
            self._below[folder] = tuple(spec for spec in self._entries if spec.startswith(_way_to(folder)))
        return self._below[folder]

    def _entries_below(self, above: str, steps_up: int) -> Schema:
        key = (above, steps_up)
        if key not in self._names:
            below = self._specs_below(above)
            used: list[Json] = [where_used(_path(above, steps_up, spec), self._entries[spec]) for spec in below]
            self._define(key, "modules_from", {"allOf": used})
        return {"$ref": f"#/definitions/{self._names[key]}"}

    def _path_block(self, above: str, steps_up: int, first: int, size: int) -> Schema:
        """Return what offers the paths to specs below a folder that follow each other: to one, or in two halves."""
        key = (above, steps_up, first, size)
        if key not in self._names:
            if size == 1:
                path = _path(above, steps_up, self._specs_below(above)[first])
                named: Schema = {"defaultSnippets": [snippet(path, f"a {self._kind}")]}
                offer: Schema = {"items": named} if self._is_list else named
            else:
                half = size // 2
                offer = {"allOf": [self._path_block(above, steps_up, at, half) for at in (first, first + half)]}
            self._define(key, f"paths_of_{self._kind}", offer)
        return {"$ref": f"#/definitions/{self._names[key]}"}

    def _define(self, key: tuple[object, ...], kind: str, schema: Schema) -> None:
        self._names[key] = f"{kind}_{len(self._names) + 1}"
        self.made[self._names[key]] = schema


def _ways_up(folder: str) -> Iterator[tuple[str, int, str | None]]:
    """Yield a folder and each above it, how many steps up that is, and the one below it on the way, None for none."""
    steps = folder.split("/") if folder else []
    for steps_up in range(len(steps) + 1):
        above = len(steps) - steps_up
        yield "/".join(steps[:above]), steps_up, "/".join(steps[: above + 1]) if steps_up else None


def _way_to(folder: str) -> str:
    return f"{folder}/" if folder else ""


def _path(above: str, steps_up: int, spec: str) -> str:
    return "../" * steps_up + spec.removeprefix(_way_to(above))


def _blocks(places: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the first place and the size of the largest blocks that make up the places, in order.

    A block begins at a multiple of its size, a power of two, so that others that leave out little have the same ones.
    """
    there = set(places)
    at = 0
    while at < len(places):
        first, size = places[at], 1
        while first % (2 * size) == 0 and there.issuperset(range(first, first + 2 * size)):
            size *= 2
        yield first, size
        at += size
