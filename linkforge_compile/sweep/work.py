"""Compile the points of a chunk: their robots as files, and a row of the table for each."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linkforge_compile.analysis import Settings, analyse_path
from linkforge_compile.banner import banner_of
from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.module_cache import ModuleCache
from linkforge_compile.expand.parameters import Parameter
from linkforge_compile.formats import Rendering, formats_or_default
from linkforge_compile.formats.mesh_paths import meshes_of
from linkforge_compile.shape_files import ShapeFiles
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import on_one_line
from linkforge_compile.sweep.bundle import Tree
from linkforge_compile.sweep.declared import value_of
from linkforge_compile.sweep.points import Point
from linkforge_compile.sweep.rows import Cell, Row, counted, diagnostics_row, digest_of, figures_row
from linkforge_compile.units import Quantity

if TYPE_CHECKING:
    from linkforge_compile.compilation import Compilation

Function: TypeAlias = Callable[[Robot, Mapping[str, object]], object]
"""A user's function of a robot and its values by parameter: SI numbers, strings and booleans.

It returns a number, which becomes the column `result`, a mapping of columns, or None for no columns."""

ABOUT_FILES = ("LF300", "LF3055", "LF3067", "LF3092", "LF601", "LF602", "LF7701", "LF7702", "LF8064", "LF702")
"""The codes, or their beginnings, that may be about a file that a worker does not have."""


class Request(NamedTuple):
    """How to compile every point, as plain values that travel to workers.

    `parameters` are `NAME=VALUE` of all robots. `formats` are the requested ones, none for the default ones. `name`
    begins the names of the files. `columns` are the varied parameters with their types.
    """

    spec: str
    name: str
    parameters: tuple[str, ...] = ()
    variant: str | None = None
    packages: Mapping[str, str] = {}
    options: Mapping[str, str] = {}
    formats: tuple[str, ...] = ()
    allow_outside: bool = False
    columns: Mapping[str, Parameter] = {}
    has_files: bool = True
    function: Function | None = None

    def new_cache(self) -> ModuleCache:
        """Return a cache of the modules of its points, for one process and one tree."""
        return ModuleCache(self.columns)

    def settings(self, point: Point, tree: Tree | None = None) -> Settings:
        """Return the settings of a point; in a tree, the packages lie there."""
        packages = {name: tree.place(path) if tree else path for name, path in self.packages.items()}
        pairs = [*self.parameters, *(f"{name}={text}" for name, text in point.values.items())]
        options, variant = dict(self.options), point.variant or self.variant
        return Settings(
            pairs, packages, variant, options, allow_outside=self.allow_outside and tree is None, formats=self.formats
        )


class Made(NamedTuple):
    """A compiled point: its row, and its files by name, none if it has errors or none are requested.

    `is_about_files` if a diagnostic may be about a file that is missing here and not on the client. `read` are the
    files that it depends on; a tree has no others than those of the client.
    """

    point: Point
    row: Row
    files: Mapping[str, str]
    is_about_files: bool = False
    read: tuple[Path, ...] = ()


def make_all(
    request: Request, points: Sequence[Point], tree: Tree | None = None, cache: ModuleCache | None = None
) -> list[Made]:
    """Compile points, in the client's own folders, or in a tree of its files.

    `cache` has modules of points that were compiled here before.
    """
    with tree.inside() if tree else nullcontext():
        return [make(request, point, tree, cache) for point in points]


def make(request: Request, point: Point, tree: Tree | None = None, cache: ModuleCache | None = None) -> Made:
    """Compile one point; a robot with errors has a row with its diagnostics."""
    compilation = compile_point(request, point, tree, cache)
    hide = tree.top if tree else ""
    values = values_of(request, point)
    row: Row = {"index": point.index, **({} if point.variant is None else {"variant": point.variant})}
    row |= {name: _cell(value) for name, value in values.items()}
    row |= diagnostics_row(compilation.diagnostics, hide)
    is_about_files = any(one.code.id.startswith(ABOUT_FILES) for one in compilation.diagnostics)
    robot, files = compilation.robot, dict[str, str]()
    if robot is not None:
        try:
            files = _render(request, robot, hide)
            row |= figures_row(robot) | {"digest": digest_of(files)}
        except RobotModelError as error:  # a robot that a requested format cannot hold
            row, files = row | _failed(str(error), row), {}
        else:
            row |= _apply(request.function, robot, values, row) if request.function else {}
    return Made(point, row, files if request.has_files else {}, is_about_files, () if tree else files_of(compilation))


def compile_point(
    request: Request, point: Point, tree: Tree | None = None, cache: ModuleCache | None = None
) -> Compilation:
    """Compile the spec at a point."""
    spec, settings = tree.place(request.spec) if tree else request.spec, request.settings(point, tree)
    compilation = analyse_path(spec, settings._replace(cache=cache)).compilation
    # What exceeds a limit with the cache may be within it alone; other errors are the same.
    return analyse_path(spec, settings).compilation if cache and compilation.has_errors else compilation


def files_of(compilation: Compilation) -> tuple[Path, ...]:
    """Return the files that a robot was made from, and those of the meshes that it only names; some may not exist."""
    robot = compilation.robot
    if robot is None:
        return compilation.files
    shapes = ShapeFiles(robot)
    places = (shapes.place(mesh.resource) for mesh in meshes_of(robot))
    return (*compilation.files, *filter(None, places))


def values_of(request: Request, point: Point) -> dict[str, object]:
    """Return the values of a point: numbers in SI units, booleans and strings."""
    place, sink = Span(SourceFile("<sweep>", ""), 1, 1, 1, 1), Diagnostics()
    values: dict[str, object] = {}
    for name, text in point.values.items():
        value = value_of(text, place, request.columns[name], sink)
        values[name] = value.value if isinstance(value, Quantity) else value
    return values


def _cell(value: object) -> Cell:
    return value if isinstance(value, bool | int | float | str) else None


def _render(request: Request, robot: Robot, hide: str) -> dict[str, str]:
    """Return the outputs by the names that `linkforge compile -o FOLDER/` gives them."""
    rendering = Rendering(dict(request.options), banner=banner_of(on_one_line(Path(request.spec).name)))
    files: dict[str, str] = {}
    for one in formats_or_default(request.formats):
        if one.missing(robot) is None:
            for document in one.render(robot, rendering):
                name = f"{request.name}{one.suffix}{document.name and f'/{document.name}'}"
                files[name] = document.text.replace(hide, "") if hide else document.text
    return files


def _apply(function: Function, robot: Robot, values: Mapping[str, object], row: Row) -> Row:
    """Return the columns of a user's function, or its error as a diagnostic."""
    try:
        found = function(robot, values)
    except Exception as error:  # the user's own code may raise anything, and the sweep continues
        return _failed(f"the function raised {type(error).__name__}{_line_of(error)}: {error}", row)
    try:
        return _checked_columns(
            found if isinstance(found, Mapping) else {} if found is None else {"result": found}, row
        )
    except (TypeError, ValueError) as error:
        return _failed(f"what the function returned cannot be kept: {error}", row)


