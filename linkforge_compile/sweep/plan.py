"""Decide what a sweep does, before it does anything: its points, its request, and what its manifest says."""

from __future__ import annotations

import inspect
from array import array
from collections.abc import Callable, Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from linkforge_compile._version import __version__
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import UNKNOWN_PARAMETER
from linkforge_compile.expand.arguments import arguments_from_text, names_in_variant
from linkforge_compile.expand.parameters import Parameter
from linkforge_compile.load import is_xacro
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.sweep.axes import VARIANT, Axis, AxisReader, Varied, too_many
from linkforge_compile.sweep.bundle import Bundle
from linkforge_compile.sweep.condition import Condition
from linkforge_compile.sweep.declared import Declared, declared_by
from linkforge_compile.sweep.errors import MAX_POINTS, SweepError
from linkforge_compile.sweep.points import Grid, Point, Points, Samples
from linkforge_compile.sweep.rows import reserved_columns
from linkforge_compile.sweep.store import Chunk
from linkforge_compile.sweep.value_table import read_values
from linkforge_compile.sweep.wording import Wording
from linkforge_compile.sweep.work import Function, Request

_CHUNK = 100
"""The most points of a chunk; a sweep of few points has smaller ones, for several workers."""

_CHUNKS = 32


class Choice(NamedTuple):
    """What to vary, as the options say it.

    - `sets`: texts of `--set`.
    - `variants`: an axis of variants if there are several.
    - `values`: a CSV or Parquet file, whose rows are combined with every `--set`.
    - `where`: an expression that a point must fulfil.
    - `sample`: how many random points, None for a grid.
    - `words`: how messages name all this.
    """

    sets: tuple[str, ...] = ()
    variants: tuple[str, ...] = ()
    values: Path | None = None
    where: str | None = None
    sample: int | None = None
    seed: int = 0
    max_points: int = MAX_POINTS
    chunk: int | None = None
    words: Wording = Wording()


class Plan(NamedTuple):
    """A sweep that can be run.

    - `kept`: the indices of the points that fulfil `where`, None for all.
    - `values_digest`: the digest of the table of values as the points have it, None without one.
    - `function_source`: the digest of the text of the user's function, None where Python does not have it.
    """

    request: Request
    choice: Choice
    points: Points
    kept: Sequence[int] | None
    chunk: int
    has_variants: bool
    values_digest: str | None = None
    function_source: str | None = None

    @property
    def size(self) -> int:
        """How many robots are compiled."""
        return len(self.points) if self.kept is None else len(self.kept)

    def points_of(self, chunk: Chunk) -> list[Point]:
        """Return the points of a chunk that are compiled."""
        if self.kept is None:
            return [self.points[index] for index in range(chunk.begin, chunk.end)]
        return [self.points[self.kept[at]] for at in range(chunk.begin, chunk.end)]

    def manifest(self, bundle: Bundle, packing: str) -> dict[str, object]:
        """Return what must agree for a sweep to be continued; paths are as typed."""
        request, choice = self.request, self.choice
        function = request.function
        return {
            "version": 1,
            "linkforge": __version__,
            "spec": request.spec,
            "files": {_shown(path, bundle.folder): digest for path, digest in sorted(bundle.files.items())},
            "parameters": list(request.parameters),
            "set": list(choice.sets),
            "variants": list(choice.variants),
            "values": self.values_digest,
            "where": choice.where,
            "sample": choice.sample,
            "seed": choice.seed if choice.sample is not None else None,
            "points": len(self.points),
            "robots": self.size,
            "formats": list(request.formats),
            "options": dict(request.options),
            "packages": dict(request.packages),
            "allow_outside": request.allow_outside,
            "chunk": self.chunk,
            "output": packing,
            "function": getattr(function, "__qualname__", repr(function)) if function else None,
            "function_source": self.function_source,
        }


