"""Elements that the author's own data decide."""

import gc

import pytest

from linkforge_compile.core import Robot
from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.formats.element import parameter_elements
from linkforge_compile.formats.raw import raw_elements
from linkforge_compile.formats.render import render_urdf
from linkforge_compile.formats.xml_document import parse_rendered, write
from linkforge_compile.formats.xml_text import RawXmlError


def laid_out(text: str) -> str:
    """Return the lines that a document has of a text, as far to the left as they go."""
    lines = write(parse_rendered(text), pretty=True).split("\n")
    return "\n".join(line.lstrip(" ") for line in lines)


KEPT_SPACE = '<a xml:space="preserve"> <b> </b> <c xml:space="default"/></a>'


@pytest.mark.parametrize(
    ("raw", "lines"),
    [
        ("<a/>", "<a/>"),
        ("<a></a>", "<a/>"),
        ("<a>\n   </a>", "<a/>"),
        ("<a x='1' b=\"2\"/>\n<c/>", '<a x="1" b="2"/>\n<c/>'),
        ("<a> 1 2 </a>", "<a> 1 2 </a>"),
        ("<a>\n  <b>\n <c/></b></a>", "<a>\n<b>\n<c/>\n</b>\n</a>"),
        ("<a>some <b>bold</b> text<c/></a>", "<a>some <b>bold</b> text<c/></a>"),
        ("<a> &#32; </a>", "<a/>"),
        ("<a><![CDATA[ ]]></a>", "<a> </a>"),
        ("<a xml:space='preserve'> <b> </b> <c xml:space='default'> </c></a>", KEPT_SPACE),
        ('<a>"q" &quot;\ttab</a>', '<a>"q" "\ttab</a>'),
        ("<a><![CDATA[x < y]]></a>", "<a>x &lt; y</a>"),
        ("<a>&#169;&amp;</a>", "<a>©&amp;</a>"),
        ("<a><!-- one --><b/></a>", "<a>\n<!-- one -->\n<b/>\n</a>"),
        ("<!-- before --><a/>", "<!-- before -->\n<a/>"),
        ("<a/>&#10;<b/>", "<a/>\n<b/>"),
        ("<a><![CDATA[x]]> <b> </b></a>", "<a>x <b> </b></a>"),
        ("<drake:note xmlns:x='u' x:y=''/>", '<drake:note xmlns:x="u" x:y=""/>'),
        ("", ""),
    ],
)
def test_raw_xml_keeps_its_content_and_gets_the_layout(raw: str, lines: str):
    assert laid_out(raw_elements(raw)) == lines


COMMENTED = """\
<a>
  <!-- two
   lines, <b></b> and </a> -->
  <text>
    1 2
    3 4
  </text>
  <b>text<!-- <c></c>
  --></b>
</a>
"""


@pytest.mark.parametrize("pretty", [True, False])
def test_comments_and_texts_of_several_lines_stay_as_they_are(pretty: bool):
    kept = ["<!-- two\n   lines, <b></b> and </a> -->", "<text>\n    1 2\n    3 4\n  </text>"]
    document = render_urdf(Robot("r", extra_elements=[COMMENTED]), pretty=pretty)
    assert all(text in document for text in (*kept, "<b>text<!-- <c></c>\n  --></b>"))


def test_a_line_end_of_windows_is_one_as_in_every_reader():
    assert raw_elements("<a>1\r\n2&#13;</a>") == raw_elements("<a>1\n2&#13;</a>")
    assert "<a>1\n2&#13;</a>" in render_urdf(Robot("r", extra_elements=["<a>1\r\n2&#13;</a>"]))


def test_a_processing_instruction_is_refused_with_the_reason():
    with pytest.raises(RobotGeneratorError, match=r"'<\?sort'; most URDF readers refuse a file with one"):
        raw_elements("<a><?sort by name?></a>")


@pytest.mark.parametrize(
    "raw",
    [
        "<a>",
        "</extra><evil/><extra>",
        "<a b=1/>",
        "<a>&lol;</a>",
        "<!DOCTYPE a []><a/>",
        "text",
        "<?a b?>",
        "<a/> tail",
        "\x00",
    ],
)
def test_raw_xml_that_is_none_is_refused(raw: str):
    with pytest.raises(RobotGeneratorError):
        raw_elements(raw)


