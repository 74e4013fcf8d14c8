"""The same fault of many parts is one diagnostic; a comment takes one part out of it."""

from linkforge_compile import compile_text
from linkforge_compile.diagnostics import Diagnostic


def arm(count: int, comment: str = "") -> str:
    """Return a robot with powerless joints from line 5 on, with a comment on the first one."""
    links = ", ".join(f"l{number}: " for number in range(count))
    joint = "type: prismatic, parent: base, axis: z, limits: {lower: 0, upper: 1, effort: 0, velocity: 1}"
    first, *others = [f"  j{number}: {{child: l{number}, {joint}}}" for number in range(count)]
    return "\n".join(("linkforge: 1", "name: arm", f"links: {{base: , {links}}}", "joints:", first + comment, *others))


def lines_of(diagnostic: Diagnostic) -> list[int]:
    return [place.span.line for place in (diagnostic, *diagnostic.notes) if place.span]


def test_the_first_of_many_is_reported_with_the_names_and_places_of_others():
    (powerless,) = compile_text(arm(12)).diagnostics
    assert powerless.message == (
        "joint 'j0' cannot be driven: its limit of effort is 0; "
        "the same for 'j1', 'j2', 'j3', 'j4', 'j5', 'j6', 'j7' and 4 more"
    )
    assert lines_of(powerless) == [5, 6, 7, 8]
    assert powerless.notes[0].message == "joint 'j1' cannot be driven: its limit of effort is 0"
    assert powerless.notes[-1].message == "and 8 more"


def test_a_comment_takes_its_part_out_of_the_group():
    (powerless,) = compile_text(arm(12, "  # linkforge: ignore LF5506")).diagnostics
    assert powerless.message.startswith("joint 'j1' cannot be driven: its limit of effort is 0; the same for 'j2', ")
    assert lines_of(powerless)[0] == 6


def test_a_group_of_two_shows_both_places():
    (powerless,) = compile_text(arm(2)).diagnostics
    assert powerless.message == "joint 'j0' cannot be driven: its limit of effort is 0; the same for 'j1'"
    assert lines_of(powerless) == [5, 6]
