"""What a stranger's xacro makes `migrate` compute is bounded, since it is read outside of xacro's own process."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.migration import expand, migrate
from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.python_values import PythonValues, UnknownValueError
from linkforge_compile.migration.sources import Sources
from linkforge_compile.migration.symbols import CannotTranslateError, NotConstantError
from tests.migration.migrated import migrated, write

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


def _expand(main: Path) -> None:
    sources = Sources(main, Settings((), {}).loader(main), Diagnostics())
    migrate.migrate({}, sources, migrate.Settled())


def test_macros_that_call_themselves_twice_are_not_expanded_without_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(expand, "_MOST_ELEMENTS", 500)
    twice = '<xacro:m n="${n-1}"/>' * 2
    main = write(
        tmp_path, robot=f'<xacro:macro name="m" params="n">{twice}</xacro:macro><xacro:m n="50"/><link name="a"/>'
    )
    with pytest.raises(CannotTranslateError, match="more than 500 elements"):
        _expand(main)


@pytest.mark.parametrize("included", ["robot.xacro", "other.xacro"])
def test_a_file_that_includes_itself_is_told(tmp_path: Path, included: str):
    main = write(
        tmp_path,
        robot=f'<xacro:include filename="{included}"/><link name="a"/>',
        other='<xacro:include filename="robot.xacro"/>',
    )
    with pytest.raises(CannotTranslateError, match=r"robot\.xacro', which includes itself"):
        _expand(main)


def test_a_file_that_is_included_twice_is_not_refused(tmp_path: Path):
    text = '<xacro:include filename="other.xacro"/><xacro:include filename="other.xacro"/><xacro:a name="base"/>'
    migrated(tmp_path, text, other='<xacro:macro name="a" params="name"><link name="${name}"/></xacro:macro>')


def test_data_whose_aliases_are_too_many_are_no_internal_fault(tmp_path: Path):
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 8)]
    (tmp_path / "sizes.yaml").write_text("\n".join(lines), "utf-8")
    main = write(
        tmp_path,
        robot="""<xacro:property name="a" value="${xacro.load_yaml('sizes.yaml')}"/><link name="l${a['a0'][0]}"/>""",
    )
    with pytest.raises(CannotTranslateError, match=r"sizes\.yaml' cannot be read: .*500,000 values"):
        _expand(main)


@pytest.mark.parametrize("name", ["/etc/pass*", "/etc/passwd", "/etc/no_such_file", "../../*.xacro"])
def test_an_include_outside_of_the_roots_does_not_tell_whether_there_is_a_file(name: str, tmp_path: Path):
    (tmp_path / "robot").mkdir()
    (tmp_path / ".git").mkdir()
    main = write(tmp_path / "robot", robot=f'<xacro:include filename="{name}"/><link name="base"/>')
    sources = Sources(main, Settings().loader(main), Diagnostics())
    with pytest.raises(CannotTranslateError, match="may not be read; see --allow-outside"):
        list(sources.included(name, main.parent))
