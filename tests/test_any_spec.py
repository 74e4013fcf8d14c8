"""The law of the whole compiler: a spec gives XML that its readers read, or is refused at a place; nothing else."""

import json

from hypothesis import HealthCheck, given, settings
from lxml import etree

from linkforge_compile import Compilation, Severity, compile_text, render_srdf, render_urdf
from tests.consumers import check_urdf, pinocchio_model
from tests.specs import RAW, specs

large = settings(suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much])


def compiled(spec: dict[str, object]) -> Compilation:
    """Compile a spec, which is YAML since JSON is; every diagnostic lies in the text."""
    text = json.dumps(spec, indent=1, ensure_ascii=False)
    compilation = compile_text(text)
    lines = text.splitlines()
    for diagnostic in compilation.diagnostics:
        assert diagnostic.span, diagnostic
        assert 1 <= diagnostic.span.line <= len(lines), diagnostic
        assert 1 <= diagnostic.span.column <= len(lines[diagnostic.span.line - 1]) + 1, diagnostic
    assert (compilation.robot is None) == any(one.severity is Severity.ERROR for one in compilation.diagnostics)
    return compilation


@large
@given(specs())
def test_a_spec_gives_xml_or_is_refused_at_a_place(spec):
    robot = compiled(spec).robot
    if robot is not None:
        for text in (render_urdf(robot), render_srdf(robot)):
            etree.fromstring(text.encode())


@large
@given(specs(without=RAW | {"version"}))  # urdfdom takes three versions, and a warning says so of any other
def test_what_compiles_is_read_by_the_readers_of_urdf(spec):
    robot = compiled(spec).robot
    if robot is not None:
        urdf = render_urdf(robot)
        assert check_urdf(urdf) == robot.root_link.name
        assert pinocchio_model(urdf).nframes > 1
