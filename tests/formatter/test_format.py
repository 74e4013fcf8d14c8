"""What the formatter changes and keeps, and that nothing else is read of a text afterwards."""

import re
from pathlib import Path
from textwrap import dedent

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile import render_srdf, render_urdf
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.export_spec import write_spec
from linkforge_compile.formatter import format_source, format_text
from linkforge_compile.pipeline import Settings, compile_path, compile_source
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.parser import PARSER, suppressions_in
from tests.conftest import ROOT

EXAMPLES = sorted((ROOT / "examples").rglob("*.robot.yaml"))


def text_of(path: Path) -> str:
    return path.read_bytes().decode("utf-8")


def is_text(path: Path) -> bool:
    try:
        return bool(text_of(path))
    except UnicodeDecodeError:
        return False


def with_four_spaces(text: str) -> str:
    """Return a text with four spaces a level instead of two."""
    text = re.sub(r"^ +", lambda found: found[0] * 2, text, flags=re.MULTILINE)
    return re.sub(r"^( +)- ", r"\1-   ", text, flags=re.MULTILINE)


CASES = [path for path in sorted((ROOT / "tests" / "cases").rglob("*.yaml")) if is_text(path)]


def read_of(text: str) -> list[tuple[object, ...]] | None:
    """Return all that PyYAML reads of a text but its places, None if it is not YAML."""
    attributes = ("anchor", "tag", "value", "style", "flow_style", "implicit", "explicit")
    try:
        events = list(yaml.parse(text, Loader=PARSER))
    except yaml.YAMLError:
        return None
    return [(type(event), *(getattr(event, one, None) for one in attributes)) for event in events]


def comments_of(text: str) -> list[str]:
    return [line.partition("#")[2].rstrip() for line in text.splitlines() if "#" in line]


def ignored_at(text: str) -> list[tuple[str, str]]:
    """Return the codes that comments ignore, and the beginning of the line at which they do."""
    file = SourceFile("robot.robot.yaml", text)
    found = [(code, file.line(one.line)) for one in suppressions_in(file) for code, _ in one.codes]
    return [(code, line.strip().partition(":")[0]) for code, line in found]


def formats(before: str, after: str) -> None:
    before, after = dedent(before).lstrip("\n"), dedent(after).lstrip("\n")
    assert format_text(before) == after
    assert format_text(after) == after
    assert read_of(after) == read_of(before)


def keeps(text: str) -> None:
    formats(text, text)


def test_each_level_is_indented_by_two_spaces_and_lists_below_their_key():
    formats(
        """
        links:
            base:
                visual:
                -   box: [1, 1, 1]
                    origin: [0, 0, 1]
                -   -   nested
                    - list
        joints:
           - a
        """,
        """
        links:
          base:
            visual:
              - box: [1, 1, 1]
                origin: [0, 0, 1]
              - - nested
                - list
        joints:
          - a
        """,
    )


def test_one_space_is_between_values_and_none_inside_brackets():
    formats(
        """
        name  :   arm
        box: [ 1,2 ,3 ]
        link: { visual : {sphere:  1},"mass":1, material: }
        empty: { }
        key: &a   !tag   {b: *c , d: *e }
        """,
        """
        name: arm
        box: [1, 2, 3]
        link: {visual: {sphere: 1}, "mass": 1, material: }
        empty: {}
        key: &a !tag {b: *c, d: *e}
        """,
    )


def test_spaces_that_align_columns_stay():
    keeps(
        """
        limits:
          lower:    -1
          upper:    1
          velocity: 2
        rows:
          - {name: left,  y: 1}
          - {name: right, y: -1}
        inertia:
          [[ 1.0, 0.5, 10.0],
           [-2.5, 0.5,  0.0]]
        """
    )


def test_spaces_that_align_nothing_go():
    formats(
        """
        a: { x: 1 }
        b: { x: 2 }
        c:   3
        d:   4
        links: { base: }
        joints: {}
        """,
        """
        a: {x: 1}
        b: {x: 2}
        c: 3
        d: 4
        links: {base: }
        joints: {}
        """,
    )


