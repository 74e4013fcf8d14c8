"""`render` and `render_files`: any format by its name, from Python."""

import pytest

from linkforge_compile import compile_text, formats, render, render_files, render_srdf, render_urdf
from linkforge_compile.formats import FORMATS
from tests.formats.example_formats import Folder

SPEC = """\
linkforge: 1
name: arm
links:
  base:
  rod: {inertial: {mass: 1 kg, inertia: {ixx: 1, iyy: 1, izz: 1}}}
joints:
  elbow: {type: revolute, parent: base, child: rod, axis: z, limits: {lower: 0, upper: 1, effort: 1, velocity: 1}}
transmissions:
  drive: {type: transmission_interface/SimpleTransmission, joints: {elbow: }, actuators: {motor: }}
semantic: {groups: {all: {links: [base]}}}
"""

ROBOT = compile_text(SPEC).result()


def test_a_format_by_its_name_is_what_its_own_function_makes():
    assert render(ROBOT, "urdf", banner="one") == render_urdf(ROBOT, banner="one")
    assert render(ROBOT, "srdf", pretty=False) == render_srdf(ROBOT, pretty=False)
    assert "<freejoint" in render(ROBOT, "mjcf", options={"base": "free"})


@pytest.mark.parametrize("name", [one.name for one in FORMATS if not one.missing(ROBOT)])
def test_files_are_named_as_the_command_names_them(name: str):
    one = formats.format_named(name)
    files = [f"arm{one.suffix}/{file}" for file in one.files] or [f"arm{one.suffix}"]
    assert list(render_files(ROBOT, name)) == files


def test_a_format_of_several_files_is_a_text_by_file(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(formats, "FORMATS", (*FORMATS, Folder()))
    assert render_files(ROBOT, "folder")["arm_config/links.txt"] == "links.txt\n"
    with pytest.raises(ValueError, match="folder is 2 files; render_files returns them"):
        render(ROBOT, "folder")


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("mjfc", {}, "there is no format 'mjfc'; did you mean 'mjcf'?"),
        ("mjcf", {"bsae": "free"}, "no format has an option 'bsae'"),
        ("mjcf", {"base": "loose"}, "base takes 'fixed' or 'free', found 'loose'"),
    ],
)
def test_an_unknown_format_or_option_is_reported(name: str, options: dict[str, str], message: str):
    for call in (
        lambda: render(ROBOT, name, options=options),
        lambda: compile_text(SPEC, formats=[name], options=options),
    ):
        with pytest.raises(ValueError, match=message.replace("?", r"\?")):
            call()


def test_a_compile_reports_what_the_formats_it_is_for_lose():
    assert not compile_text(SPEC).diagnostics
    codes = {one.code.id for one in compile_text(SPEC, formats=["mjcf"]).diagnostics}
    assert "LF7413" in codes
