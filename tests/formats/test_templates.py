"""Templates are those of Jinja2; what they render is laid out, escaped, and a fault in one of ours has a place."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml
from jinja2 import DictLoader, TemplateRuntimeError, UndefinedError

from linkforge_compile.cli.main import main
from linkforge_compile.core import Robot
from linkforge_compile.core.models.geometry import Transform, Vector3
from linkforge_compile.formats import environment
from linkforge_compile.formats.environment import make_environment, own_environment
from linkforge_compile.formats.render import render_urdf
from linkforge_compile.formats.xml_document import parse_rendered, write
from linkforge_compile.formats.xml_text import Xml

ROBOT = SimpleNamespace(
    name="a&b", own=Xml("<own>\n<inner/>\n</own>"), none=Xml(), speed=0.1 + 0.2, axis=Vector3(0, 1, 0), missing=None
)


def rendered(text: str, name: str = "robot.xml.j2", **others: str) -> str:
    """Return what a template makes of a small robot, not laid out."""
    loader = DictLoader({name: text} | {f"{other}.xml.j2": text for other, text in others.items()})
    return make_environment(loader).get_template(name).render(robot=ROBOT)


def written(text: str, *, pretty: bool = True, **others: str) -> list[str]:
    """Return the lines of the document that a template makes of it."""
    return write(parse_rendered(rendered(text, **others)), pretty=pretty).split("\n")


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


def test_templates_have_all_of_jinja2():
    text = (
        "{% extends 'base.xml.j2' %}{% from 'tags.xml.j2' import tag %}{% block inside %}\n"
        "{% if robot.missing %}\n<no/>\n{% else %}\n{{ tag('it', size=3) }}\n{% endif %}\n"
        "{% for n in 'ab' if n != 'a' %}<{{ n | upper }}/>\n{% endfor %}"
        "{% endblock %}"
    )
    others = {
        "base": "<a>\n{% block inside %}{% endblock %}\n</a>\n",
        "tags": "{% macro tag(name, size=1) %}\n<{{ name }} size='{{ size }}'/>\n{% endmacro %}",
    }
    assert written(text, **others) == ["<a>", "  <it size='3'/>", "  <B/>", "</a>"]


def test_lines_of_text_stay_as_they_are():
    text = "<a>\n  one\n  two\n</a>\n<b/>"
    assert written(text, pretty=False) == ["<a>", "  one", "  two", "</a><b/>"]
    assert written(text) == ["<a>", "  one", "  two", "</a>", "<b/>"]


def test_an_end_too_many_is_left_for_who_reads_it():
    assert written("<a>\n</a>\n</b>\n<\n</c>") == ["<a/>", "</b>", "<", "</c>"]


def test_values_in_xml_are_spelled_as_urdf_spells_them():
    text = "<a n='{{ robot.name }}' x='{{ robot.speed }}' y='{{ 4.0 }}' v='{{ robot.axis }}' is='{{ true }}'/>"
    assert rendered(text) == "<a n='a&amp;b' x='0.30000000000000004' y='4' v='0 1 0' is='true'/>"
    assert rendered("{{ robot.name }} {{ 4.0 }} {{ robot.missing }}", "robot.md.j2") == "a&b 4.0 None"


def test_filters_spell_numbers_as_urdf_does():
    text = "{{ 4.0 | number }} {{ robot.axis | vector }} {{ (robot.speed * 10) | degrees | round(3) }}"
    assert rendered(text, "robot.md.j2") == "4 0 1 0 171.887"
    assert rendered("{{ [1e-05, 2.0, 'a: b', none, true] | to_yaml }}", "a.yaml.j2") == (
        "[1.0e-05, 2.0, 'a: b', null, true]"
    )
    assert rendered("{{ 'no' | to_yaml }} {{ 1 | to_yaml }}", "a.yaml.j2") == "'no' 1"


@pytest.mark.parametrize(
    ("value", "reason"),
    [("robot.missing", "this is None, which has no text in XML"), ("robot", "a SimpleNamespace has no text in XML")],
)
def test_what_has_no_text_in_xml_is_refused(value: str, reason: str):
    with pytest.raises(TemplateRuntimeError, match=reason):
        rendered(f"<a>{{{{ {value} }}}}</a>")


def test_what_a_view_does_not_have_is_no_empty_text():
    with pytest.raises(UndefinedError):
        rendered("<a>{{ robot.nosuch }}</a>")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Yield a folder that replaces that of our own templates."""
    monkeypatch.setattr(environment, "templates_folder", lambda: tmp_path)
    (tmp_path / "urdf").mkdir()
    environment.own_environment.cache_clear()
    yield tmp_path
    environment.own_environment.cache_clear()


