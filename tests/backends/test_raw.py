"""Elements that the author's own data decide."""

import pytest

from linkforge_compile.backends.raw import parameter_elements, raw_elements
from linkforge_compile.core.exceptions import RobotGeneratorError


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
        ("<a>two\nlines</a>", "<a>two&#10;lines</a>"),
        ("<a><![CDATA[x < y]]></a>", "<a>x &lt; y</a>"),
        ("<a>&#169;&amp;</a>", "<a>©&amp;</a>"),
        ("<a><!-- two\n lines --><b/></a>", "<a>\n<!-- two  lines -->\n<b/>\n</a>"),
        ("<drake:note xmlns:x='u' x:y=''/>", '<drake:note xmlns:x="u" x:y=""/>'),
        ("", ""),
    ],
)
def test_raw_xml_keeps_what_it_says_and_takes_our_layout(raw: str, lines: str):
    assert raw_elements(raw) == lines


@pytest.mark.parametrize(
    "raw",
    ["<a>", "</extra><evil/><extra>", "<a b=1/>", "<a>&lol;</a>", "<!DOCTYPE a []><a/>", "text", "<a/> tail", "\x00"],
)
def test_raw_xml_that_is_none_is_refused(raw: str):
    with pytest.raises(RobotGeneratorError):
        raw_elements(raw)


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
    assert parameter_elements(parameters).splitlines() == [
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


@pytest.mark.parametrize("key", ["two words", "1st", "a<b", "", "a:b:c", "-x"])
def test_a_key_that_is_no_tag_is_refused(key: str):
    with pytest.raises(RobotGeneratorError, match="cannot be the name of an XML element"):
        parameter_elements({key: "1"})
