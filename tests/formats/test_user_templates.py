"""A user's templates: their data, what they may do, and their diagnostics."""

import os
import pickle
from pathlib import Path

import pytest

from linkforge_compile import Robot, TemplateError, compile_text, formats, render_srdf, render_templates, render_urdf
from linkforge_compile.core import Joint, JointLimits, JointType, Link, Mesh, Vector3, Visual
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.limits import FACTOR_VARIABLE
from linkforge_compile.resources import templates_folder
from tests.formats.everything import everything

LIMITS = JointLimits(effort=5.0, velocity=2.0, lower=-1.0, upper=0.1 + 0.2)
ARM = Robot(
    "arm",
    links=[Link("base"), Link("upper"), Link("tool")],
    joints=[
        Joint("elbow", JointType.REVOLUTE, "base", "upper", axis=Vector3(0, 0, 1), limits=LIMITS),
        Joint("mount", JointType.FIXED, "upper", "tool"),
    ],
)


def write(folder: Path, **texts: str) -> None:
    for name, text in texts.items():
        path = folder / name.replace("__", "/").replace("_md", ".md.j2").replace("_xml", ".xml.j2")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


def rendered(text: str, folder: Path, name: str = "a.md") -> str:
    (folder / f"{name}.j2").write_text(text, "utf-8")
    return render_templates(ARM, folder)[name]


def fault(text: str, folder: Path, name: str = "a.md") -> Diagnostic:
    """Return the only diagnostic of a template."""
    with pytest.raises(TemplateError) as refused:
        rendered(text, folder, name)
    (diagnostic,) = refused.value.diagnostics
    return diagnostic


def test_each_template_at_the_top_makes_a_document(tmp_path: Path):
    write(tmp_path, b_md="{{ robot.name }}", a_md="{% include '_head_md' %}{% include 'parts/x.j2' %}")
    write(tmp_path, parts__x_md="no", parts__y_md="no")
    (tmp_path / "_head_md").write_text("head ")
    (tmp_path / "parts" / "x.j2").write_text("part")
    (tmp_path / ".hidden.j2").write_text("{{ nosuch }}")
    (tmp_path / "_part.j2").write_text("{{ nosuch }}")
    (tmp_path / "read.me").write_text("{{ nosuch }}")
    assert render_templates(ARM, tmp_path) == {"a.md": "head part", "b.md": "arm"}


def test_a_template_is_given_the_robot_its_views_and_the_banner(tmp_path: Path):
    write(
        tmp_path,
        a_md="{{ robot.joints.elbow.limits.upper | number }} {{ robot.links | length }} "
        "{{ urdf.joints[0].child }} {{ srdf is none }} {{ banner }}",
    )
    assert render_templates(ARM, tmp_path, banner="made by us") == {
        "a.md": "0.30000000000000004 3 upper True made by us"
    }
    write(tmp_path, a_md="{{ srdf.groups | length }}")
    assert render_templates(everything(), tmp_path) == {"a.md": str(len(everything().semantic.groups))}


def test_the_view_of_a_format_is_made_when_a_template_uses_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    made: list[str] = []
    for one in formats.FORMATS:
        own = one.view
        monkeypatch.setattr(one, "view", lambda *words, one=one, own=own: made.append(one.name) or own(*words))
    write(tmp_path, a_md="{{ robot.name }}")
    render_templates(ARM, tmp_path)
    assert made == []
    write(tmp_path, a_md="{% set other = mjcf %}{{ other is none }}{% include '_part.j2' %}", b_md="{{ mjcf is none }}")
    (tmp_path / "_part.j2").write_text("{% if urdf %}{{ mjcf is none }}{% endif %}")
    assert render_templates(ARM, tmp_path) == {"a.md": "FalseFalse", "b.md": "False"}
    assert made == ["mjcf", "urdf"], "each once"


def test_a_view_that_cannot_be_made_is_reported_where_a_template_uses_it(tmp_path: Path):
    robot = Robot("arm", links=[Link("base", visuals=[Visual(Mesh("a\x07"))])])
    write(tmp_path, a_md="{{ robot.name }}")
    assert render_templates(robot, tmp_path) == {"a.md": "arm"}
    write(tmp_path, a_md="{{ robot.name }}\n{{ urdf.name }}")
    with pytest.raises(TemplateError, match=r"a\.md\.j2:1:1: .*XML cannot hold the character U\+0007"):
        render_templates(robot, tmp_path)


