"""Completions for the paths of a workspace's specs, in definitions that the files share.

A relative path is `../` for each folder that one goes up, and the way down from there. So all files at the same depth
below a folder share the completions for its specs, and the schema grows with the number of specs, not its square.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from linkforge_compile.editor.completions import if_used, snippet
from linkforge_compile.schema.json_schema import Json, Schema


class SpecPaths:
    """Completions for the specs of a workspace; `definitions` collects the definitions to which they refer."""

    def __init__(self, entries: Mapping[str, Schema], *, kind: str = "spec", is_list: bool = False) -> None:
        """`entries` has the completion for an entry that uses a spec, by its path from the workspace.

        `kind` is the word for the specs, and part of the names of definitions. `is_list` says that a file names several
        of them in a list.
        """
        self._kind = kind
        self._is_list = is_list
        self._entries = {spec: entries[spec] for spec in sorted(entries)}
        self._below: dict[str, tuple[str, ...]] = {}
        self._names: dict[tuple[object, ...], str] = {}
        self.definitions: Schema = {}

    def entries_from(self, folder: str) -> list[Json]:
        """Return the completions for entries that use a spec, in a file in the folder."""
        return [self._entries_below(above, steps_up) for above, steps_up, _ in _ways_up(folder)]

    def paths_from(self, folder: str, left_out: Collection[str]) -> Schema:
        """Return the completion of a path in a file in the folder, with each other spec once; {} for none."""
        blocks: list[Json] = []
        for above, steps_up, branch in _ways_up(folder):
            out = {*left_out, *(() if branch is None else self._specs_below(branch))}
            indices = [index for index, spec in enumerate(self._specs_below(above)) if spec not in out]
            blocks += [self._path_block(above, steps_up, *block) for block in _blocks(indices)]
        return {"allOf": blocks} if blocks else {}

    def _specs_below(self, folder: str) -> Sequence[str]:
        if folder not in self._below:
            self._below[folder] = tuple(spec for spec in self._entries if spec.startswith(_with_slash(folder)))
        return self._below[folder]

    def _entries_below(self, above: str, steps_up: int) -> Schema:
        key = (above, steps_up)
        if key not in self._names:
            below = self._specs_below(above)
            used: list[Json] = [if_used(_path(above, steps_up, spec), self._entries[spec]) for spec in below]
            self._define(key, "modules_from", {"allOf": used})
        return {"$ref": f"#/definitions/{self._names[key]}"}

    def _path_block(self, above: str, steps_up: int, first: int, size: int) -> Schema:
        """Return the completion of the paths to `size` specs below a folder: of one path, or of two halves."""
        key = (above, steps_up, first, size)
        if key not in self._names:
            if size == 1:
                path = _path(above, steps_up, self._specs_below(above)[first])
                named: Schema = {"defaultSnippets": [snippet(path, f"a {self._kind}")]}
                block: Schema = {"items": named} if self._is_list else named
            else:
                half = size // 2
                block = {"allOf": [self._path_block(above, steps_up, at, half) for at in (first, first + half)]}
            self._define(key, f"paths_of_{self._kind}", block)
        return {"$ref": f"#/definitions/{self._names[key]}"}

    def _define(self, key: tuple[object, ...], kind: str, schema: Schema) -> None:
        self._names[key] = f"{kind}_{len(self._names) + 1}"
        self.definitions[self._names[key]] = schema


def _ways_up(folder: str) -> Iterator[tuple[str, int, str | None]]:
    """Yield a folder and each above it, with the number of steps up and the folder below it on the way, if any."""
    steps = folder.split("/") if folder else []
    for steps_up in range(len(steps) + 1):
        above = len(steps) - steps_up
        yield "/".join(steps[:above]), steps_up, "/".join(steps[: above + 1]) if steps_up else None


def _with_slash(folder: str) -> str:
    return f"{folder}/" if folder else ""


def _path(above: str, steps_up: int, spec: str) -> str:
    return "../" * steps_up + spec.removeprefix(_with_slash(above))


def _blocks(indices: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the first index and the size of the largest blocks that make up the indices, in order.

    A block begins at a multiple of its size, which is a power of two, so that lists with few gaps share most blocks.
    """
    present = set(indices)
    at = 0
    while at < len(indices):
        first, size = indices[at], 1
        while first % (2 * size) == 0 and present.issuperset(range(first, first + 2 * size)):
            size *= 2
        yield first, size
        at += size
