"""Reading XML: places to the character, and nothing that a hostile file could make us do."""

import time

import pytest

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.importers import xml as reader
from linkforge_compile.importers.xml import read_xml
from linkforge_compile.limits import MAX_NESTED_ELEMENTS
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.characters import UnreadableError, xml_text
from linkforge_compile.source.xml_tree import XmlComment, XmlElement


def document(text: str):
    sink = Diagnostics()
    read = read_xml(SourceFile("robot.urdf", text), sink)
    assert not [str(one) for one in sink]
    assert read
    return read


def codes(text: str) -> list[str]:
    sink = Diagnostics()
    assert read_xml(SourceFile("robot.urdf", text), sink) is None
    return [diagnostic.code.id for diagnostic in sink]


def elements(element: XmlElement):
    yield element
    for child in element.children:
        yield from elements(child)


@pytest.mark.parametrize(
    ("text", "place", "problem"),
    [
        (" \n", (1, 1), "the file is empty"),
        ("<!-- x -->", (1, 11), "there is no element in it"),
        ("<a>\n <b>\n</a>", (3, 3), "expected </b>, found </a>"),
        ("<a>\n <b>", (2, 5), "it ends before </b>"),
        ('<a b="x & y"/>', (1, 9), "write '&amp;' for the character '&'"),
        ("<a>R&D</a>", (1, 5), "write '&amp;' for the character '&'"),
        ("<a ä=c/>", (1, 6), "an attribute value must be in quotes; write '\"c\"'"),
        ('<a b="c>\n<d/></a>', (2, 1), "'<' is not allowed in an attribute value; close its quote, or write '&lt;'"),
        ("<a><!-- ä -- c --></a>", (1, 11), "'--' is not allowed in a comment"),
        (
            "<a>\n<<<<<<< HEAD\n</a>",
            (2, 1),
            "this line belongs to a git merge conflict; keep one of the two sides",
        ),
        ("<a/>\n<a/>", (2, 1), "only comments may follow the root element"),
        ('<a b="1"c="2"/>', (1, 9), "invalid token"),
        ("< a/>", (1, 2), "invalid token"),
        ("<a>\n <b c='d\n", (2, 2), "this tag is not closed"),
    ],
)
def test_malformed_xml_is_reported_where_its_place_is_certain(text: str, place: tuple[int, int], problem: str):
    sink = Diagnostics()
    assert read_xml(SourceFile("robot.urdf", text), sink) is None
    [diagnostic] = sink
    assert diagnostic.span
    assert (diagnostic.message, (diagnostic.span.line, diagnostic.span.column)) == (
        f"this is not XML: {problem}",
        place,
    )


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_a_span_holds_what_is_written_there(end: str):
    text = end.join(
        (
            '<robot name="größe">',
            "  <!-- größe 一 --> <link",
            "     name = 'a&amp;b'",
            '     other="ö"/>  <link name="𝔘"><visual/></link></robot>',
        )
    )
    root = document(text).root

    def written(span: Span) -> str | None:
        return span.text

    links = list(root.children)
    assert [written(link.span) for link in elements(root)] == ["<robot", "<link", "<link", "<visual"]
    assert [written(one.span) for one in root.attributes.values()] == ["größe"]
    assert {name: (one.value, written(one.span)) for name, one in links[0].attributes.items()} == {
        "name": ("a&b", "a&amp;b"),
        "other": ("ö", "ö"),
    }
    assert links[1].raw == '<link name="𝔘"><visual/></link>'
    assert links[0].raw == text[text.index("<link") : text.index("  <link", text.index("<link") + 1)]


def test_raw_text_ends_where_the_element_ends():
    root = document("<robot name='r'><a><b/></a><c x='>'/><d></d ><e/></robot>").root
    assert [child.raw for child in root.children] == ["<a><b/></a>", "<c x='>'/>", "<d></d >", "<e/>"]


def test_names_keep_their_prefixes_whatever_declares_them():
    inside = "<x:b xml:space='default'/><drake:c xmlns:x='w' d:e=''/><f:g:h/>"
    text = f"<robot xmlns='u' xmlns:x = 'v' x:a='1:2'>{inside}</robot>"
    root = document(text).root
    assert [(one.tag, dict(one.values)) for one in elements(root)] == [
        ("robot", {"xmlns": "u", "xmlns:x": "v", "x:a": "1:2"}),
        ("x:b", {"xml:space": "default"}),
        ("drake:c", {"xmlns:x": "w", "d:e": ""}),
        ("f:g:h", {}),
    ]
    assert [one.span.text for one in root.attributes.values()] == ["u", "v", "1:2"]


def test_a_name_that_other_readers_refuse_is_refused():
    """Of the fifth edition of XML 1.0, which lxml takes, and neither xacro nor Python's own parsers."""
    assert document("<größe 高='1'/>")
    assert codes("<robot><𝔘/></robot>") == codes("<robot 𝔘='1'/>") == ["LF8001"]


def test_a_comment_follows_the_tag_that_ends_on_its_line():
    text = "<robot at='>'> <!-- zero --><a/> <!-- one --> <!-- two -->\n<!-- three --><b/><!-- four --></robot>"
    content = document(text).root.content
    assert [(one.text.strip(), one.follows) for one in content if isinstance(one, XmlComment)] == [
        ("zero", True),
        ("one", True),
        ("two", True),
        ("three", False),
        ("four", True),
    ]


