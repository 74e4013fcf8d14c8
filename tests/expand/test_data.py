"""`data`: tables in other files, as values of expressions."""

import math

import pytest

from linkforge_compile.diagnostics import BeyondLimitError
from linkforge_compile.units import Dimension, Quantity
from tests.expand.assembling import assemble, metadata_of, write


def test_a_table_is_reached_into(tmp_path):
    (tmp_path / "ur5e.yaml").write_text("masses: {base: 4 kg}\nlinks: [a, b]\noffset: '0.1 m'\nup: $(no expression)\n")
    found = assemble(
        """
        parameters: {model: {default: ur5e}}
        data: {table: $(model).yaml}
        metadata: {mass: $(table.masses.base), second: "$(table.links[1])", offset: $(table.offset), up: $(table.up)}
        """,
        folder=tmp_path,
    )
    assert found.messages == []
    assert found.metadata == {
        "mass": Quantity(4.0, Dimension.MASS),
        "second": "b",
        "offset": Quantity(0.1, Dimension.LENGTH),
        "up": "$(no expression)",
    }


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("!degrees 90", math.pi / 2),
        ("!degrees -45.0", -math.pi / 4),
        ("!degrees  '180'", math.pi),
        ("!radians pi/2", math.pi / 2),
        ("!radians 1.5", 1.5),
        ("!meters 2", 2.0),
        ("!millimeters 2.5*3", 2.5 * 3 * 0.001),
        ("!foot 3", 3 * 0.3048),
        ("!inches 3", 3 * 0.0254),
    ],
)
def test_the_tags_of_xacro_make_bare_numbers(tmp_path, text, number):
    (tmp_path / "table.yaml").write_text(f"[{text}]" if "/" not in text else f"- {text}")
    found = assemble("data: {table: table.yaml}\nmetadata: {a: '$(table[0])'}\n", folder=tmp_path)
    assert (found.messages, found.metadata) == ([], {"a": number})


@pytest.mark.parametrize("text", ["ninety", "90 deg", "prefix", "true", "'a' + 'b'", "1/0", "link('x')", ""])
def test_a_tag_needs_a_number(tmp_path, text):
    (tmp_path / "table.yaml").write_text(f'a: !degrees "{text}"\n')
    found = assemble("data: {table: table.yaml}\nmetadata: {a: $(table.a)}\n", folder=tmp_path)
    assert (found.messages, found.metadata) == (
        [f"'!degrees' must be followed by a number, found '{text}'"],
        {"a": "FAULT"},
    )


def test_the_path_is_relative_to_the_file_that_writes_it(tmp_path):
    for name in ("own.yaml", "arms/own.yaml", "arms/deep/shared.yaml", "calibration.yaml"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(f"'{name}'")
    write(
        tmp_path,
        {
            "arms/arm.yaml": """
                include: [deep/more.yaml]
                parameters: {calibration_file: {type: file, default: own.yaml}}
                data: {own: own.yaml, set: $(calibration_file)}
                metadata: {own: $(own), set: $(set), shared: $(shared), again: $(again)}
            """,
        },
    )
    (tmp_path / "arms/deep/more.yaml").write_text(
        "linkforge: 1\ndata: {shared: shared.yaml, again: $(calibration_file)}\n"
    )
    found = assemble(
        """
        modules:
          plain: {use: arms/arm.yaml}
          set: {use: arms/arm.yaml, with: {calibration_file: calibration.yaml}}
        """,
        folder=tmp_path,
    )
    assert found.messages == []
    plain, chosen = map(metadata_of, found.instance.modules)
    same = {"own": "arms/own.yaml", "shared": "arms/deep/shared.yaml"}
    assert plain == {**same, "set": "arms/own.yaml", "again": "arms/own.yaml"}
    assert chosen == {**same, "set": "calibration.yaml", "again": "calibration.yaml"}


def test_a_file_that_is_named_twice_is_read_once(tmp_path):
    (tmp_path / "table.yaml").write_text("a: !half 1\n")
    found = assemble("data: {one: table.yaml, two: ./table.yaml}\n", folder=tmp_path)
    assert len(found.messages) == 1


def test_files_are_bounded_together(tmp_path):
    text = "#" * 15_000_000 + "\n1"
    for name in ("one", "two", "three"):
        (tmp_path / f"{name}.yaml").write_text(text)
    with pytest.raises(BeyondLimitError, match="more than 33,554,432 characters in its files"):
        assemble(
            "data: {one: one.yaml, two: two.yaml, three: three.yaml}\nmetadata: [$(one), $(two), $(three)]\n",
            folder=tmp_path,
        )