def test_a_line_of_brackets_that_continues_is_indented_but_not_joined():
    formats(
        """
        a: {b: 1,
           c: [1,
            2], d: {
               e: 1,
          },
        }
        f:
            [1,
              2]
        g: [
        1
            ]
        """,
        """
        a: {b: 1,
            c: [1,
                2], d: {
                  e: 1,
                },
           }
        f:
          [1,
           2]
        g: [
          1
        ]
        """,
    )


def test_comments_stay_at_what_they_are_about():
    formats(
        """
        # file

        links: # of the robot
            # base
            base:
                # commented: out
            tip: {mass: 1}   # three spaces
            # the end of links
        joints:
        - a
        # between
        - b
        # the end
        """,
        """
        # file

        links:  # of the robot
          # base
          base:
            # commented: out
          tip: {mass: 1}   # three spaces
          # the end of links
        joints:
          - a
          # between
          - b
        # the end
        """,
    )


def test_columns_of_comments_stay():
    formats(
        """
        links:                    # one
            base:                 # two,
                                  # on two lines
              a: 1
              b: [1,2]  # x
              ccc: [1]  # y
        """,
        """
        links:                    # one
          base:                   # two,
                                  # on two lines
            a: 1
            b: [1, 2]   # x
            ccc: [1]    # y
        """,
    )


def test_comments_in_brackets_are_indented_as_the_items():
    formats(
        """
        a: {  # first
        # x
          x: 1,  # one
              # y
          y: 2
          # end
        }
        """,
        """
        a: {  # first
          # x
          x: 1,  # one
          # y
          y: 2
          # end
        }
        """,
    )


def test_one_blank_line_stays_of_several_and_none_at_the_ends():
    assert (
        format_text("\n\n# a\n\n\n  \nname: x   \n\n\n\nlinks:\n\n\n  b:\n\n\n") == "# a\n\nname: x\n\nlinks:\n\n  b:\n"
    )


@pytest.mark.parametrize("header", ["|", ">", "|-", ">-", "|  # comment", "!tag |", "&anchor >"])
def test_the_lines_of_a_block_of_text_move_together(header: str):
    formats(
        f"""
        links:
            extra: {header}
                  <a>

                    <b/>
                  </a>


            # a comment
            other:
            - {header}
             text
        """,
        f"""
        links:
          extra: {header}
            <a>

              <b/>
            </a>

          # a comment
          other:
            - {header}
              text
        """,
    )


def test_blank_lines_that_are_text_stay():
    keeps("a: |+\n  text\n\n\n\nb: >+\n  text\n\n\n")
    assert format_text("a:\n    - |2\n        text\n\n       \n\nb: 1\n") == "a:\n  - |2\n      text\n\n     \n\nb: 1\n"
    assert format_text("a:  |\n   text") == "a: |\n  text"


def test_text_on_several_lines_stays_below_its_key():
    formats(
        """
        a:
            description: one
                two

                three
            quoted: "one \\
                     two"
            other:
                text
               goes on
        """,
        """
        a:
          description: one
              two

              three
          quoted: "one \\
                   two"
          other:
            text
            goes on
        """,
    )


def test_a_map_below_its_anchor_is_indented():
    formats(
        """
        a:
        - &first
          x: 1
        - !tag
          - &second
            y: 2
        b: &third
            z: 3
        """,
        """
        a:
          - &first
            x: 1
          - !tag
            - &second
              y: 2
        b: &third
          z: 3
        """,
    )


def test_documents_tabs_and_explicit_keys_stay():
    assert format_text("%YAML 1.2\n---\na:\tb\t# c\n...\n---\n- 1\n") == "%YAML 1.2\n---\na: b  # c\n...\n---\n- 1\n"
    assert format_text("?   a\n:   - b\n? c\n") == "? a\n: - b\n? c\n"


def test_line_ends_and_byte_order_mark_stay():
    assert format_text("\ufeffa:   1\r\nb: |\r\n   x\r\n   y\r\n") == "\ufeffa: 1\r\nb: |\r\n  x\r\n  y\r\n"
    assert format_text("a:   1\rb: 2") == "a: 1\nb: 2\n"


def test_what_only_the_slow_parser_reads_gets_a_space():
    assert format_text("limits: {lower:}\n") == "limits: {lower: }\n"