def test_the_banner_ends_no_comment(tmp_path: Path):
    write(tmp_path, a_xml="<!-- {{ banner }} --><a/>")
    assert render_templates(ARM, tmp_path, banner="from a--b.yaml") == {"a.xml": "<!-- from a- -b.yaml -->\n<a/>\n"}


def test_an_index_answers_to_names(tmp_path: Path):
    text = "{{ robot.joints['elbow'].child }} {{ robot.joints[1].name }} {{ robot.links.names | join('-') }}"
    assert rendered(text, tmp_path) == "upper mount base-upper-tool"
    assert (
        rendered("{{ robot.joints.nosuch is defined }} {{ robot.joints['x'] is defined }}", tmp_path) == "False False"
    )


def test_a_document_of_xml_is_escaped_and_laid_out_as_urdf(tmp_path: Path):
    text = (
        "<robot\n  name='{{ robot.name }}'>\n<!-- one\n two -->\n{% for joint in robot.joints[:1] %}"
        "<j v='{{ joint.limits.upper }}' x='{{ joint.origin.xyz }}'>\n{{ '<&>' }}\n</j>\n{% endfor %}\n</robot>"
    )
    assert rendered(text, tmp_path, "a.xml") == (
        "<robot name='arm'>\n  <!-- one\n two -->\n  <j v='0.30000000000000004' x='0 0 0'>\n"
        "&lt;&amp;&gt;\n</j>\n</robot>\n"
    )


@pytest.mark.parametrize(
    ("text", "laid_out"),
    [
        ("<a>text\n</a>", "<a>text\n</a>\n"),
        ("<a><b>\n</b><c/></a>", "<a>\n  <b/>\n  <c/>\n</a>\n"),
        ("<a> </a>", "<a> </a>\n"),
        ("<a xml:space='preserve'>\n<b/></a>", "<a xml:space='preserve'>\n<b/></a>\n"),
        ("<a><!-- c -->\n</a>", "<a>\n  <!-- c -->\n</a>\n"),
        ("<a>x ></a>\n", "<a>x ></a>\n"),
        ("<a>\n one\n   two\n</a>", "<a>\n one\n   two\n</a>\n"),
        ("<a>\n<b>\n 1\n<c/>\n  2 </b>\n<d/>\n</a>", "<a>\n  <b>\n 1\n<c/>\n  2 </b>\n  <d/>\n</a>\n"),
        (
            "<r>\n<a><![CDATA[\n  <b></b>\n if x:\n   y]]>\n</a>\n</r>",
            "<r>\n  <a><![CDATA[\n  <b></b>\n if x:\n   y]]>\n</a>\n</r>\n",
        ),
        ("<a><![CDATA[<b></b>]]></a>", "<a><![CDATA[<b></b>]]></a>\n"),
        ("<a>\n<!--\n<b>\n   c\n-->\n<d/>\n</a>", "<a>\n  <!--\n<b>\n   c\n-->\n  <d/>\n</a>\n"),
        ("<a b='>\n  c'\n  d='1'/>", "<a b='>   c' d='1'/>\n"),
        ("<?xml version='1.0' encoding='UTF-8'?>\n<a/>", "<?xml version='1.0' encoding='UTF-8'?>\n<a/>\n"),
        ("{# head #}\n<?xml version='1.0'?>\n<a\n b='1'\n/>", "<?xml version='1.0'?>\n<a b='1' />\n"),
    ],
)
def test_layout_changes_no_content_of_an_xml_document(text: str, laid_out: str, tmp_path: Path):
    assert rendered(text, tmp_path, "a.xml") == laid_out


def test_a_document_of_xml_may_include_what_our_templates_make(tmp_path: Path):
    text = "<part>\n{% include 'urdf/joint.xml.j2' %}\n</part>"
    ours = render_urdf(ARM)
    assert rendered(text, tmp_path, "a.urdf").split("\n")[1] in ours.split("\n")


