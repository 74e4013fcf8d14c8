"""Raw XML that looks like the marks of the writer, or like layout: it is written as its author has it."""

import re
from pathlib import Path

import pytest
from lxml import etree

from linkforge_compile import Robot, TemplateError, compile_text, render_templates, render_urdf
from linkforge_compile.core import Link
from linkforge_compile.formats.render import render_urdf_with_map
from linkforge_compile.formats.xml_document import inside_text, parse_rendered, without_marks, write
from linkforge_compile.formats.xml_text import RESERVED

HOSTILE = [
    "<sep><![CDATA[]]></sep>",
    "<a><![CDATA[]]><b/></a>",
    "<a> <![CDATA[ ]]> </a>",
    "<a><b><![CDATA[]]></b><c/></a>",
    "<sep>&#160;</sep>",
    "<a>\u00a0<b/>\u2003</a>",
    "<a><b/>&#8232;<c/></a>",
    "<a linkforge:at='5'/>",
    "<a linkforge:at='0' x='1'>t</a>",
    "<a linkforge:space='preserve'/>",
    "<a x=' linkforge:space=\"preserve\"'/>",
    '<a>text linkforge:at="0" x</a>',
    '<!-- linkforge:at="0" --><a/>',
    "<linkforge:attributes/>",
    "<linkforge:inside/>",
    "<a><linkforge:inside id='1' key='b'/></a>",
    "<a>&lt;![CDATA[</a>",
    "<a x='1 &gt; 2'>t</a>",
    "<a x=':space='><b/></a>",
    "<a><!-- a > b --></a>",
]
DECLARED = {"linkforge": "urn:test"}


def infoset(element: etree._Element) -> object:
    """Return the content of an element, without white space that is alone between tags."""
    children = [infoset(child) for child in element]
    texts = [element.text, *(child.tail for child in element)]
    is_text = any((text or "").strip(" \t\r\n") for text in texts)
    content = [text or "" for text in texts] if is_text else []
    return str(element.tag), dict(element.attrib), children, content


def declared(document: str) -> etree._Element:
    return etree.fromstring(re.sub("<robot ", '<robot xmlns:linkforge="urn:test" ', document, count=1).encode())


@pytest.mark.parametrize("raw", HOSTILE)
def test_hostile_raw_xml_is_written_as_it_is(raw: str):
    compiled = compile_text(f"linkforge: 1\nname: r\nlinks:\n  base:\n    extra: |\n      {raw}\n")
    assert compiled.robot is not None
    text = render_urdf(compiled.robot)
    assert render_urdf_with_map(compiled.robot).text == text
    assert RESERVED[:-1] not in text
    written = declared(text).find("link")
    wanted = declared(f'<robot name="r"><link name="base">{raw}</link></robot>').find("link")
    if "CDATA[ ]" not in raw:  # its blanks are text, of which lxml does not say that they were CDATA
        assert infoset(written) == infoset(wanted)
    assert declared(render_urdf(compiled.robot, pretty=False)) is not None


def test_an_attribute_of_any_prefix_is_written():
    robot = Robot("r", links=[Link("base", extra_attributes={"linkforge:at": "7"})])
    assert '<link name="base" linkforge:at="7"/>' in render_urdf(robot)
    assert render_urdf_with_map(robot).text == render_urdf(robot)


@pytest.mark.parametrize(
    "doctype",
    ['<!DOCTYPE robot [<!ENTITY x "]>">]>', "<!DOCTYPE robot [<!-- ]> it's -->]>", '<!DOCTYPE robot SYSTEM "a>b[">'],
)
def test_a_document_type_stays_as_it_is(doctype: str):
    text = f"{doctype}\n<robot>\n  <a/>\n</robot>"
    assert write(parse_rendered(text), pretty=True) == text


SPEC = """\
linkforge: 1
name: r
links: {a: , b: }
joints:
  j:
    type: fixed
    parent: a
    child: b
    extra: <b> <![CDATA[x]]> </b><c> <![CDATA[ ]]></c>
    extra_inside:
      parent: {extra_attributes: {x: 1}, extra: <e/>}
"""


@pytest.mark.parametrize(
    ("written", "text"),
    [
        ("j.elements", "<b> x </b><c>  </c>"),
        ("j.elements | upper", "<B> X </B><C>  </C>"),
        ("j.elements | forceescape", "&lt;b&gt; x &lt;/b&gt;&lt;c&gt;  &lt;/c&gt;"),
    ],
)
def test_a_text_of_a_template_has_no_marks(tmp_path: Path, written: str, text: str):
    robot = compile_text(SPEC).robot
    assert robot is not None
    (tmp_path / "a.md.j2").write_text(f"{{% for j in urdf.joints %}}{{{{ {written} }}}}{{% endfor %}}")
    assert render_templates(robot, tmp_path) == {"a.md": text}


def test_marks_within_marks_are_removed():
    inner = inside_text(0, "e", ' x="1"', "<f/>")
    assert without_marks(f"a{inside_text(1, 'b', '', f'{inner}<c/>{inner}')}z") == "az"


def test_elements_nested_deeply_by_a_template_are_a_fault_of_it(tmp_path: Path):
    text = "{% for _ in range(N) %}<a>{% endfor %}{% for _ in range(N) %}</a>{% endfor %}"
    (tmp_path / "a.xml.j2").write_text(text.replace("N", "100"))
    assert render_templates(Robot("r"), tmp_path)["a.xml"].count("<a") == 100
    (tmp_path / "a.xml.j2").write_text(text.replace("N", "101"))
    with pytest.raises(TemplateError, match="its elements are nested more than 100 deep"):
        render_templates(Robot("r"), tmp_path)
