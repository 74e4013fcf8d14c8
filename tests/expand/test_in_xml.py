"""What expressions put into raw XML is text there: no value of a parameter makes an element or an attribute."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from linkforge_compile import compile_file, compile_text, render_urdf

HOSTILE = '\'"><evil a="1"/>&lt;]]><!-- --><b/>\t--'
SPEC = """
linkforge: 1
name: r
parameters: {value: {type: string}}
variables: {nothing: ''}
links:
  base:
    extra:
      - <a single='$(value)' double="$(value)">x $(value) y</a>
      - <b>$(value)$(value)</b>
      - <c><![CDATA[a < $(value)]]$(nothing)>$(value)]]></c>
      - <!-- ($(value).$(value)) -$(nothing)-><d e="$(value)"/>
"""


def extras(value: str) -> list[etree._Element]:
    robot = compile_text(SPEC, parameters={"value": value}).result()
    return list(etree.fromstring(render_urdf(robot).encode())[0])


@given(st.text(st.sampled_from("<>-&\"']![CDATA?/ab \t\n"), max_size=12))
def test_a_value_is_the_text_that_it_is(value: str):
    a, b, c, comment, d = extras(value)
    assert dict(a.attrib) == {"single": value, "double": value}
    assert (a.text, b.text, c.text) == (f"x {value} y", value * 2 if value.strip() else None, f"a < {value}]]>{value}")
    assert d.attrib == {"e": value}
    assert isinstance(comment, etree._Comment)
    assert not any(map(len, (a, b, c, d)))


def test_what_is_one_expression_as_a_whole_is_the_xml():
    robot = compile_text("""
linkforge: 1
name: r
variables: {note: <note>a &lt; b</note>}
links: {base: {extra: [$(note), $(note)]}}
""").result()
    assert robot.link("base").extra_elements == ("<note>a &lt; b</note>",) * 2


def test_only_extra_is_xml():
    robot = compile_text("""
linkforge: 1
name: r
variables: {sign: <}
links: {base: {extra_attributes: {a: 1 $(sign) 2}, gazebo: {properties: {extra: 1 $(sign) 2}}}}
""").result()
    assert robot.link("base").extra_attributes == (("a", "1 < 2"),)
    assert robot.gazebo_elements[0].properties == {"extra": "1 < 2"}


@pytest.mark.parametrize("key", ["override", "with"])
def test_an_override_and_a_module_are_no_way_round(key: str, tmp_path: Path):
    says = {
        "with": "with: {value: $(value)}",
        "override": "override: {links: {hand: {extra: '<a>$(value)</a>'}}}",
    }
    (tmp_path / "hand.robot.yaml").write_text(
        "linkforge: 1\nname: hand\nparameters: {value: {default: ''}}\nlinks: {hand: {extra: '<a>$(value)</a>'}}\n"
    )
    spec = tmp_path / "arm.robot.yaml"
    spec.write_text(
        "linkforge: 1\nname: arm\nparameters: {value: {type: string}}\n"
        f"modules: {{tool: {{use: hand.robot.yaml, {says[key]}}}}}\n"
    )
    [link] = compile_file(spec, parameters={"value": HOSTILE}).result().links
    [element] = etree.fromstring(f"<r>{link.extra_elements[0]}</r>")
    assert (element.tag, element.text, len(element)) == ("a", HOSTILE, 0)
