"""Templates: the Python that they become writes what Jinja itself makes of them, and is kept between processes."""

import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from linkforge_compile.backends import document, render_srdf, render_urdf, template_python
from linkforge_compile.backends.markup import Xml, end, laid_out, lay, ready
from linkforge_compile.backends.source_map import Mapped, render_srdf_with_map, render_urdf_with_map
from linkforge_compile.backends.template_python import UnknownInTemplateError, python_of
from linkforge_compile.cli.main import main
from linkforge_compile.core import Robot
from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.resources import templates_folder
from tests.backends.everything import everything
from tests.backends.test_laws import robots
from tests.writers.test_every_field import full

JINJA = Environment(
    loader=FileSystemLoader(templates_folder()),
    finalize=lambda value: value if isinstance(value, Markup) else Markup(ready(value)),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,  # an included template ends its last line
)


def by_jinja(template: str) -> Callable[[list[str], object], None]:
    def append(lines: list[str], view: object) -> None:
        lines += laid_out(JINJA.get_template(template).render(robot=view))

    return append


def documents(robot: Robot) -> list[str | Mapped]:
    return [
        render_urdf(robot),
        render_urdf(robot, pretty=False, gazebo="classic"),
        render_urdf_with_map(robot),
        render_srdf(robot),
        render_srdf(robot, pretty=False),
        render_srdf_with_map(robot),
    ]


def documents_by_jinja(robot: Robot) -> list[str | Mapped]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(document, "_template", by_jinja)
        return documents(robot)


@pytest.mark.parametrize("robot", [everything, full], ids=lambda robot: robot.__name__)
def test_templates_say_what_jinja_makes_of_them(robot: Callable[[], Robot]):
    assert documents(robot()) == documents_by_jinja(robot())


@settings(deadline=None, max_examples=10)
@given(robots())
def test_templates_say_of_any_robot_what_jinja_makes_of_them(robot: Robot):
    with suppress(RobotGeneratorError):
        assert documents(robot) == documents_by_jinja(robot)


def written(text: str, **others: str) -> list[str]:
    """Return the lines that a template makes of a robot with a name, an element of its own and none of another."""
    robot = SimpleNamespace(name="a&b", own=Xml("<own>\n<inner/>\n</own>"), none=Xml(), parts=[("x", None), ("y", "1")])
    names: dict[str, Callable[..., object]] = {"ready": ready, "lay": lay, "end": end}
    exec(python_of("robot", {"robot": text} | {f"of/{name}": other for name, other in others.items()}, "robot"), names)
    lines: list[str] = []
    names["document"](lines, robot)
    return lines


def test_lines_stand_as_deep_as_their_elements():
    assert written("<a>\n<b n='{{ robot.name }}'>\n{{ robot.own }}\n\n{{ robot.none }}\n</b>\n</a>") == [
        "<a>",
        "  <b n='a&amp;b'>",
        "    <own>",
        "      <inner/>",
        "    </own>",
        "  </b>",
        "</a>",
    ]


def test_an_element_without_content_ends_itself():
    assert written("<a>\n<b>\n{{ robot.none }}\n</b>\n</a>") == ["<a>", "  <b/>", "</a>"]


def test_a_name_of_a_block_hides_that_around_it_as_long_as_the_block():
    text = (
        "{% set n = 'out' %}{% for n, v in robot.parts %}{% if v is not none %}\n<{{ n }}/>\n{% endif %}{% endfor %}\n"
    )
    assert written(f"{text}<{{{{ n }}}}/>") == ["<y/>", "<out/>"]


def test_what_is_included_sees_the_names_where_it_is_and_a_macro_what_it_is_given():
    text = (
        "{% from 'of/m' import tag %}\n{% for kind, n in robot.parts %}\n<p>\n{% include 'of/' ~ kind ~ '' %}\n</p>\n"
        "{% endfor %}\n{{ tag(robot.none or 'z') }}"
    )
    others = {"x": "<x{{ kind }}/>", "y": "<y n={{ n }}/>", "m": "{% macro tag(n) %}\n<{{ n }}/>\n{% endmacro %}"}
    assert written(text, **others) == ["<p>", "  <xx/>", "</p>", "<p>", "  <y n=1/>", "</p>", "<z/>"]