@pytest.mark.parametrize("text", ["a: [1", "a: b: c", "a: \x01", "a\tb:\n\t- c", "\0"])
def test_what_is_not_yaml_stays_as_it_is_and_is_reported_as_by_check(text: str):
    assert format_text(text) == text
    sink = Diagnostics()
    assert format_source(SourceFile("a.robot.yaml", text), sink) is None
    expected = compile_source(text, "a.robot.yaml", None, Settings()).diagnostics
    assert [str(one) for one in sink.sorted()] == [str(one) for one in expected]


def test_a_change_of_more_than_white_space_is_reported_and_not_made(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("linkforge_compile.formatter.safe_format.lay_out", lambda _: "a: 1\nb: 3\n")
    sink = Diagnostics()
    assert format_source(SourceFile("a.robot.yaml", "a:  1\nb:  2\n"), sink) is None
    (reported,) = sink
    assert (reported.code.id, str(reported.span)) == ("LF1115", "a.robot.yaml:2:5")


def test_a_comment_at_another_line_is_reported_and_not_made(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("linkforge_compile.formatter.safe_format.lay_out", lambda _: "a: 1\n# x\nb: 2\n")
    sink = Diagnostics()
    assert format_source(SourceFile("a.robot.yaml", "a: 1  # x\nb:  2\n"), sink) is None
    assert [one.code.id for one in sink] == ["LF1115"]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_is_formatted(path: Path):
    assert format_text(text_of(path)) == text_of(path)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_gives_the_same_robot_after_formatting(path: Path):
    wide = with_four_spaces(text_of(path)).replace(", ", ",   ")
    formatted = format_text(wide)
    assert formatted != wide
    before, after = (compile_source(one, str(path), path.parent, Settings()) for one in (wide, formatted))
    assert before.robot is not None
    assert after.robot is not None
    assert render_urdf(after.robot) == render_urdf(before.robot)
    assert render_srdf(after.robot) == render_srdf(before.robot)


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.name)
def test_a_case_reads_the_same_after_formatting(path: Path):
    text = text_of(path)
    formatted = format_text(text)
    assert read_of(formatted) == read_of(text)
    assert comments_of(formatted) == comments_of(text)
    assert format_text(formatted) == formatted


def test_what_linkforge_writes_is_formatted():
    robot = compile_path(str(ROOT / "examples/09_mobile_manipulator/mobile_manipulator.robot.yaml"), Settings()).robot
    assert robot is not None
    text = write_spec(robot)
    assert format_text(text) == text


BLANKS = st.text(" ", min_size=1, max_size=5)


@st.composite
def misformatted(draw: st.DrawFn) -> str:
    """Return an example with other white space, more comments, and blank lines."""
    text = text_of(draw(st.sampled_from(EXAMPLES)))
    if draw(st.booleans()):
        text = with_four_spaces(text)
    if draw(st.booleans()):
        text = re.sub(r"^( *)  - ", r"\1- ", text, flags=re.MULTILINE)
    lines = text.splitlines()
    for _ in range(draw(st.integers(0, 8))):
        number = draw(st.integers(0, len(lines) - 1))
        match draw(st.sampled_from(("comment", "own line", "blank", "spaces", "break", "shift"))):
            case "comment":
                lines[number] += draw(BLANKS) + "# linkforge: ignore LF6003"
            case "own line":
                lines.insert(number, draw(BLANKS) + "# linkforge: ignore LF5003")
            case "blank":
                lines.insert(number, draw(st.sampled_from(("", "  ", "\t"))))
            case "spaces":
                lines[number] = re.sub(r"(?<=[:,{\[]) ?", draw(BLANKS), lines[number])
            case "break":
                head, comma, tail = lines[number].partition(", ")
                lines[number] = f"{head},\n{' ' * 40}{tail}" if comma else head
            case "shift":
                lines[number] = draw(BLANKS) + lines[number]
    return "\n".join(lines) + draw(st.sampled_from(("", "\n", "\n\n")))


@given(misformatted())
def test_other_white_space_gives_the_same_values_comments_and_ignored_lines(text: str):
    formatted = format_text(text)
    assert format_text(formatted) == formatted
    assert read_of(formatted) == read_of(text)
    assert comments_of(formatted) == comments_of(text)
    assert ignored_at(formatted) == ignored_at(text)
    if read_of(text) is not None:
        assert not re.search(r"[ \t]$", formatted, re.MULTILINE) or "|" in formatted
