"""Compiles specs for the tests of MJCF."""

from lxml import etree

from linkforge_compile import compile_text
from linkforge_compile.diagnostics.codes.simulators import NO_ACTUATOR, NO_MESSAGES, NO_VELOCITY_LIMIT
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.formats import MJCF, Rendering

HEAD = """linkforge: 1
name: robot
x-unit: &unit {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}
"""

USUAL = (NO_VELOCITY_LIMIT.id, NO_MESSAGES.id, NO_ACTUATOR.id)


def compiled(text: str):
    compilation = compile_text(HEAD + text)
    assert compilation.robot is not None, compilation.diagnostics
    return compilation.robot


def document(text: str, **options: str) -> etree._Element:
    return etree.fromstring(MJCF.render(compiled(text), Rendering(options))[0].text.encode())


def reported(text: str, **options: str) -> list[str]:
    """Return the codes and messages of a spec's MJCF, grouped as a report has them, without what most robots have."""
    return [one for one in every_report(text, **options) if not one.startswith(USUAL)]


def every_report(text: str, **options: str) -> list[str]:
    """Return the codes and messages of a spec's MJCF, grouped as a report has them."""
    return [f"{one.code.id} {one.message}" for one in group_alike(MJCF.limits(compiled(text), options))]
