"""`data`: what a YAML file holds, as a value that expressions reach into."""

from __future__ import annotations

import math
from collections.abc import Callable

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.files import DATA_NOT_PATH, TAG_NOT_NUMBER
from linkforge_compile.expand.loader import Loader
from linkforge_compile.expand.uses import PathSite, locate
from linkforge_compile.expressions import FAULT, Fault, Scope, Value, as_text, evaluate, kind_name, parse_template
from linkforge_compile.syntax import Tags, YamlEntry, YamlFault, YamlNode, YamlScalar
from linkforge_compile.units import number_text


def data_of(
    entry: YamlEntry, path: Value | Fault, site: Callable[[str], PathSite], loader: Loader, sink: Diagnostics
) -> YamlNode | None:
    """Return what the file holds that an entry of `data` names, None where it cannot be had, which is reported.

    `path` is what the entry's value is once computed, and `site` makes a path of it. Text in the file that is a
    number and a unit is a quantity, `$(` is text as any other.
    """
    if path is FAULT:
        return None
    text = as_text(path)
    if text is None:
        found = "nothing" if path is None else kind_name(path)
        sink.report(DATA_NOT_PATH.at(entry.value.span, name=entry.name, found=found))
        return None
    written = site(text)
    target = locate(written, loader, sink)
    return loader.open_data(target.path, sink, _tags(sink), written.used) if target else None


def _tags(sink: Diagnostics) -> Tags:
    """Return xacro's tags for angles, which take a number or an expression of numbers such as `pi/2`.

    They give a bare number, as in xacro: vendors write `max_velocity: !degrees 180` with them as well.
    """

    def angle(tag: str, in_radians: Callable[[float], float]) -> Callable[[YamlScalar], YamlNode]:
        def make(scalar: YamlScalar) -> YamlNode:
            number = _number(scalar)
            if number is None:
                sink.report(TAG_NOT_NUMBER.at(scalar.span, tag=tag, text=scalar.text))
                return YamlFault(scalar.span)
            radians = in_radians(number)
            return YamlScalar(number_text(radians), radians, scalar.span)

        return make

    return {"!degrees": angle("!degrees", math.radians), "!radians": angle("!radians", float)}


def _number(scalar: YamlScalar) -> float | None:
    """Return the number that a scalar is or computes to without any names but `pi`; None for anything else."""
    template = parse_template(f"$({scalar.text})", scalar.span, Diagnostics())
    value = FAULT if template is None else evaluate(template, Scope({}), Diagnostics())
    return None if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