def test_other_documents_keep_their_layout_and_are_not_escaped(tmp_path: Path):
    assert rendered("\ufeff  <{{ robot.name }}>\r\n\n  {{ 2.0 }}\n", tmp_path) == "  <arm>\n\n  2.0\n"


@pytest.mark.parametrize("gazebo", ["gz", "classic"])
def test_our_templates_in_the_sandbox_write_what_they_write_outside(gazebo: str):
    robot = everything()
    assert render_urdf(robot, gazebo=gazebo, templates=templates_folder()) == render_urdf(robot, gazebo=gazebo)
    assert render_srdf(robot, templates=templates_folder()) == render_srdf(robot)


def test_a_template_goes_before_ours(tmp_path: Path):
    write(tmp_path, urdf__joint_xml="{% for joint in robot.joints %}\n<{{ joint.name }}/>\n{% endfor %}")
    assert render_urdf(ARM, templates=tmp_path, pretty=False).endswith('<link name="tool"/><elbow/><mount/></robot>\n')


SYNTAX, NAME, FAILS = (
    "Jinja2 cannot read this template: ",
    "this template uses an undefined name: ",
    "this template fails here: ",
)


@pytest.mark.parametrize(
    ("text", "code", "line", "message"),
    [
        ("a\n{% if %}", "LF7201", 2, f"{SYNTAX}expected an expression, got 'end of statement block'"),
        ("{{ 1 | numbr }}", "LF7201", 1, f"{SYNTAX}no filter named 'numbr'; did you mean 'number'?"),
        ("\n\n  {{ robt }}", "LF7202", 3, f"{NAME}'robt' is not defined; did you mean 'robot'?"),
        (
            "{% for joint in robot.joints %}\n{{ joint.limts }}{% endfor %}",
            *("LF7202", 2, f"{NAME}a Joint has no 'limts'; did you mean 'limits'?"),
        ),
        ("{{ robot.joints.elbw.child }}", "LF7202", 1, f"{NAME}'robot.joints' has no 'elbw'; did you mean 'elbow'?"),
        (
            "{{ robot.joints.mount.limits.upper }}",
            *(
                "LF7202",
                1,
                f"{NAME}'robot.joints.mount.limits' is None, which has no 'upper'; test it with '{{% if … %}}'",
            ),
        ),
        (
            "{{ robot.joints['mount'].limits['upper'] }}",
            *("LF7202", 1),
            f"{NAME}'robot.joints['mount'].limits' is None, which has no 'upper'; test it with '{{% if … %}}'",
        ),
        (
            "{% set b = 1 %}{{ robot.joints.mount.limits.upper }}{{ b.upper }}",
            *("LF7202", 1, f"{NAME}this is None, which has no 'upper'; test it with '{{% if … %}}'"),
        ),
        (
            "{{ robot.joints.keys() }}",
            *("LF7202", 1, f"{NAME}'robot.joints' has no 'keys'; it is a list: loop over it, or over its 'names'"),
        ),
        ("{{ robot.sensors }}{{ 1 / 0 }}", "LF7205", 1, f"{FAILS}division by zero"),
        ("{{ 1 + 'a' }}", "LF7205", 1, f"{FAILS}unsupported operand type(s) for +: 'int' and 'str'"),
        ("{{ robot.joints | to_yaml }}", "LF7205", 1, f"{FAILS}a Joint has no text in YAML; write its fields"),
        ("\n{% include 'a.md.j2' %}", "LF7205", 2, f"{FAILS}templates or macros use each other without an end"),
    ],
)
def test_a_fault_is_reported_at_its_line(text: str, code: str, line: int, message: str, tmp_path: Path):
    found = fault(text, tmp_path)
    assert found.span
    assert (found.code.id, found.message, found.span.line) == (code, message, line)
    assert found.span.file.path == tmp_path / "a.md.j2"
    assert found.span.text == text.split("\n")[line - 1].strip()


def test_a_missing_template_is_reported_with_a_similar_one(tmp_path: Path):
    (tmp_path / "_head.md.j2").write_text("head")
    found = fault("a\n{% include '_hed.md.j2' %}", tmp_path)
    assert str(found).endswith(
        f":2:1: error: no template '_hed.md.j2' in '{tmp_path}'; did you mean '_head.md.j2'? [LF7203]"
    )
    assert fault("{% include '../x.j2' %}", tmp_path).code.id == "LF7203"


