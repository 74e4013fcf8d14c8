"""What a live viewer holds: the last good scene, problems, settings and versions, without a network."""

from pathlib import Path
from threading import Thread

import pytest

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics.reports import Selection
from linkforge_compile.view.session import Session, State

ARM = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 50 cm, minimum: 10 cm, maximum: 2 m, description: To the tool.}
  tool: {enum: [gripper, probe], default: gripper}
  half: {type: length, default: $(reach / 2)}
variants:
  long: {reach: 1.5 m}
links:
  base: {visual: {box: [10 cm, 10 cm, $(reach)]}}
"""

TRIANGLE = (
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {} 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"
)


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "arm.robot.yaml"
    path.write_text(ARM)
    return path


@pytest.fixture
def session(spec: Path) -> Session:
    session = Session(spec, Settings([]))
    session.renew()
    return session


def height(state: State) -> float:
    return state.scene["links"][0]["visuals"][0]["size"][2]


def test_the_first_state_has_the_scene_of_the_spec(session: Session):
    state = session.state
    assert (state.version, state.scene_version, state.is_current) == (1, 1, True)
    assert height(state) == 0.5
    assert state.update_since(0)["problems"] == []


def test_a_change_of_the_spec_makes_a_new_scene(session: Session, spec: Path):
    assert session.poll() == ()
    spec.write_text(ARM.replace("50 cm", "70 cm"))
    assert session.poll() == (spec,)
    assert height(session.renew()) == 0.7
    assert session.state.update_since(1)["scene"] == session.state.scene
    assert session.state.scene["version"] == 2


def test_a_spec_with_errors_keeps_the_last_scene_and_shows_what_check_shows(session: Session, spec: Path):
    spec.write_text(ARM.replace("box:", "bxo:"))
    state = session.renew()
    assert (state.version, state.scene_version, state.is_current) == (2, 1, False)
    assert height(state) == 0.5
    update = state.update_since(1)
    assert update["scene"] is None
    (problem,) = update["problems"]
    assert (problem["severity"], problem["code"], problem["line"], problem["column"]) == ("error", "LF2101", 10, 19)
    assert problem["file"] == spec.name or problem["file"] == str(spec)
    assert problem["message"].endswith("did you mean 'box'?")
    assert (problem["hints"], problem["page"]) == (["write 'box'"], "codes/LF2101")
    assert problem["snippet"].splitlines()[1].endswith("^^^")


def test_a_corrected_spec_has_no_problems_and_the_same_scene_again(session: Session, spec: Path):
    spec.write_text("linkforge: 1\n  oh: {")
    assert session.renew().update_since(1)["problems"]
    spec.write_text(ARM)
    state = session.renew()
    assert (state.version, state.scene_version, state.is_current) == (3, 1, True)
    assert state.update_since(2) | {"settings": None} == {"version": 3, "scene": None, "problems": [], "settings": None}


def test_a_spec_with_errors_from_the_start_has_no_scene_but_parameters(spec: Path):
    spec.write_text(ARM.replace("box:", "bxo:"))
    session = Session(spec, Settings([]))
    update = session.renew().update_since(0)
    assert (update["scene"], session.state.scene["links"]) == (None, [])
    assert [one["name"] for one in update["settings"]["parameters"]] == ["reach", "tool", "half"]


def test_a_parameter_has_what_its_widget_needs(session: Session):
    settings = session.state.update_since(0)["settings"]
    assert settings["parameters"][0] == {
        "name": "reach",
        "type": "length",
        "unit": "m",
        "value": None,
        "default": "50 cm",
        "number": 0.5,
        "minimum": 0.1,
        "maximum": 2,
        "choices": None,
        "description": "To the tool.",
    }
    assert settings["parameters"][1]["choices"] == ["gripper", "probe"]
    assert settings["parameters"][2]["default"] == "0.25 m"
    assert (settings["variants"], settings["variant"]) == (["long"], None)


def test_a_chosen_value_makes_a_new_scene(session: Session):
    session.choose({"reach": "1 m"}, None)
    assert session.poll() == ("parameter reach",)
    assert height(session.renew()) == 1
    assert session.state.update_since(0)["settings"]["parameters"][0]["value"] == "1 m"


def test_a_refused_value_is_a_problem_and_the_scene_stays(session: Session):
    session.choose({"reach": "3 kg"}, None)
    state = session.renew()
    (problem,) = state.update_since(0)["problems"]
    assert problem["code"] == "LF3023"
    assert "parameter 'reach' takes a length" in problem["message"]
    assert (problem["file"], problem["line"]) == (None, None)
    assert height(state) == 0.5
    assert state.update_since(0)["settings"]["parameters"][0]["value"] == "3 kg"


def test_a_variant_replaces_defaults_and_a_chosen_value_has_precedence(session: Session):
    session.choose({}, "long")
    assert session.poll() == ("the variant",)
    state = session.renew()
    assert height(state) == 1.5
    assert state.update_since(0)["settings"]["parameters"][0]["default"] == "1.5 m"
    session.choose({"reach": "1 m"})
    assert height(session.renew()) == 1
    assert session.state.settings.variant == "long"
    session.choose({}, None)
    assert session.poll() == ("parameter reach", "the variant")
    assert session.renew().settings.variant is None


def test_values_of_the_command_line_are_those_of_the_widgets(spec: Path):
    session = Session(spec, Settings(["reach:=80 cm", "tool=probe"], variant="long"))
    settings = session.renew().update_since(0)["settings"]
    assert height(session.state) == 0.8
    assert [one["value"] for one in settings["parameters"]] == ["80 cm", "probe", None]
    assert settings["variant"] == "long"


def test_a_chosen_value_of_a_parameter_that_the_spec_loses_has_no_effect(session: Session, spec: Path):
    session.choose({"half": "20 cm"}, None)
    session.renew()
    spec.write_text("\n".join(line for line in ARM.splitlines() if "half:" not in line))
    assert session.renew().update_since(0)["problems"] == []
    spec.write_text(ARM)
    assert session.renew().update_since(0)["settings"]["parameters"][2]["value"] == "20 cm"


def test_choices_during_a_compile_are_compiled_as_one(session: Session):
    session.choose({"reach": "1 m"}, None)
    session.choose({"reach": "1.2 m"}, None)
    session.choose({"reach": "1.4 m", "tool": "probe"}, None)
    assert session.poll() == ("parameter reach", "parameter tool")
    assert height(session.renew()) == 1.4
    assert session.poll() == ()


def test_two_pages_change_one_parameter_each(session: Session):
    session.choose({"reach": "1 m"})
    session.choose({"tool": "probe"})
    settings = session.renew().update_since(0)["settings"]
    assert [one["value"] for one in settings["parameters"]] == ["1 m", "probe", None]
    session.choose({"reach": None})
    assert [one["value"] for one in session.renew().update_since(0)["settings"]["parameters"]] == [None, "probe", None]


def test_choices_with_a_unit_are_written_as_the_value_is(tmp_path: Path):
    spec = tmp_path / "arm.robot.yaml"
    spec.write_text(ARM.replace("half:", "grip: {type: length, enum: [10 cm, 0.2 m], default: 20 cm}\n  half:"))
    session = Session(spec, Settings([]))
    by_name = {one["name"]: one for one in session.renew().update_since(0)["settings"]["parameters"]}
    assert (by_name["grip"]["choices"], by_name["grip"]["default"]) == ([0.1, 0.2], "0.2 m")
    session.choose({"grip": "10 cm"})
    by_name = {one["name"]: one for one in session.renew().update_since(0)["settings"]["parameters"]}
    assert by_name["grip"]["value"] == "0.1 m"
    assert session.state.version == 2


def test_warnings_that_the_user_ignores_are_no_problems(spec: Path):
    spec.write_text(
        f"{ARM}  hand: {{}}  # linkforge: ignore LF6003\njoints: {{j: {{type: fixed, parent: base, child: hand}}}}\n"
    )
    assert [one["code"] for one in Session(spec, Settings([])).renew().update_since(0)["problems"]] == ["LF1204"]
    ignoring = Session(spec, Settings([]), Selection(ignore=("LF1204",)))
    assert ignoring.renew().update_since(0)["problems"] == []


def test_a_mesh_is_watched_and_its_former_bytes_are_kept_for_pages_that_still_load_them(spec: Path):
    spec.write_text("linkforge: 1\nname: arm\nlinks: {base: {visual: {mesh: part.stl}}}\n")
    session = Session(spec, Settings([]))
    update = session.renew().update_since(0)
    (problem,) = update["problems"]
    assert (problem["code"], problem["line"], problem["hints"][-1]) == ("LF6021", 3, "not shown in 'base'")
    assert update["scene"]["missing"] == [], "it is listed once"
    mesh, digests = spec.with_name("part.stl"), []
    for size in (1, 2, 3):
        mesh.write_text(TRIANGLE.format(size))
        assert session.poll() == (mesh,)
        (digest,) = session.renew().update_since(0)["scene"]["files"]
        digests.append(digest)
    assert session.state.content_of(digests[0]) is None
    assert [session.state.content_of(one) for one in digests[1:]] == [
        ("stl", TRIANGLE.format(size).encode()) for size in (2, 3)
    ]


def test_a_file_that_is_missing_is_watched(session: Session, spec: Path):
    spec.write_text(f"{ARM}modules: {{hand: {{use: hand.robot.yaml, parent: base}}}}\n")
    assert session.renew().update_since(0)["problems"][0]["code"] == "LF3001"
    session.poll()
    hand = spec.with_name("hand.robot.yaml")
    hand.write_text("linkforge: 1\nname: hand\nlinks: {palm: }\n")
    assert hand.name in {Path(one).name for one in session.poll()}
    assert session.renew().is_current


def test_who_waits_gets_the_next_state_and_none_after_the_end(session: Session):
    found: list[State] = []
    waiting = Thread(target=lambda: found.append(session.wait(1, 60)))
    waiting.start()
    session.renew()
    waiting.join(60)
    assert [state.version for state in found] == [2]
    assert session.wait(2, 0.01) is session.state
    session.close()
    assert session.wait(2, 60) is session.state


@pytest.mark.parametrize("name", ["arm.urdf", "arm.urdf.xacro"])
def test_a_robot_in_xml_is_shown_too(name: str, tmp_path: Path):
    file = tmp_path / name
    head = '<robot name="arm" xmlns:xacro="http://wiki.ros.org/xacro"><xacro:arg name="hand" default="palm"/>'
    link = '<link name="$(arg hand)"/></robot>'
    file.write_text(head + link if "xacro" in name else '<robot name="arm"><link name="palm"/></robot>')
    session = Session(file, Settings([]))
    assert session.renew().update_since(0)["scene"]["links"][0]["name"] == "palm"
    if "xacro" in name:
        session.choose({"hand": "claw"}, None)
        update = session.renew().update_since(0)
        assert update["scene"]["links"][0]["name"] == "claw"
        assert [(one["name"], one["value"]) for one in update["settings"]["parameters"]] == [("hand", "claw")]
