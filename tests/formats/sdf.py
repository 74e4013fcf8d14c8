"""Compiles specs for the tests of SDF."""

from pathlib import Path

from lxml import etree

from linkforge_compile import compile_text
from linkforge_compile.diagnostics.grouping import group_alike
from linkforge_compile.formats import SDF, Rendering
from tests.libsdformat import Read, read_with_libsdformat

HEAD = """linkforge: 1
name: robot
x-unit: &unit {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}
"""


def compiled(text: str):
    compilation = compile_text(HEAD + text)
    assert compilation.robot is not None, compilation.diagnostics
    return compilation.robot


def rendered(text: str, **options: str) -> str:
    return SDF.render(compiled(text), Rendering(options))[0].text


def document(text: str, **options: str) -> etree._Element:
    return etree.fromstring(rendered(text, **options).encode())


def read(text: str, folder: Path) -> Read:
    """Return what libsdformat reads in a spec's SDF 1.9; it may complain about nothing."""
    found = read_with_libsdformat(rendered(text, sdf="1.9"), folder, is_strict=True)
    assert found.complaints == []
    return found


def reported(text: str, **options: str) -> list[str]:
    """Return the codes and messages of a spec's SDF, grouped as a report has them."""
    return [f"{one.code.id} {one.message}" for one in group_alike(SDF.limits(compiled(text), options))]