def test_a_fault_of_an_included_template_is_reported_there_with_its_include(tmp_path: Path):
    (tmp_path / "_part.j2").write_text("\n{{ nosuch }}")
    found = fault("\n\n{% include '_part.j2' %}", tmp_path)
    assert found.span
    assert (found.span.file.path, found.span.line) == (tmp_path / "_part.j2", 2)
    (note,) = found.notes
    assert note.span
    assert (note.message, note.span.file.path, note.span.line) == ("included here", tmp_path / "a.md.j2", 3)


def test_the_faults_of_all_templates_are_reported_in_one_run(tmp_path: Path):
    write(tmp_path, a_md="{{ nosuch }}", b_md="{{ 1 / 0 }}", c_md="right")
    with pytest.raises(TemplateError) as refused:
        render_templates(ARM, tmp_path)
    assert [one.code.id for one in refused.value.diagnostics] == ["LF7202", "LF7205"]
    assert str(pickle.loads(pickle.dumps(refused.value))) == str(refused.value)


NO_TEXT = "has no text; write"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{{ robot.joints.names }}{{ robot.get_link }}", "'get_link' is not called, and has no text"),
        ("{{ robot }}", f"a Robot {NO_TEXT} one of its fields, such as its name"),
        ("{{ robot.links }}", f"a Link {NO_TEXT} one of its fields"),
        ("{{ [1, {'a': robot.joints.elbow}] }}", f"a Joint {NO_TEXT} one of its fields"),
        ("{{ [robot.joints.elbow.axis] }}", "a Vector3 has no text in a list; write '| join(\", \")'"),
        ("{{ urdf.joints[0] }}", f"a View {NO_TEXT} one of its fields"),
        ("{{ robot.links | map(attribute='name') }}", f"a generator {NO_TEXT} '| list' or '| join(\", \")'"),
        ("{{ range(3) }}", f"a range {NO_TEXT} '| list'"),
        ("{{ {}.items() }}", f"a dict_items {NO_TEXT} '| list'"),
        ("{{ robot.graph.link_names | list }}", "a set has no order"),
        ("{% macro m() %}{% endmacro %}{{ m }}", "'m' is not called, and has no text; write 'm()'"),
        ("{{ robot.links[0] ~ 'x' }}", f"a Link {NO_TEXT} one of its fields"),
        ("{{ robot.links | join(', ') }}", f"a Link {NO_TEXT} one of its fields"),
        ("{{ '%s' % robot.links[0] }}", f"a Link {NO_TEXT} one of its fields"),
        ("{{ robot.get_link | string }}", "'get_link' is not called"),
        ("{{ robot.get_link | pprint }}", "'get_link' is not called"),
        ("{{ robot.links | random }}", "'random' would make another text on every run"),
        ("{{ robot.graph.link_names | join }}", "a set has no order"),
        ("{{ robot.graph.link_names }}", "a set has no order"),
    ],
)
def test_a_value_without_a_text_form_is_reported(text: str, reason: str, tmp_path: Path):
    found = fault(f"\n{text}", tmp_path)
    assert found.span
    assert (found.code.id, found.span.line) == ("LF7205", 2)
    assert found.message.startswith(f"this template fails here: {reason}")


def test_what_has_a_text_is_written_as_jinja2_does(tmp_path: Path):
    text = "{{ none }} {{ true }} {{ [1, 'a', none] }} {{ {'a': (1.5,)} }} {{ robot.joints[0].type }}{{ 1 | string }}"
    assert rendered(text, tmp_path) == "None True [1, 'a', None] {'a': (1.5,)} revolute1"
    text = "{{ robot.joints[0].axis }} {{ robot.links.names }} {{ robot.links | join(', ', attribute='name') }}"
    assert rendered(text, tmp_path) == f"{Vector3(0, 0, 1)} ('base', 'upper', 'tool') base, upper, tool"


