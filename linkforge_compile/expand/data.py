"""Read the YAML files that `data` names, as values for expressions."""

from __future__ import annotations

import math
from collections.abc import Callable

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import DATA_NOT_PATH, TAG_NOT_NUMBER
from linkforge_compile.expand.loader import Loader
from linkforge_compile.expand.uses import PathSite, locate
from linkforge_compile.expressions import FAULT, Fault, Scope, Value, as_text, evaluate, kind_name, parse_template
from linkforge_compile.syntax import Tags, YamlEntry, YamlFault, YamlNode, YamlScalar
from linkforge_compile.units import number_text


def load_data(
    entry: YamlEntry, path: Value | Fault, site: Callable[[str], PathSite], loader: Loader, sink: Diagnostics
) -> YamlNode | None:
    """Return the tree of the file that an entry of `data` names, None after a reported error.

    `path` is the computed value of the entry. In the file, text with a unit is a quantity and `$(` is plain text.
    """
    if path is FAULT:
        return None
    text = as_text(path)
    if text is None:
        found = "nothing" if path is None else kind_name(path)
        sink.report(DATA_NOT_PATH.at(entry.value.span, name=entry.name, found=found))
        return None
    path_site = site(text)
    target = locate(path_site, loader, sink)
    return loader.open_data(target.path, sink, _angle_tags(sink), path_site.used) if target else None


def _angle_tags(sink: Diagnostics) -> Tags:
    """Return xacro's tags for angles, which accept a number or an expression of numbers such as `pi/2`.

    The result is a bare number, as in xacro, because vendors also write `max_velocity: !degrees 180`.
    """

    def angle(tag: str, to_radians: Callable[[float], float]) -> Callable[[YamlScalar], YamlNode]:
        def make(scalar: YamlScalar) -> YamlNode:
            number = _number(scalar)
            if number is None:
                sink.report(TAG_NOT_NUMBER.at(scalar.span, tag=tag, text=scalar.text))
                return YamlFault(scalar.span)
            radians = to_radians(number)
            return YamlScalar(number_text(radians), radians, scalar.span)

        return make

    return {"!degrees": angle("!degrees", math.radians), "!radians": angle("!radians", float)}


def _number(scalar: YamlScalar) -> float | None:
    """Return the value of a scalar as an expression with no names but `pi`; None if it is not a number."""
    template = parse_template(f"$({scalar.text})", scalar.span, Diagnostics())
    value = FAULT if template is None else evaluate(template, Scope({}), Diagnostics())
    return None if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