def plan_of(request: Request, choice: Choice, checked: Callable[[int, int], None] = lambda _done, _of: None) -> Plan:
    """Return the plan of a sweep; SweepError for all that is wrong with what was requested.

    `checked` is called with the number of points for which `where` was computed, and that of all.
    """
    spec = Path(request.spec)
    declared, sink = declared_by(spec, request.settings(Point(0, {}))), Diagnostics()
    varied = _varied(declared, choice, _fixed_names(request), sink)
    if not is_xacro(spec):
        for name, entry in arguments_from_text(request.parameters, sink).entries.items():
            if name not in declared.parameters:
                where = Span(SourceFile("<parameters>", name), 1, 1, 1, 1 + len(name))
                span = where if choice.words.is_python else entry.key.span
                sink.report(UNKNOWN_PARAMETER.at(span, name=name, near=declared.parameters, notes=()))
    if sink.has_errors:
        raise SweepError("the values of the sweep are wrong", sink.sorted())
    axes, parameters = list(varied.axes), dict(varied.parameters)
    _require_variation(varied, choice, declared)
    _require_values(declared, request, parameters, choice)
    if clashing := reserved_columns().intersection(parameters):
        raise SweepError(f"'{min(clashing)}' is the name of a column of every table, so it cannot be varied")
    points = _points(axes, varied, choice)
    if len(points) > choice.max_points:
        raise SweepError(too_many(len(points), choice.max_points, choice.words))
    has_variants = any(VARIANT in axis.names for axis in axes)
    request = request._replace(columns=parameters)
    kept = None if choice.where is None else _kept(choice, request, points, checked)
    count = len(points) if kept is None else len(kept)
    chunk = choice.chunk or max(1, min(_CHUNK, -(-count // _CHUNKS)))
    digests = _digest_of(choice.values), _source_digest(request.function)
    return Plan(request, choice, points, kept, chunk, has_variants, *digests)


def _varied(declared: Declared, choice: Choice, fixed: frozenset[str], sink: Diagnostics) -> Varied:
    words, is_sample = choice.words, choice.sample is not None
    reader = AxisReader(declared, sink, words, samples=is_sample, max_points=choice.max_points)
    for text in choice.sets:
        reader.read(text)
    if is_sample:
        if choice.values is not None:
            names = words.option("sample"), words.option("values")
            raise SweepError(f"{names[0]} draws values and {names[1]} lists them; use one of them")
        reader.add_own_limits(fixed)
    axes, parameters = reader.axes, dict(reader.parameters)
    if choice.values is not None:
        axis, columns = read_values(choice.values, declared, sink, words)
        if twice := set(columns).intersection(parameters):
            raise SweepError(
                f"'{min(twice)}' is varied by {words.varied(min(twice), '…')} and by a column of '{choice.values}'"
            )
        if VARIANT in axis.names and choice.variants:
            raise SweepError(
                f"{words.option('variants' if words.is_python else 'variant')} and a column of '{choice.values}' both "
                "select variants; leave one of them out"
            )
        axes, parameters = [*axes, axis], parameters | dict(columns)
    _check_variants(choice.variants, declared)
    if len(choice.variants) > 1:
        axes = [*axes, Axis((VARIANT,), [(name,) for name in choice.variants])]
    if both := fixed.intersection(parameters):
        name = min(both)
        raise SweepError(f"'{name}' is varied, and set for all robots with {words.fixed(name)}; leave one of them out")
    return Varied(tuple(axes), tuple(reader.intervals), parameters)


def _check_variants(variants: Sequence[str], declared: Declared) -> None:
    from linkforge_compile.diagnostics.suggest import did_you_mean

    for name in (name for text in variants for name in names_in_variant(text, declared.variants)):
        if name not in declared.variants:
            hint = did_you_mean(name, declared.variants) or (
                f"; there are {', '.join(declared.variants)}" if declared.variants else "; the spec declares none"
            )
            raise SweepError(f"there is no variant '{name}'{hint}")


def _fixed_names(request: Request) -> frozenset[str]:
    return frozenset(pair.partition("=")[0].removesuffix(":").strip() for pair in request.parameters)


def _require_variation(varied: Varied, choice: Choice, declared: Declared) -> None:
    if varied.axes or varied.intervals:
        return
    names = ", ".join(declared.parameters) or "none"
    words = choice.words
    if choice.sample is not None:
        way = words.varied("NAME", "LO:HI")
        raise SweepError(f"no parameter has limits to sample between; write {way} (parameters: {names})")
    ways = words.varied("NAME", "START:STOP:COUNT"), words.varied("NAME", "VALUE,VALUE")
    raise SweepError(f"nothing is varied; write {ways[0]} or {ways[1]} (parameters: {names})")


def _require_values(declared: Declared, request: Request, varied: Mapping[str, Parameter], choice: Choice) -> None:
    """Refuse a sweep in which no robot has a value for a required parameter."""
    missing = declared.required - _fixed_names(request) - set(varied)
    if missing and not choice.variants and request.variant is None:
        name = min(missing)
        ways = choice.words.varied(name, "…"), choice.words.fixed(name)
        raise SweepError(f"'{name}' has no default; vary it with {ways[0]}, or set it for all with {ways[1]}")


def _points(axes: Sequence[Axis], varied: Varied, choice: Choice) -> Points:
    if choice.sample is None:
        return Grid(axes)
    return Samples(axes, varied.intervals, choice.sample, choice.seed)


def _kept(choice: Choice, request: Request, points: Points, checked: Callable[[int, int], None]) -> Sequence[int]:
    """Return the indices of the points that fulfil the condition."""
    condition = Condition(choice.where or "", Path(request.spec), request.settings, request.columns, choice.words)
    kept = array("Q")
    for index in range(len(points)):
        if condition.holds(points[index]):
            kept.append(index)
        checked(index + 1, len(points))
    if not kept:
        what = f"{choice.words.option('where')} '{choice.where}'"
        raise SweepError(f"{what} is true at no point, so there is no robot to compile")
    return kept


def _digest_of(path: Path | None) -> str | None:
    return None if path is None else sha256(path.read_bytes()).hexdigest()


def _source_digest(function: Function | None) -> str | None:
    try:
        return sha256(inspect.getsource(function).encode()).hexdigest() if function else None
    except (OSError, TypeError):  # of an interactive session, or an object that can be called
        return None


def _shown(path: str, folder: str) -> str:
    return path.removeprefix(folder).lstrip("/") if path.startswith(f"{folder}/") else path
