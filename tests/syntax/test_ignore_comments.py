"""The edits that add a comment to ignore a warning, and those that remove what such a comment need not name."""

import pytest

from linkforge_compile import Compilation, compile_text
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.fix import apply_edits
from linkforge_compile.syntax.ignore_comments import ignore_fix

HEADER = "linkforge: 1\nname: a\n"
INERTIAL = "inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 5}}"


def reported(compilation: Compilation, code: str) -> Diagnostic:
    return next(one for one in compilation.diagnostics if one.code.id == code)


def ignoring(text: str, code: str) -> str | None:
    """Return a text with the comment that ignores its diagnostic of a code, None if it can have none."""
    one = reported(compile_text(text), code)
    fix = ignore_fix(one)
    if fix is None:
        return None
    changed = apply_edits(one.span.file, fix.edits)
    assert code not in {other.code.id for other in compile_text(changed).diagnostics}
    return changed


def test_the_comment_is_above_the_line_with_its_indentation():
    spec = f"{HEADER}links:\n  base:\n    {INERTIAL}   # the vendor's\n"
    expected = f"{HEADER}links:\n  base:\n    # linkforge: ignore LF6003\n    {INERTIAL}   # the vendor's\n"
    assert ignoring(spec, "LF6003") == expected


@pytest.mark.parametrize(
    "comment", ["  # linkforge: ignore LF6004{} why", "  # linkforge: ignore LF6004, LF6007{} # and more"]
)
def test_a_comment_that_is_there_gets_the_code(comment: str):
    spec = f"{HEADER}links:\n  base: {{{INERTIAL}}}"
    assert ignoring(spec + comment.format(""), "LF6003") == spec + comment.format(", LF6003")


def test_a_comment_above_gets_the_code():
    spec = f"{HEADER}links:\n  # linkforge: ignore LF6004 why\n\n  base: {{{INERTIAL}}}\n"
    assert ignoring(spec, "LF6003") == spec.replace("LF6004", "LF6004, LF6003")


def test_line_ends_are_kept():
    spec = f"{HEADER}links:\n  base: {{{INERTIAL}}}\n".replace("\n", "\r\n")
    changed = ignoring(spec, "LF6003")
    assert changed is not None
    assert changed.count("\r\n") == changed.count("\n") == 5


def test_a_line_of_a_flow_map_gets_its_comment():
    spec = f"{HEADER}links: {{\n  base: {{\n    {INERTIAL}\n  }}\n}}\n"
    assert ignoring(spec, "LF6003") == spec.replace("    inertial", "    # linkforge: ignore LF6003\n    inertial")


def test_all_parts_of_a_group_get_a_comment():
    limits = "limits: {lower: 0, upper: 1, effort: 0, velocity: 1}"
    joint = f"{{type: revolute, parent: {{}}, child: {{}}, axis: x, {limits}}}"
    joints = "".join(
        f"  {child}_joint: {joint.replace('{}', parent, 1).replace('{}', child, 1)}\n" for parent, child in ("ab", "bc")
    )
    changed = ignoring(f"{HEADER}links: {{a: , b: , c: }}\njoints:\n{joints}", "LF5506")
    assert changed is not None
    assert changed.count("# linkforge: ignore LF5506") == 2


def test_a_text_of_several_lines_can_have_no_comment():
    spec = f"{HEADER}links: {{a: }}\ngazebo:\n  - extra: |\n      <a/>\n      <b>$(sin(90))</b>\n"
    assert ignoring(spec, "LF3144") is None


def test_an_error_cannot_be_ignored():
    assert ignoring(f"{HEADER}links: {{a: {{visul: }}}}\n", "LF2101") is None


@pytest.mark.parametrize(
    ("comment", "code", "expected"),
    [
        ("a: {}   # linkforge: ignore LF6003 why", "LF1204", "a: {}"),
        ("a: {}   # linkforge: ignore LF6003   # why", "LF1204", "a: {}   # why"),
        ("# linkforge: ignore LF6003 why\n  a: {}", "LF1204", "a: {}"),
        ("a: {}   # linkforge: ignore LF4102, LF6003", "LF1203", "a: {}   # linkforge: ignore LF6003"),
        ("a: {}   # linkforge: ignore LF6003, LF4102", "LF1203", "a: {}   # linkforge: ignore LF6003"),
        ("a: {}   # linkforge disable LF6003", "LF1275", "a: {}   # linkforge: ignore LF6003"),
        ("a: {}   # linkforge: ignore LF60003", "LF1202", "a: {}   # linkforge: ignore LF6003"),
    ],
)
def test_what_a_comment_need_not_name_is_removed(comment: str, code: str, expected: str):
    spec = f"{HEADER}links:\n  {{}}\n"
    one = reported(compile_text(spec.replace("{}", comment, 1)), code)
    (fix,) = one.fixes
    changed = apply_edits(one.span.file, fix.edits)
    assert changed == (spec.replace("{}", expected, 1))