def test_a_kind_has_its_article(tmp_path: Path):
    (tmp_path / "a.md.j2").write_text("{{ robot.ros2_controls[0].joints[0].command_interfaces[0].nosuch }}")
    with pytest.raises(TemplateError, match="an Interface has no 'nosuch'"):
        render_templates(everything(), tmp_path)


def test_a_format_may_have_a_width(tmp_path: Path):
    text = "{{ '%-9s|%8.3f' % ('ab', 1.5) }} {{ '{:>5}'.format(1) }} {{ 'x' | center(5) }}|{{ '%s' | format('y') }}"
    assert rendered(text, tmp_path) == "ab       |   1.500     1   x  |y"
    assert (
        rendered("{{ '12345%s67890 {}' % 1 }} {{ '{{}} 12345 {}%'.format(1) }}", tmp_path)
        == "12345167890 {} {} 12345 1%"
    )
    assert rendered("{{ 'a\nb' | indent(2) }} {{ 'abc' | replace('b', 'x') }}", tmp_path) == "a\n  b axc"


def test_a_list_of_lists_that_doubles_is_refused(tmp_path: Path):
    text = "{% set n = namespace(x=[]) %}{% for i in range(60) %}{% set n.x = [n.x, n.x] %}{% endfor %}{{ n.x }}"
    assert fault(text, tmp_path).code.id == "LF3301"


@pytest.mark.parametrize("behind", ["", " | list | length", " | first"])
def test_map_reports_a_name_that_is_not_there_as_a_dot_does(behind: str, tmp_path: Path):
    found = fault(f"{{{{ robot.links | map(attribute='nme'){behind or ' | list'} }}}}", tmp_path)
    assert (found.code.id, found.message) == ("LF7202", f"{NAME}a Link has no 'nme'; did you mean 'name'?")
    assert fault(f"{{{{ robot.links | map(attribute='source'){behind or ' | list'} }}}}", tmp_path).code.id == "LF7204"
    assert rendered("{{ robot.links | map(attribute='nme', default=1) | list }}", tmp_path) == "[1, 1, 1]"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<a>{{ none }}</a>", "this is None, which has no text in XML; test it with '{% if … is not none %}'"),
        ("<a>{{ robot }}</a>", "a Robot has no text in XML; write one of its fields"),
        ("<a>{{ '\\x07' }}</a>", "XML cannot hold the character U+0007, found in '\\x07'"),
    ],
)
def test_what_xml_cannot_hold_is_reported_at_its_line(text: str, reason: str, tmp_path: Path):
    found = fault(f"\n{text}", tmp_path, "a.xml")
    assert found.span
    assert (found.code.id, found.message, found.span.line) == ("LF7205", f"this template fails here: {reason}", 2)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("<a>\n<b>\n</a>", "expected </b>, found </a>, in line 3 of it, '</a>'"),
        ("<a>\n{{ '<b>' | safe }}\n</a>", "expected </b>, found </a>, in line 3 of it, '</a>'"),
        ("<a>\n", "the output ends at line 2 without </a>"),
        ("</a>", "invalid token, in line 1 of it, '</a>'"),
        ("<a>\n<b>\n</a>\n</a>", "expected </b>, found </a>, in line 3 of it, '</a>'"),
        ("", "the file is empty, in line 1 of it"),
        (
            '<?xml version="1.0" encoding="iso-8859-1"?><a/>',
            "it declares the encoding 'iso-8859-1', and is written in UTF-8; write encoding='utf-8'",
        ),
    ],
)
def test_output_that_is_not_xml_is_reported(text: str, problem: str, tmp_path: Path):
    found = fault(text, tmp_path, "a.xml")
    assert (found.code.id, found.message) == ("LF7206", f"this template writes XML that is not well-formed: {problem}")


def test_output_that_is_not_xml_is_reported_at_the_line_of_the_template(tmp_path: Path):
    found = fault("<a>\n{{ '<b>' | safe }}\n  <c/>\n  </a>", tmp_path, "a.xml")
    assert found.span
    assert (found.span.line, found.span.column, found.span.text) == (4, 3, "</a>")
    found = fault("<a>\n{{ '<b>' | safe }}\n{{ '</a>' | safe }}", tmp_path, "a.xml")
    assert found.span
    assert found.span.line == 1