def test_a_template_is_read_from_its_folder(folder: Path):
    (folder / "urdf" / "robot.xml.j2").write_text("<robot>\n{% include 'urdf/link.xml.j2' %}\n</robot>")
    (folder / "urdf" / "link.xml.j2").write_text("<link/>")
    assert render_urdf(Robot("r"), pretty=False).endswith("<robot><link/></robot>\n")


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("<robot>\n{% if %}\n</robot>", 2, "Expected an expression, got 'end of statement block'"),
        ("<robot>\n{{ robot.name | nosuch }}\n</robot>", 2, "No filter named 'nosuch'."),
        ("<robot>\n\n{{ link.name }}\n</robot>", 3, "'link' is undefined"),
        ("<robot>\n{{ none }}\n</robot>", 2, "this is None, which has no text in XML; test it with"),
        ("<robot>\n{% include 'urdf/link.xml.j2' %}\n</robot>", 2, "'urdf/link.xml.j2' not found in search path"),
    ],
)
def test_a_broken_builtin_template_is_reported_at_its_place(
    text: str, line: int, reason: str, folder: Path, capsys: pytest.CaptureFixture[str]
):
    template = folder / "urdf" / "robot.xml.j2"
    template.write_text(text)
    spec = folder / "a.robot.yaml"
    spec.write_text("linkforge: 1\nname: a\nlinks: {base: }\n")
    assert main(["compile", str(spec)]) == 2
    stderr = capsys.readouterr().err
    assert stderr.startswith(f"linkforge: {template}:{line}: {reason}")
    assert stderr.endswith("; this template is a part of linkforge: mend it, or install linkforge again\n")


def test_a_removed_builtin_template_is_reported(folder: Path, capsys: pytest.CaptureFixture[str]):
    spec = folder / "a.robot.yaml"
    spec.write_text("linkforge: 1\nname: a\nlinks: {base: }\n")
    assert main(["compile", str(spec)]) == 2
    assert capsys.readouterr().err.startswith(f"linkforge: {folder / 'urdf' / 'robot.xml.j2'}:1: ")


@pytest.mark.parametrize(
    "text",
    [
        "y",
        "N",
        "Yes",
        "off",
        "1e5",
        "-1E+5",
        "0o17",
        "0x1F",
        ".5",
        "1.",
        "+.inf",
        ".NaN",
        "inf",
        "nan",
        "0x1.8p3",
        "012",
        "1_0",
        "null",
    ],
)
def test_yaml_quotes_what_a_reader_may_take_for_something_else(text: str):
    assert own_environment().from_string("{{ text | to_yaml }}").render(text=text) in (f"'{text}'", f'"{text}"')


@pytest.mark.parametrize("text", ["a\nb", "a\n\nb\n", "\n", "a\rb", "a\x85", "a\u2028b", "x y" * 999])
def test_yaml_is_one_line_that_reads_back(text: str):
    for value in (text, {text: [text]}):
        written = own_environment().from_string("{{ value | to_yaml }}").render(value=value)
        assert len(written.splitlines()) == 1
        assert yaml.safe_load(written) == value


def test_yaml_of_a_vector_is_a_list_and_of_a_pose_its_fields():
    pose = Transform(Vector3(0, 0, 0.1), Vector3(0, 1, 0))
    text = own_environment().from_string("{{ pose.xyz | to_yaml }} {{ pose | to_yaml }}").render(pose=pose)
    assert text == "[0, 0, 0.1] {xyz: [0, 0, 0.1], rpy: [0, 1, 0]}"
