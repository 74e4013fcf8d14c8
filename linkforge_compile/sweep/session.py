"""Run a plan: compile what is not done yet, write it, and tell what went wrong."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

from linkforge_compile.file_watcher import FileWatcher
from linkforge_compile.sweep.bundle import Bundle, Files, changed_files
from linkforge_compile.sweep.connection import cluster
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.sweep.place import Place
from linkforge_compile.sweep.plan import Plan
from linkforge_compile.sweep.points import Point
from linkforge_compile.sweep.scheduler import Cluster
from linkforge_compile.sweep.store import Chunk, Store, chunks_of
from linkforge_compile.sweep.wording import Wording
from linkforge_compile.sweep.work import ABOUT_FILES, Made, Request, compile_point, files_of, make, make_all

Progress = Callable[[int, int], None]
"""Takes how many robots are done, and how many of them have errors."""


MAX_GROUPS = 1000
"""How many groups of errors, and how many of warnings, a summary has."""


class Group(NamedTuple):
    """A fault of several robots: the message of the first of them, and how many they are.

    Faults with one code at one place are one, because their messages have the numbers of each robot.
    """

    severity: str
    text: str
    robots: int
    first: Point


@dataclass
class Summary:
    """How many robots a sweep has, how many were compiled now, how many have errors, and the messages by how often.

    `cut_off` are the severities of which there are more groups than MAX_GROUPS; the later ones are omitted.
    """

    robots: int = 0
    compiled: int = 0
    failed: int = 0
    groups: list[Group] = field(default_factory=list)
    cut_off: frozenset[str] = frozenset()


def execute(
    plan: Plan, store: Store, place: Place, packing: str, *, resume: bool, progress: Progress = lambda _done, _bad: None
) -> Summary:
    """Compile all robots of a plan that are not done, write the table, and return the summary."""
    files, words, watcher = collect_files(plan), plan.choice.words, FileWatcher()
    later = f"once it can be written, {words.continuing}"
    with _write_errors(store.folder, "choose another folder"):
        done = store.begin(plan.manifest(files.bundle, packing), words, resume=resume)
    summary = Summary(plan.size)
    if not store.is_finished:
        todo = [chunk for chunk in chunks_of(plan.size, plan.chunk) if chunk not in done]
        count, failed = plan.size - sum(chunk.end - chunk.begin for chunk in todo), 0
        progress(count, failed)
        for chunk, made, bundle in _results(plan, files, place, todo):
            with _write_errors(store.folder, later):
                _require_unchanged(bundle, watcher, words)
                if bundle is not files.bundle:
                    files = files._replace(bundle=bundle)
                    store.update(plan.manifest(bundle, packing))
                store.add(chunk, made)
            count += len(made)
            failed += sum(bool(one.row["errors"]) for one in made)
            summary.compiled += len(made)
            progress(count, failed)
        with _write_errors(store.folder, later):
            store.finish()
    _add_groups(summary, plan, store)
    return summary


@contextmanager
def _write_errors(folder: Path, way_out: str) -> Iterator[None]:
    """Turn an error of the system, such as a full disk, into a SweepError."""
    try:
        yield
    except OSError as error:
        raise SweepError(f"cannot write to '{folder}': {error.strerror or error}; {way_out}") from error


def _require_unchanged(bundle: Bundle, watcher: FileWatcher, words: Wording) -> None:
    """Refuse robots that may be of another text than those in the folder, which then are all of one.

    Files are read once, and again if their time or size changed.
    """
    watcher.track(map(Path, bundle.files), began=0)  # so that it reports each file at first
    if changed := changed_files({str(path): bundle.files[str(path)] for path in watcher.poll()}):
        ways = f"restore it, and {words.continuing}, or remove the folder and start again"
        way = ways if words.has_folder else words.continuing
        raise SweepError(f"'{changed[0]}' changed while the sweep ran; {way}")


def collect_files(plan: Plan) -> Files:
    """Compile the first point, and return the files that it depends on."""
    return with_files_of(plan.request, plan.points_of(Chunk(0, 1))[0], Files(Bundle.of_here(), {}))


def with_files_of(request: Request, point: Point, files: Files) -> Files:
    """Return the files with all that a point depends on."""
    return files.with_paths(files_of(compile_point(request, point)))


Results = Iterator[tuple[Chunk, list[Made], Bundle]]
"""Chunks with what was made of them, in the order in which they are done, and the files on which all depend so far."""


def _results(plan: Plan, files: Files, place: Place, chunks: list[Chunk]) -> Results:
    if not chunks:
        return
    if place.is_here:
        cache = plan.request.new_cache()
        for chunk in chunks:
            made = make_all(plan.request, plan.points_of(chunk), cache=cache)
            files = files.with_paths({path for one in made for path in one.read})
            yield chunk, made, files.bundle
        return
    with cluster(place._replace(jobs=min(place.jobs, len(chunks))), plan.choice.words) as client:
        yield from results_of(plan, files, client, chunks)


def results_of(plan: Plan, files: Files, client: Any, chunks: Iterable[Chunk]) -> Results:
    """Yield what the workers of a client make of chunks."""
    judge = Judge(plan, files.blobs)
    work = Cluster(client, plan.request, files, judge.grow, plan.choice.words)
    for chunk, made in work.run(chunks, plan.points_of):
        yield chunk, [judge.final(one) for one in made], work.bundle


class Judge:
    """Decides whether what a worker reports about files is true, by compiling the point here, where all files are.

    What is true of one point is believed of others.
    """

    def __init__(self, plan: Plan, blobs: dict[str, bytes]) -> None:
        self._plan, self._blobs = plan, blobs
        self._true: set[tuple[str, str]] = set()

    def grow(self, made: list[Made], bundle: Bundle) -> Bundle:
        """Return the bundle with the files that points read here, the same one if it has them all.

        Of points that lack the same, one is compiled.
        """
        files, explained = Files(bundle, self._blobs), set[tuple[str, str]]()
        for one in made:
            if not (self._is_true(one) or explained.issuperset(lacking := _about_files(one))):
                explained.update(lacking)
                files = with_files_of(self._plan.request, one.point, files)
        return files.bundle

    def final(self, one: Made) -> Made:
        """Return what was made of a point, here if it may lack a file where it was made."""
        if self._is_true(one):
            return one
        own = make(self._plan.request, one.point)
        self._true.update(_about_files(own))
        return own

    def _is_true(self, one: Made) -> bool:
        return not one.is_about_files or self._true.issuperset(_about_files(one))


def _about_files(one: Made) -> list[tuple[str, str]]:
    """Return the diagnostics of a point that may be about files."""
    messages = [_message(each) for each in json.loads(str(one.row["diagnostics"])) if each["code"]]
    return [each for each in messages if any(f"[{code}" in each[1] for code in ABOUT_FILES)]


def _add_groups(summary: Summary, plan: Plan, store: Store) -> None:
    """Add how many robots have errors, and the messages of all, the most frequent error first."""
    found: dict[str, dict[tuple[object, ...], Group]] = {}
    cut_off = set[str]()
    for row in chain.from_iterable(store.batches(("index", "errors", "warnings", "diagnostics"))):
        summary.failed += bool(row["errors"])
        if not (row["errors"] or row["warnings"]):
            continue
        for kind, one in {_kind(one): one for one in reversed(json.loads(str(row["diagnostics"])))}.items():
            groups = found.setdefault(one["severity"], {})
            if known := groups.get(kind):
                groups[kind] = known._replace(robots=known.robots + 1)
            elif len(groups) < MAX_GROUPS:
                groups[kind] = Group(*_message(one), 1, plan.points[int(row["index"] or 0)])
            else:
                cut_off.add(one["severity"])
    groups_of_all = [one for groups in found.values() for one in groups.values()]
    summary.groups = sorted(groups_of_all, key=lambda one: (one.severity, -one.robots, one.first.index))
    summary.cut_off = frozenset(cut_off)


def _kind(one: Mapping[str, object]) -> tuple[object, ...]:
    return (one["code"], one["file"], one["line"], one["column"]) if one["file"] else (one["code"], one["message"])


def _message(one: Mapping[str, object]) -> tuple[str, str]:
    place = f"{one['file']}:{one['line']}:{one['column']}: " if one["file"] else ""
    code = f"[{one['code']}] " if one["code"] else ""
    return str(one["severity"]), f"{place}{code}{one['message']}"
