"""A compile has the same stack however deep its caller is."""

from collections.abc import Callable

import pytest

from linkforge_compile import Compilation, compile_text

CHAIN = ", ".join(f"v{number}: $(v{number + 1})" for number in range(60))


def called_from(depth: int, work: Callable[[], Compilation]) -> Compilation:
    return called_from(depth - 1, work) if depth else work()


def test_a_chain_of_names_is_computed_from_a_deep_stack():
    text = f"linkforge: 1\nname: ball\nlinks: {{base: {{visual: {{sphere: $(v0)}}}}}}\nvariables: {{{CHAIN}, v60: 1}}\n"
    for depth in (0, 75, 400, 850):
        assert called_from(depth, lambda: compile_text(text)).diagnostics == ()


def test_names_through_deep_lists_are_reported_not_raised():
    lists = ", ".join(f"v{number}: {'[' * 30}$(v{number + 1}){']' * 30}" for number in range(60))
    text = f"linkforge: 1\nname: ball\nlinks: {{base: }}\nmetadata: {{x: $(v0)}}\nvariables: {{{lists}, v60: 1}}\n"
    found = [
        [one.message for one in called_from(depth, lambda: compile_text(text)).diagnostics]
        for depth in (0, 75, 400, 850)
    ]
    assert found == [["'v0' is computed through too many other names"]] * 4


@pytest.mark.parametrize("depth", [0, 75, 850])
def test_deep_data_is_read_from_a_deep_stack(depth: int):
    data = "{a: " * 95 + "1" + "}" * 95
    text = f"linkforge: 1\nname: ball\nlinks: {{base: }}\nmetadata: {{x: {data}}}\n"
    assert called_from(depth, lambda: compile_text(text)).diagnostics == ()