@pytest.mark.parametrize(
    "start",
    [
        "",
        '<?xml version="1.0"?>',
        '<?xml version="1.1" encoding="latin-1" standalone="no" ?>\n',
        '\n\n<?xml version="1.0" encoding="utf-8"?>\n',
        '<!-- made by a script\n--><?xml version="2.0" ?>',
        '<?xml version="größer"?>',
    ],
)
def test_a_declaration_may_be_late_and_of_any_version(start: str):
    root = document(f'{start}<robot name="ö"/>').root
    assert root.get("name") == "ö"
    assert root.span.text == "<robot"


@pytest.mark.parametrize(
    ("data", "name"),
    [
        ('<robot name="ö"/>'.encode(), "ö"),
        ('<robot name="ö"/>'.encode("utf-8-sig"), "ö"),
        ('<robot name="ö"/>'.encode("utf-16"), "ö"),
        ('<?xml version="1.0" encoding="ISO-8859-1"?><robot name="ö"/>'.encode("latin-1"), "ö"),
        ('<?xml version="1.0" encoding="gb2312"?><robot name="机"/>'.encode("gb2312"), "机"),
    ],
)
def test_a_file_is_read_in_its_declared_encoding(data: bytes, name: str):
    assert document(xml_text(data)).root.get("name") == name


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"<robot>\n\xff</robot>", "line 2 has the byte 0xff, which is not utf-8"),
        (b'<?xml version="1.0" encoding="UTF-16"?><robot/>', "it declares the encoding UTF-16, which it is not in"),
        (b'<?xml version="1.0" encoding="klingon"?><robot/>', "there is no encoding 'klingon' of text here"),
        (b'<?xml version="1.0" encoding="zip"?><robot/>', "there is no encoding 'zip' of text here"),
        (b'<?xml version="1.0" encoding="unicode_escape"?><robot/>', "there is no encoding 'unicode_escape'"),
    ],
)
def test_bytes_that_are_no_text_are_refused(data: bytes, reason: str):
    with pytest.raises(UnreadableError, match=reason):
        xml_text(data)


def test_depth_is_bounded():
    assert document("<a>" * MAX_NESTED_ELEMENTS + "</a>" * MAX_NESTED_ELEMENTS)
    assert codes("<a>" * (MAX_NESTED_ELEMENTS + 1) + "</a>" * (MAX_NESTED_ELEMENTS + 1)) == ["LF8003"]


def test_of_a_limit_and_malformed_xml_the_first_is_reported():
    assert codes("<a>" * (MAX_NESTED_ELEMENTS + 1) + "<b c=1>") == ["LF8003"]
    assert codes("<b c=1>" + "<a>" * (MAX_NESTED_ELEMENTS + 1)) == ["LF8001"]
    assert codes("<a><?b c?><d></a><?b c?>") == ["LF8102", "LF8001"]


def test_a_text_that_lxml_finds_too_long_is_refused():
    sink = Diagnostics()
    assert read_xml(SourceFile("robot.urdf", f"<robot>\n{'x' * 10_500_000}</robot>"), sink) is None
    reason = "a text or a value in it has more than 10 MB, or a name more than 50,000 characters"
    assert [one.message for one in sink] == [f"this is not XML: {reason}"]


def test_an_open_cdata_is_reported_where_it_begins():
    sink = Diagnostics()
    assert read_xml(SourceFile("robot.urdf", "<robot><![CDATA[a]]><![CDATA[<![CDATA[<![CDATA["), sink) is None
    assert [one.span.column for one in sink if one.span] == [21]


def test_the_number_of_elements_is_bounded(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(reader, "MOST_ELEMENTS", 3)
    assert document("<a><b/><b/></a>")
    assert codes("<a><b/><b/><b/></a>") == ["LF8004"]
    assert codes("<a><b/><!-- 1 --><!-- 2 --></a>") == ["LF8004"]
    assert codes("<a><b/><b/><?p?></a>") == ["LF8004"]


@pytest.mark.parametrize("one_more", ["<b/>", "<!-- c -->", "text"])
def test_what_one_element_holds_is_bounded(monkeypatch: pytest.MonkeyPatch, one_more: str):
    monkeypatch.setattr(reader, "MOST_INSIDE", 3)
    assert document("<a><b/> <b><b/><b/><b/></b></a>")
    assert codes(f"<a><b/><!-- c --><b/>{one_more}</a>") == ["LF8098"]


def test_comments_outside_of_the_robot_are_bounded(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(reader, "MOST_INSIDE", 3)
    assert codes("<!-- 1 --><!-- 2 --><!-- 3 --><a/>") == ["LF8098"]


def test_many_comments_are_read_in_time_that_grows_with_their_number():
    began = time.process_time()
    assert document("<robot>" + f"<!-- {'x' * 120} -->\n" * 40_000 + "</robot>")
    assert time.process_time() - began < 2


@pytest.mark.parametrize("piece", ["<!--", "<![CDATA[", "<?a ", "<a '", '<a b="', "<a b ", "</a ", "<"])
def test_what_is_never_closed_is_refused_in_time_that_grows_with_its_length(piece: str):
    began = time.process_time()
    assert codes(f"<robot>{piece * 200_000}") == ["LF8001"]
    assert time.process_time() - began < 2


@pytest.mark.parametrize(
    "text",
    [
        "<!DOCTYPE robot ["
        + "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 50}">' for n in range(1, 40))
        + "]><r>&e39;</r>",
        '<!DOCTYPE robot SYSTEM "file:///dev/random"><robot/>',
        '<!DOCTYPE robot [<!ENTITY % p SYSTEM "http://10.255.255.1/x"> %p;]><robot/>',
    ],
)
def test_entities_are_refused_before_they_do_anything(text: str):
    began = time.perf_counter()
    assert codes(text) == ["LF8002"]
    assert time.perf_counter() - began < 1