SHARED = "a statement shares its line with statements alone, not with text or a value"


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("<a/>\n<a\nb>", 2, "a line is one value, or begins and ends as a tag does, found '<a'"),
        ("<a/>\n<a{% if robot %} b{% endif %}>", 2, SHARED),
        ("<a>\n{% if robot %}\n</a>\n{% endif %}", 3, "an element ends in the block that begins it"),
        ("{% if robot %}\n<a>\n{% endif %}\n</a>", 2, "an element ends in the block that begins it"),
        ("<a/>\n{{ link.name }}", 2, "no 'link' is in sight, only 'robot'"),
        ("{{ robot.name | upper }}", 1, "'or' and 'is not none' are known, found 'Filter'"),
        ("{% if robot %}\n{% else %}\n<a/>\n{% endif %}", 1, "'macro' without defaults are known, found 'If'"),
        ("{% include 'other' %}", 1, "a template is included by its path, or by 'start' ~ value ~ 'end'"),
        ("{% include 'robot' ignore missing %}", 1, "'macro' without defaults are known, found 'Include'"),
        ("{{ tag(robot) }}", 1, "a call names a macro of this template or an imported one, and all it takes"),
        (
            "{% set x = 'a' %}\n{% if robot %}\n{% set x = 'b' %}\n{% endif %}\n<{{ x }}/>",
            3,
            "a name that is set in an 'if' stays set behind it in Jinja, and would not here; set it outside",
        ),
        ("<a>\n{% if robot %}<b/>\n{% endif %}\n</a>", 2, SHARED),
        ("<a>\n{% if robot %}\n{{ robot.name }}{% endif %}\n</a>", 3, SHARED),
        ("<a>\n<b>{% for n, v in robot.parts %}\n<c/>\n{% endfor %}\n</b>\n</a>", 2, SHARED),
    ],
)
def test_what_is_not_known_is_refused_at_its_place(text: str, line: int, reason: str):
    with pytest.raises(UnknownInTemplateError) as refused:
        written(text)
    assert str(refused.value).startswith(f"robot:{line}: ")
    assert str(refused.value).endswith(reason)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder of templates whose Python is kept below the same one; nothing of this process is taken."""
    monkeypatch.setattr(sys, "pycache_prefix", str(tmp_path / "cache"))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(document, "templates_folder", lambda: tmp_path)
    monkeypatch.setattr(document, "_template", document._template.__wrapped__)
    (tmp_path / "urdf").mkdir()
    (tmp_path / "urdf" / "robot.xml.j2").write_text("<robot/>")
    return tmp_path


def test_a_template_is_made_python_once_for_all_processes(folder: Path, monkeypatch: pytest.MonkeyPatch):
    assert render_urdf(Robot("r")).endswith("\n<robot/>\n")
    monkeypatch.delattr(template_python, "python_of")
    assert render_urdf(Robot("r")).endswith("\n<robot/>\n")


def test_a_template_that_says_something_else_is_made_python_again(folder: Path):
    render_urdf(Robot("r"))
    (folder / "urdf" / "robot.xml.j2").write_text("<robot>\n{% include 'urdf/link.xml.j2' %}\n</robot>")
    (folder / "urdf" / "link.xml.j2").write_text("<link/>")
    assert render_urdf(Robot("r"), pretty=False).endswith("<robot><link/></robot>\n")


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("<robot>\n{{ robot.name | upper }}\n</robot>", 2, "are known, found 'Filter'"),
        ("<robot>\n{% if %}\n</robot>", 2, "Expected an expression, got 'end of statement block'"),
    ],
)
def test_a_template_that_somebody_made_unreadable_is_told_at_its_place(
    text: str, line: int, reason: str, folder: Path, capsys: pytest.CaptureFixture[str]
):
    template = folder / "urdf" / "robot.xml.j2"
    template.write_text(text)
    spec = folder / "a.robot.yaml"
    spec.write_text("linkforge: 1\nname: a\nlinks: {base: }\n")
    assert main(["compile", str(spec)]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"linkforge: {template}:{line}: ")
    assert said.endswith(f"{reason}; this template is a part of linkforge: mend it, or install linkforge again\n")