def _line_of(error: Exception) -> str:
    """Return where the function, or what it calls, raised an error; nothing if Python could not call it."""
    import traceback

    _, *frames = traceback.extract_tb(error.__traceback__)
    # A function that was sent to another process has no file there.
    return f" in line {frames[-1].lineno}, in {frames[-1].name}" if frames else ""


def _checked_columns(columns: Mapping[object, object], row: Row) -> Row:
    checked: Row = {}
    for name, value in columns.items():
        if not isinstance(name, str) or name in row:
            raise ValueError(
                f"{name!r} cannot be a column: it {'is one already' if name in row else 'is not a string'}"
            )
        cell = value.item() if hasattr(value, "item") else value  # of numpy's numbers and booleans
        if not (cell is None or isinstance(cell, bool | int | float | str)):
            raise TypeError(f"column {name!r} takes a number, a boolean or a string, found {type(value).__name__}")
        if isinstance(cell, int) and not -(2**63) <= cell < 2**63:
            raise ValueError(f"column {name!r} takes integers of 64 bits, found {cell}")
        checked[name] = cell
    return checked


def _failed(message: str, row: Row) -> Row:
    """Return the columns of diagnostics of a row with one more, an error without a place."""
    fault = {"severity": "error", "code": None, "message": message, "file": None, "line": None, "column": None}
    return counted([*json.loads(str(row["diagnostics"])), fault])