def test_urdf_that_is_not_xml_is_reported_at_the_replacing_template(tmp_path: Path):
    write(tmp_path, urdf__joint_xml="<joint>")
    with pytest.raises(TemplateError) as refused:
        render_urdf(ARM, templates=tmp_path)
    assert str(refused.value).startswith(f"{tmp_path / 'urdf' / 'joint.xml.j2'}:1:1: error: ")
    assert str(refused.value).endswith("expected </joint>, found </robot>, in line 12 of it, '</robot>' [LF7206]")


@pytest.mark.parametrize(
    "text",
    [
        "<a>\n{{ urdf.joints[0].elements }}\n</a>",
        "<a/>\n{{ urdf.joints[0].elements }}",
        "{{ urdf.joints[0].elements }}",
    ],
)
def test_an_addition_to_a_missing_element_is_reported(text: str, tmp_path: Path):
    robot = compile_text(
        "linkforge: 1\nname: a\nlinks: {b: , c: }\njoints: {j: {type: fixed, parent: b, child: c, "
        "extra_inside: {parent: {extra_attributes: {x: '1'}}}}}\n"
    ).result()
    (tmp_path / "a.xml.j2").write_text(text)
    with pytest.raises(TemplateError, match=r"LF720[56]"):
        render_templates(robot, tmp_path)


@pytest.mark.parametrize(
    "text",
    [
        "{{ ''.__class__ }}",
        "{{ robot.source }}",
        "{{ robot.links[0].source }}",
        "{{ robot.links | map(attribute='source') | list | length }}{{ robot | attr('source') }}",
        "{{ robot.resource_resolver }}",
        "{{ '{0.source}'.format(robot) }}",
        "{{ robot.add_link(robot.links[0]) }}",
        "{{ robot.export_urdf() }}",
        "{{ robot.clone() }}",
        "{{ robot._tree }}",
        "{{ urdf.__dict__ }}",
        "{{ [].append(1) }}",
    ],
)
def test_a_template_only_reads_the_robot(text: str, tmp_path: Path):
    assert fault(text, tmp_path).code.id == "LF7204"


def test_methods_that_look_something_up_may_be_called(tmp_path: Path):
    text = "{{ robot.get_link('base').name }} {{ robot.has_link('x') }} {{ robot.joints[0].type.upper() }}"
    assert rendered(text, tmp_path) == "base False REVOLUTE"


NESTED = (
    "{% set n = namespace(x=[1]) %}{% for i in range(25) %}{% set n.x = [n.x, n.x] %}{% endfor %}{{ n.x | FILTER }}"
)
STEPS = "rendering takes more than 1,000,000 steps of templates, where"
CHARACTERS = "rendering takes more than 33,554,432 characters that templates handle,"
WIDE = "this template fails here: a width in a format is a number of at most four digits, written in it"
GROWING = "{% set n = namespace(x='a') %}{% for i in range(60) %}{% set n.x = GROWN %}{% endfor %}"

