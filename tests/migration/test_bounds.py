"""What a stranger's xacro makes `migrate` compute is bounded, since it is read outside of xacro's own process."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from linkforge_compile.migration import migrate
from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.python_values import PythonValues, UnknownValueError
from linkforge_compile.migration.symbols import NotConstantError
from tests.migration.migrated import migrated

HUGE = [
    "10 ** 99 ** 9",
    "'a' * 2 ** 40",
    "2 ** 40 * 'a'",
    "2 ** 40 * [0]",
    "'%999999999d' % 1",
    "'%*d' % (999999999, 1)",
    "long + long",
    "long.replace('a', long)",
    "long.join([long, long])",
    "number * number",
    "[i for i in range(10 ** 9)]",
    "[i for i in range(9999) for j in range(9999)]",
]
VALUES = {"long": "a" * 60_000, "number": 1 << 3000}


@pytest.mark.parametrize("text", HUGE)
def test_what_is_huge_is_not_computed(text: str):
    tree = ast.parse(text, mode="eval").body
    with pytest.raises(UnknownValueError):
        PythonValues(VALUES.__getitem__).value(tree)
    with pytest.raises(NotConstantError):
        constant_of(tree)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("'a_b'.split('_')[1]", "b"),
        ("'%d_%s' % (3, 'x')", "3_x"),
        ("'-'.join(['a', 'b'])", "a-b"),
        ("sum([i * 2 for i in range(4)])", 12),
        ("'link'.replace('l', 'L') + '_1'", "Link_1"),
        ("2 ** 10 * 3", 3072),
    ],
)
def test_what_robots_use_is_computed(text: str, value: object):
    assert PythonValues(VALUES.__getitem__).value(ast.parse(text, mode="eval").body) == value


# Each macro calls the next, and each module is found to need something of its users after the ones in it.
DEPTH = 6


def _chain() -> Iterator[str]:
    for number in range(DEPTH):
        inner = f"""<xacro:m{number + 1} prefix="${{prefix}}"/>""" if number + 1 < DEPTH else ""
        yield f"""
<xacro:macro name="m{number}" params="prefix">
  {inner}
  <link name="${{prefix}}l{number}"/>
  <joint name="${{prefix}}j{number}" type="fixed"><parent link="base"/><child link="${{prefix}}l{number}"/></joint>
  <gazebo reference="base"><mu1>0.{number + 1}</mu1></gazebo>
</xacro:macro>"""


def test_a_macro_is_planned_again_only_if_something_about_it_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    planned: Counter[int] = Counter()
    outer_parts = migrate.outer_parts

    def counted(content: list) -> frozenset:
        planned[id(content)] += 1
        return outer_parts(content)

    monkeypatch.setattr(migrate, "outer_parts", counted)
    text = f"""<link name="base"/>{"".join(_chain())}
<xacro:m0 prefix="left_"/><xacro:m0 prefix="right_"/>"""
    migrated(tmp_path, text)
    assert len(planned) >= 2 * DEPTH
    assert set(planned.values()) == {1}
