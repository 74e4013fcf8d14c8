"""The tags of data files: units of xacro before a number."""

from __future__ import annotations

import math

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import TAG_NOT_NUMBER
from linkforge_compile.expressions import FAULT, Scope, evaluate, parse_template
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlFault, YamlNode, YamlScalar
from linkforge_compile.units import number_text

UNIT_TAGS = {
    "!degrees": math.pi / 180,
    "!radians": 1.0,
    "!meters": 1.0,
    "!millimeters": 0.001,
    "!foot": 0.3048,
    "!inches": 0.0254,
}
"""xacro's YAML tags for units, which data files may use, and what they are in SI units."""


def number_with_tag(sink: Diagnostics, tag: str, scalar: YamlScalar) -> YamlNode:
    """Return the number with a tag as a bare one in SI units; it is a number or an expression such as `pi/2`.

    It has no unit, as in xacro, because vendors also write `max_velocity: !degrees 180`.
    """
    number = value_with_tag(tag, scalar.text, scalar.span)
    if number is None:
        sink.report(TAG_NOT_NUMBER.at(scalar.span, tag=tag, text=scalar.text))
        return YamlFault(scalar.span)
    return YamlScalar(number_text(number), number, scalar.span)


def value_with_tag(tag: str, text: str, where: Span) -> float | None:
    """Return the value in SI units of a number or an expression with a tag; None if it is neither."""
    template = parse_template(f"$({text})", where, Diagnostics())
    value = FAULT if template is None else evaluate(template, Scope({}), Diagnostics())
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) * UNIT_TAGS[tag]