BLOCK = "{% set y %}{{ n.x }}{{ n.x }}{% endset %}{% set n.x = y %}"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{% for i in range(10**9) %}{{ i }}{% endfor %}", "this template fails here: range too big."),
        ("{% for i in range(9**5) %}{% for j in range(9**5) %}{% endfor %}{% endfor %}", STEPS),
        ("{% for i in 'abcd' * 4000 if i == 'e' %}{% endfor %}" * 70, STEPS),
        ("{% macro m(n) %}{% if n %}{{ m(n - 1) }}{{ m(n - 1) }}{% endif %}{% endmacro %}{{ m(99) }}", STEPS),
        (
            "{% set n = n | default(0) + 1 %}{% if n < 99 %}{% include 'a.md.j2' %}{% include ['a.md.j2'] %}{%endif%}",
            STEPS,
        ),
        (GROWING.replace("GROWN", "n.x ~ n.x"), CHARACTERS),
        (GROWING.replace("GROWN", "n.x + n.x"), CHARACTERS),
        (GROWING.replace("GROWN", "n.x | replace('a', 'aa')"), CHARACTERS),
        (GROWING.replace("GROWN", "n.x.replace('a', 'aa')"), CHARACTERS),
        (GROWING.replace("{% set n.x = GROWN %}", BLOCK), CHARACTERS),
        ("{{ 'x' * 10**10 }}", CHARACTERS),
        ("{{ [1] * 10**9 }}", CHARACTERS),
        ("{{ '' | center(999999999) }}", CHARACTERS),
        ("{{ ''.center(999999999) }}", CHARACTERS),
        ("{{ '1'.zfill(999999999) }}", CHARACTERS),
        ("{{ '\\t'.expandtabs(999999999) }}", CHARACTERS),
        ("{{ '\\t'.expandtabs(tabsize=999999999) }}", CHARACTERS),
        ("{{ 'a\\nb' | indent(999999999) }}", CHARACTERS),
        (NESTED.replace("FILTER", "to_yaml"), STEPS),
        (NESTED.replace("FILTER", "tojson"), STEPS),
        ("{{ ('a' * 99999) | replace('a', 'b' * 99999) }}", CHARACTERS),
        ("{{ ('a' * 99999).replace('a', 'b' * 99999) }}", CHARACTERS),
        ("{{ ('a' * 99999).join(range(99999) | list | map('string') | list) }}", CHARACTERS),
        ("{{ ('a ' * 99999) | wordwrap(1, wrapstring='b' * 99999) }}", CHARACTERS),
        ("{{ [1] | batch(999999999, 'x') | list }}", CHARACTERS),
        ("{{ range(99999) | join('b' * 99999) }}", CHARACTERS),
        ("{{ [1] | tojson(999999999) }}", "this template fails here: 'tojson' takes an indent of at most 32"),
        ("{{ '%999999999d' % 1 }}", WIDE),
        ("{{ '%*d' % (999999999, 1) }}", WIDE),
        ("{{ '%.*f' % (999999999, 1) }}", WIDE),
        ("{{ '%999999999d' | format(1) }}", WIDE),
        ("{{ '%(a)-999999999.1f' % {'a': 1} }}", WIDE),
        ("{{ '{:>999999999}'.format(1) }}", WIDE),
        ("{{ '{:>{}}'.format(1, 999999999) }}", WIDE),
        ("{% set r = range(99999) %}{% for i in r %}{% if r | sum < 0 %}{% endif %}{% endfor %}", CHARACTERS),
        ("{% set s = 'x' * 99999 %}{% for i in range(9999) %}{% if s.count('y') %}{% endif %}{% endfor %}", CHARACTERS),
        ("{% for i in range(99999) %}" + "x" * 1000 + "{% endfor %}", CHARACTERS),
        ("{{ 10**(10**10) }}", "this template fails here: this number has more than 4096 bits"),
        (
            GROWING.replace("GROWN", "n.x * n.x").replace("'a'", "3"),
            "this template fails here: this number has more than 4096 bits",
        ),
        ("{{ lipsum(10**9) }}", "this template uses an undefined name: 'lipsum' is not defined"),
    ],
)
def test_what_exceeds_a_limit_is_refused(text: str, message: str, tmp_path: Path):
    assert fault(text, tmp_path).message.startswith(message)


def test_templates_after_one_that_exceeds_the_limit_are_not_reported(tmp_path: Path):
    write(tmp_path, a_md="right", b_md="\n{{ 'x' * 10**10 }}", c_md="right", d_md="{{ nosuch }}")
    with pytest.raises(TemplateError) as refused:
        render_templates(ARM, tmp_path)
    (diagnostic,) = refused.value.diagnostics
    assert diagnostic.span
    assert (diagnostic.code.id, diagnostic.span.file.path, diagnostic.span.line) == (
        *("LF3301", tmp_path / "b.md.j2", 2),
    )


