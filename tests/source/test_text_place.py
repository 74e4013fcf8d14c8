"""Places of the lines of a block scalar."""

import pytest

from linkforge_compile import compile_text

ROBOT = "linkforge: 1\nname: r\nlinks: {base: }\nextra: |\n\n  <a>\n    <b x='1' x='2'/>\n  </a>\n"


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_a_line_of_a_block_scalar_keeps_its_place_with_any_line_ending(end: str):
    [fault] = compile_text(ROBOT.replace("\n", end)).diagnostics
    assert str(fault.span) == "<text>:7:14"
