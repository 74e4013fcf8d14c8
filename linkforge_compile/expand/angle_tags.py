"""Make the functions of xacro's YAML tags `!degrees` and `!radians`, which data files may use."""

from __future__ import annotations

import math
from collections.abc import Callable

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import TAG_NOT_NUMBER
from linkforge_compile.expressions import FAULT, Scope, evaluate, parse_template
from linkforge_compile.syntax import Tags, YamlFault, YamlNode, YamlScalar
from linkforge_compile.units import number_text


def angle_tags(sink: Diagnostics) -> Tags:
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
