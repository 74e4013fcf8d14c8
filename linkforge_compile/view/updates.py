"""What the pages of a live viewer receive: the scene, the problems of the spec, and the settings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TypedDict

from linkforge_compile.analysis import Parameters, Settings
from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Severity
from linkforge_compile.diagnostics.grouping import join_names
from linkforge_compile.diagnostics.render_text import MOST_SHOWN, snippet
from linkforge_compile.diagnostics.reports import count_losses
from linkforge_compile.expand import CliArgument, arguments_from_text
from linkforge_compile.expand.arguments import names_in_variant
from linkforge_compile.listing import ListedParameter, Listing, Plain, as_written
from linkforge_compile.units import finite_number, number_text, parse_quantity
from linkforge_compile.view.files import MissingFile
from linkforge_compile.view.scene import Scene


class Problem(TypedDict):
    """A diagnostic as the page shows it; file, line and column are None for one without a place in a file.

    `page` is the address of the code's manual page, below that of the viewer. `hints` are its notes and fixes, and
    `snippet` is the line at fault with a caret under the words, "" for none.
    """

    severity: str
    code: str
    message: str
    file: str | None
    line: int | None
    column: int | None
    page: str
    hints: list[str]
    snippet: str


class ParameterSetting(TypedDict):
    """A parameter as its widget shows it; numbers are in `unit`, an SI unit.

    `value` is what the user set, as text; None for the default, which the chosen variant may replace. `number` is what
    the slider shows of them; None if they are not a number.
    """

    name: str
    type: str | None
    unit: str | None
    value: str | None
    default: str | None
    number: float | None
    minimum: Plain
    maximum: Plain
    choices: list[Plain] | None
    description: str


class ShownSettings(TypedDict):
    """The settings of the page, with their current values."""

    parameters: list[ParameterSetting]
    variants: list[str]
    variant: str | None


class Update(TypedDict):
    """An update for a page; `scene` is None if the page shows it already, or there is none yet."""

    version: int
    scene: Scene | None
    problems: list[Problem]
    settings: ShownSettings


def values_of(parameters: Parameters | None) -> dict[str, str]:
    """Return the values of parameters as text, by name."""
    if isinstance(parameters, Mapping):
        return {name: value.text for name, value in parameters.items() if isinstance(value, CliArgument)}
    entries = arguments_from_text(tuple(parameters or ()), Diagnostics()).entries
    return {name: as_written(entry.value) for name, entry in entries.items()}


def shown_settings(settings: Settings, listing: Listing | None) -> ShownSettings:
    """Return the settings of a compile with the declarations of the file; None if it could not be read yet."""
    if listing is None:
        return {"parameters": [], "variants": [], "variant": settings.variant}
    values, by_variant = values_of(settings.parameters), dict[str, str]()
    for name in names_in_variant(settings.variant, listing.variants):
        by_variant |= listing.variants.get(name, {})
    return {
        "parameters": [_shown(one, values.get(one.name), by_variant.get(one.name)) for one in listing.parameters],
        "variants": list(listing.variants),
        "variant": settings.variant,
    }


def _shown(parameter: ListedParameter, value: str | None, of_variant: str | None) -> ParameterSetting:
    default = parameter.default if of_variant is None else of_variant
    if of_variant is None and "$(" in (default or ""):
        default = parameter.computed or default
    if parameter.choices is not None:
        value, default = (_as_choice(text, parameter.unit) for text in (value, default))
    return {
        "name": parameter.name,
        "type": parameter.type,
        "unit": parameter.unit,
        "value": value,
        "default": default,
        "number": _number(default if value is None else value),
        "minimum": parameter.minimum,
        "maximum": parameter.maximum,
        "choices": parameter.choices,
        "description": parameter.description,
    }


def _number(text: str | None) -> float | None:
    """Return the number of a text without a unit, or of a quantity in its SI unit; None for any other text."""
    quantity = parse_quantity(text) if text else None
    return quantity.value if quantity else finite_number(text)


def _as_choice(text: str | None, unit: str | None) -> str | None:
    """Return a text as the choices of a parameter are written: a quantity in its SI unit."""
    quantity = parse_quantity(text) if text and unit else None
    return f"{number_text(quantity.value)} {unit}" if quantity else text


def problems_of(diagnostics: Iterable[Diagnostic], missing: Iterable[MissingFile] = ()) -> list[Problem]:
    """Return the diagnostics that a text report shows, errors first; those about missing files have the links."""
    diagnostics = tuple(diagnostics)
    links = {one.use.place: one.use.links for one in missing}
    shown = [one for one in count_losses(diagnostics, [diagnostics]) if not one.is_only_counted]
    shown.sort(key=lambda one: list(Severity).index(one.severity))
    return [_problem(one, links.get(one.span, ())) for one in shown[:MOST_SHOWN]]


def _problem(one: Diagnostic, links: Sequence[str]) -> Problem:
    span = one.span if one.span and one.span.file.path else None
    return {
        "severity": one.severity.value,
        "code": one.code.id,
        "message": one.message,
        "file": span.file.shown if span else None,
        "line": span.line if span else None,
        "column": span.column if span else None,
        "page": f"codes/{one.code.id}",
        "hints": [*_hints(one), *([f"not shown in {join_names(links)}"] if links else [])],
        "snippet": "\n".join(snippet(one.span)),
    }


def _hints(one: Diagnostic) -> Iterator[str]:
    for note in one.notes:
        yield f"{note.span}: {note.message}" if note.span else note.message
    yield from (fix.title for fix in one.fixes)
