"""What a stranger's xacro makes `migrate` compute is bounded, since it is read outside of xacro's own process."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from linkforge_compile.analysis import Settings
from linkforge_compile.cli import reports
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.migration import expand, migrate
from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.deadline import Deadline
from linkforge_compile.migration.python_values import PythonValues, UnknownValueError
from linkforge_compile.migration.sources import Sources
from linkforge_compile.migration.symbols import CannotTranslateError, NotConstantError
from linkforge_compile.migration.template import FileDraft
from tests.cli.in_process import linkforge
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
    "[range(9999) for i in range(6000)]",
    "sum([[0] * 9999] * 9999, [])",
    "str([[[0] * 9999] * 9999] * 9999)",
    "b'a' * 10 ** 9",
    "'%(a)999999999d' % {'a': 1}",
    "round(5, -10 ** 9)",
    "long.join(['', ''])",
    "long.join(('', ''))",
    "''.join([''.join(['a' * 9999] * 9)] * 9999)",
    "int('f' * 9999, 16)",
    "-" * 2000 + "1",
]
VALUES = {"long": "a" * 60_000, "number": 1 << 3000}


@pytest.mark.parametrize("text", HUGE)
def test_what_is_huge_is_not_computed(text: str):
    tree = ast.parse(text, mode="eval").body
    with pytest.raises(UnknownValueError):
        PythonValues(lambda name: VALUES[name.id]).value(tree)
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
        ("round(2.5) + round(0.126, 2)", 2.13),
        ("[name for name in [[i, i] for i in range(1000)]][999]", [999, 999]),
    ],
)
def test_what_robots_use_is_computed(text: str, value: object):
    assert PythonValues(lambda name: VALUES[name.id]).value(ast.parse(text, mode="eval").body) == value


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
    migrate.Translator({}, sources, Deadline()).migrate(migrate.Constraints())


def test_another_attempt_starts_with_what_the_one_before_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    expanded: list[None] = []
    expand_once = expand.Expander.expand

    def counted(expander: expand.Expander) -> FileDraft:
        expanded.append(None)
        return expand_once(expander)

    monkeypatch.setattr(expand.Expander, "expand", counted)
    text = """
    <link name="base"/>
    <xacro:macro name="m" params="name kind">
      <link name="${name}"/>
      <xacro:if value="${kind == 'a'}">
        <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
      </xacro:if>
    </xacro:macro>
    <xacro:m name="left" kind="a"/>
    <xacro:m name="right" kind="a"/>"""
    main = write(tmp_path, robot=text)
    translator = migrate.Translator({}, Sources(main, Settings().loader(main), Diagnostics()), Deadline())
    one = translator.migrate(migrate.Constraints())
    assert len(expanded) > 2
    expanded.clear()
    other = translator.migrate(one.constraints)
    assert len(expanded) == 1
    assert other.files == one.files


@pytest.mark.parametrize(("links", "late"), [(2, "the comparison of 1 combination"), (150, "the translation")])
def test_what_takes_too_long_is_not_written(links: int, late: str, tmp_path: Path):
    joint = '<link name="l{0}"/><joint name="j{0}" type="fixed"><parent link="base"/><child link="l{0}"/></joint>'
    write(tmp_path, robot=f'<link name="base"/>{"".join(joint.format(one) for one in range(links))}')
    ran = linkforge("migrate", "robot.xacro", "-o", "specs", "--seconds", "1e-9", cwd=tmp_path)
    assert ran.returncode == 1
    assert f"error: {late}" in ran.stderr
    assert "was not finished in 1e-09 s; --seconds gives it more time [LF8051]" in ran.stderr
    assert "nothing is written" in ran.stderr
    assert not (tmp_path / "specs").exists()


def test_progress_is_printed_when_it_takes_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(reports, "PROGRESS_INTERVAL", 0)
    write(tmp_path, robot='<xacro:arg name="a" default="true"/><link name="base"/>')
    ran = linkforge("migrate", "robot.xacro", cwd=tmp_path)
    assert "\ncompared 1 of 2 combinations of arguments\n" in ran.stderr
    assert "translation 2" not in ran.stderr


def test_progress_tells_one_translation_from_the_next(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(reports, "PROGRESS_INTERVAL", 0)
    inertia = '<inertia ixx="0.4" iyy="0.4" izz="0.4" ixy="0" ixz="0" iyz="0"/>'
    sphere = '<collision><geometry><sphere radius="1"/></geometry></collision>'
    write(tmp_path, robot=f'<link name="base">{sphere}<inertial><mass value="1"/>{inertia}</inertial></link>')
    ran = linkforge("migrate", "robot.xacro", cwd=tmp_path)
    told = [line for line in ran.stderr.splitlines() if "compared" in line]
    assert told == [f"{phase}compared 0 of 1 combinations of arguments" for phase in ("", "translation 2: ")]


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


def test_texts_that_double_with_each_property_are_not_written_out(tmp_path: Path):
    doubles = "".join(f'<xacro:property name="p{n + 1}" value="${{p{n}}}${{p{n}}}"/>' for n in range(50))
    main = write(tmp_path, robot=f'<xacro:property name="p0" value="ab"/>{doubles}<link name="${{p50}}"/>')
    with pytest.raises(CannotTranslateError, match="more than 100000 characters"):
        _expand(main)


def test_an_expression_that_is_nested_too_deeply_is_told(tmp_path: Path):
    main = write(tmp_path, robot=f'<link name="base"/><link name="l${{{"1+" * 9999}1}}"/>')
    with pytest.raises(CannotTranslateError, match="nested too deeply"):
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