def test_who_asks_for_it_may_take_more(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    text = "{% for i in range(1001) %}{% for j in range(1001) %}{% endfor %}{% endfor %}right"
    assert fault(text, tmp_path).code.id == "LF3301"
    monkeypatch.setenv(FACTOR_VARIABLE, "2")
    assert rendered(text, tmp_path) == "right"


def test_a_link_that_leads_out_is_not_followed(tmp_path: Path):
    folder, outside = tmp_path / "templates", tmp_path / "secret.txt"
    folder.mkdir()
    outside.write_text("secret")
    (folder / "_x.j2").symlink_to(outside)
    found = fault("\n{% include '_x.j2' %}", folder)
    assert found.span
    assert (found.code.id, found.span.line) == ("LF3401", 2)
    assert f"the link '{folder / '_x.j2'}' leads out" in [note.message for note in found.notes]
    outside.unlink()
    assert str(fault("\n{% include '_x.j2' %}", folder)) == str(found), "whether there is a file is not told"


def test_a_link_within_the_repository_is_followed(tmp_path: Path):
    (tmp_path / ".git").mkdir()
    (tmp_path / "shared.j2").write_text("shared")
    folder = tmp_path / "templates"
    folder.mkdir()
    (folder / "a.md.j2").symlink_to(tmp_path / "shared.j2")
    assert render_templates(ARM, folder) == {"a.md": "shared"}


def test_a_link_that_leads_out_is_followed_where_the_user_allows_it(tmp_path: Path):
    folder = tmp_path / "templates"
    folder.mkdir()
    (tmp_path / "shared.j2").write_text("shared")
    (folder / "a.md.j2").symlink_to(tmp_path / "shared.j2")
    assert render_templates(ARM, folder, allow_outside=True) == {"a.md": "shared"}


@pytest.mark.parametrize(
    ("name", "content", "place", "reason"),
    [
        ("a.md", b"\xef\xbb\xbfa\nbc\xff", "2:3", "the byte 0xff is not UTF-8; save it as UTF-8"),
        ("a.xml", b"<a>\x00</a>", "1:1", "it contains a character that XML does not allow"),
        ("a.md", b"a" * (16 * 1024**2 + 1), "1:1", "it is larger than 16 MiB"),
    ],
    ids=["not UTF-8", "control character", "large"],
)
def test_an_unreadable_template_is_reported_at_its_file(
    name: str, content: bytes, place: str, reason: str, tmp_path: Path
):
    path = tmp_path / f"{name}.j2"
    path.write_bytes(content)
    (tmp_path / "a.first.j2").write_text("right")
    with pytest.raises(TemplateError) as refused:
        render_templates(ARM, tmp_path)
    assert [str(one) for one in refused.value.diagnostics] == [
        f"{path}:{place}: error: template '{path}' cannot be read: {reason} [LF7207]"
    ]


@pytest.mark.parametrize("text", ["right", "{% include 'b.md.j2' %}"])
def test_a_broken_link_is_reported_at_the_link(text: str, tmp_path: Path):
    (tmp_path / "a.md.j2").write_text(text)
    (tmp_path / "b.md.j2").symlink_to(tmp_path / "nosuch")
    with pytest.raises(TemplateError) as refused:
        render_templates(ARM, tmp_path)
    path = tmp_path / "b.md.j2"
    assert {str(one) for one in refused.value.diagnostics} == {
        f"{path}:1:1: error: template '{path}' cannot be read: the link is broken: its target does not exist [LF7207]"
    }
    notes = [note.span.file.path for one in refused.value.diagnostics for note in one.notes if note.span]
    assert notes == ([tmp_path / "a.md.j2"] if text != "right" else [])


def test_an_unused_link_out_of_the_template_folder_is_reported_at_the_link(
    tmp_path: Path,
):
    folder = tmp_path / "t"
    write(folder, a_md="right", urdf__link_xml="")
    (folder / "urdf" / "joint.xml.j2").symlink_to(tmp_path / "outside")
    (folder / "b.md.j2").symlink_to(tmp_path / "outside")
    with pytest.raises(TemplateError) as refused:
        render_templates(ARM, folder)
    assert str(refused.value).startswith(f"{folder / 'b.md.j2'}:1:1: error: ")
    with pytest.raises(TemplateError) as refused:
        render_urdf(ARM, templates=folder)
    assert str(refused.value).startswith(f"{folder / 'urdf' / 'joint.xml.j2'}:1:1: error: ")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes")
def test_a_pipe_is_no_template(tmp_path: Path):
    os.mkfifo(tmp_path / "_x.j2")
    assert fault("{% include '_x.j2' %}", tmp_path).code.id == "LF7203"