@pytest.mark.parametrize(
    ("raw", "at", "problem"),
    [
        ("<a/>\n<b c='ä\n", 5, "raw XML is not well-formed: this tag is not closed"),
        ("<a>\n<!-- b\n", 4, "raw XML is not well-formed: this comment is not closed"),
        ("<a>\n<![CDATA[b\n", 4, "raw XML is not well-formed: this CDATA is not closed; it ends with ']]>'"),
        ("<a/></extra><b/>", 6, "raw XML is not well-formed: </extra> closes no open element"),
        ("< a/>", 1, "raw XML is not well-formed: invalid token"),
        ("<?xml version='1.0'?><a/>", 0, "raw XML is part of a file, which has its '<?xml'; delete this one"),
        ("<ä/>\n é &gt; <b/>", 6, "raw XML must be elements, found text"),
        ("<a/> é\n", 5, "raw XML must be elements, found text"),
        ("<a/> é > 1", 5, "raw XML must be elements, found text"),
        ("é <a b=1/>", 7, "raw XML is not well-formed: an attribute value must be in quotes; write '\"1\"'"),
        ("<a/> R&D", 6, "raw XML is not well-formed: write '&amp;' for the character '&'"),
        ("<a b:𝔘='1'/>", 5, "raw XML is not well-formed: invalid token"),
        ("<a/>\n<![CDATA[ ]]>", 5, "raw XML must be elements, found text"),
        (
            "<é/><?a b?>",
            4,
            "raw XML contains the processing instruction '<?a'; most URDF readers refuse a file with one",
        ),
        ("\n" + "<a>" * 101, 298, "raw XML is nested more than 100 elements deep"),
    ],
)
def test_a_fault_in_raw_xml_is_reported_at_its_place(raw: str, at: int, problem: str):
    with pytest.raises(RawXmlError) as refused:
        raw_elements(raw)
    assert (refused.value.at, refused.value.problem) == (at, problem)


def test_raw_xml_cannot_be_bottomless():
    with pytest.raises(RobotGeneratorError, match="nested more than 100 elements deep"):
        raw_elements("<a>" * 5000 + "</a>" * 5000)


def test_parameters_become_elements():
    parameters = {
        "rate": "1.10",
        "empty": "",
        "on": True,
        "noise": {"_type": "gaussian", "mean": 0, "stddev": 0.5},
        "remap": ["a:=b", "c:=d"],
        "pose": {"_relative_to": "base", "_text": "0 0 <1"},
    }
    assert laid_out(parameter_elements(parameters)).splitlines() == [
        "<rate>1.10</rate>",
        "<empty/>",
        "<on>true</on>",
        '<noise type="gaussian">',
        "<mean>0</mean>",
        "<stddev>0.5</stddev>",
        "</noise>",
        "<remap>a:=b</remap>",
        "<remap>c:=d</remap>",
        '<pose relative_to="base">0 0 &lt;1</pose>',
    ]


@pytest.mark.parametrize("key", ["two words", "1st", "a<b", "", "a:b:c", "-x", "a\ufffd", "a:\u0300", "\ud800"])
def test_a_key_that_is_no_tag_is_refused(key: str):
    with pytest.raises(RobotGeneratorError, match="cannot be the name of an XML element"):
        parameter_elements({key: "1"})


def test_a_tag_may_be_in_any_language():
    assert laid_out(parameter_elements({"größe": "1", "ros:高さ": "2"})) == "<größe>1</größe>\n<ros:高さ>2</ros:高さ>"


def test_text_next_to_an_element_of_the_same_name_stays_xml():
    robot = Robot(name="r", extra_elements=("<a>in <a x='1'/></a>",))
    assert '<a>in <a x="1"/></a>' in render_urdf(robot)


def test_what_was_read_leaves_nothing_for_the_collector():
    """Which rests in a compile: 50,000 raw parts would take 2 GB."""
    gc.collect()
    gc.disable()
    try:
        raw_elements("<a>\n<b/>\n</a>" + " " * 10_000)
        with pytest.raises(RobotGeneratorError):
            raw_elements("<a>" + " " * 10_000)
        assert gc.collect() == 0
    finally:
        gc.enable()
