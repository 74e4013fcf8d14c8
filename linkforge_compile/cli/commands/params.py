"""`linkforge params`: the parameters and variants of a spec, as a table or as JSON."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linkforge_compile.cli import FAULTY_SPEC, OK
from linkforge_compile.cli.options import add_outside_option, add_package_option, packages_of
from linkforge_compile.cli.reports import add_report_options, report
from linkforge_compile.diagnostics.terminal import align

if TYPE_CHECKING:
    import argparse

    from linkforge_compile.listing import ListedParameter, Listing, Plain

_EXAMPLES = """\
examples:
  linkforge params arm.robot.yaml           a table: name, type, default, limits, description; then the variants
  linkforge params arm.robot.yaml --json    the same for tools; numbers are in SI units
  linkforge params arm.urdf.xacro           the arguments of a xacro, and of the files that it includes
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("spec", metavar="SPEC", help="the spec, NAME.robot.yaml, or a xacro, which is read but not run")
    parser.add_argument("--json", action="store_true", help="as JSON, for tools")
    add_package_option(parser)
    add_outside_option(parser)
    add_report_options(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import write_to_stdout
    from linkforge_compile.pipeline import parameters_of

    listing, diagnostics = parameters_of(
        arguments.spec, packages=packages_of(arguments), allow_outside=arguments.allow_outside
    )
    is_faulty = report(diagnostics, arguments)
    if listing:
        write_to_stdout(_json_text(listing) if arguments.json else "".join(f"{line}\n" for line in _lines(listing)))
    return FAULTY_SPEC if is_faulty else OK


def _lines(listing: Listing) -> Iterator[str]:
    yield f"{listing.name}: {listing.description}" if listing.description else listing.name
    yield ""
    if listing.parameters:
        rows = [("parameter", "type", "default", "limits", "description"), *map(_row, listing.parameters)]
        yield from align(rows)
    else:
        yield "It has no parameters." if not listing.macros else "It has no arguments; 'macro' of a module calls one:"
    for macro, parameters in listing.macros.items():
        yield ""
        if parameters:
            yield from align([(f"macro {macro}", "type", "default"), *(_row(one)[:3] for one in parameters)])
        else:
            yield f"macro {macro} has no parameters"
    if listing.variants:
        yield ""
        settings = {
            name: ", ".join(f"{key}={value}" for key, value in variant.items())
            for name, variant in listing.variants.items()
        }
        yield from align([("variant", "sets"), *settings.items()])


def _row(parameter: ListedParameter) -> tuple[str, ...]:
    default = "(required)" if parameter.default is None else parameter.default or '""'
    default = f"(the module's {parameter.field})" if parameter.field else default
    if parameter.default is not None and parameter.computed not in {"", default}:
        default = f"{default} = {parameter.computed}"
    return parameter.name, parameter.type or "?", default, parameter.limits, " ".join(parameter.description.split())


def _json_text(listing: Listing) -> str:
    from linkforge_compile.cli.output import json_text

    document = {
        "name": listing.name,
        "description": listing.description,
        "parameters": [_json_parameter(parameter) for parameter in listing.parameters],
        "macros": [
            {"name": name, "parameters": [{**_json_parameter(one), "field": one.field} for one in parameters]}
            for name, parameters in listing.macros.items()
        ],
        "variants": [{"name": name, "sets": dict(settings)} for name, settings in listing.variants.items()],
    }
    return json_text(document)


def _json_parameter(parameter: ListedParameter) -> dict[str, Plain]:
    return {
        "name": parameter.name,
        "type": parameter.type,
        "unit": parameter.unit,
        "required": parameter.is_required,
        "default": parameter.default,
        "value": parameter.value,
        "minimum": parameter.minimum,
        "maximum": parameter.maximum,
        "enum": parameter.choices,
        "pattern": parameter.pattern,
        "description": parameter.description,
    }
