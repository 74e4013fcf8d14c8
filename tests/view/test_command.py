"""`linkforge view -o`: the files that it writes, and what it refuses."""

import json
import re
import struct
from pathlib import Path

import pytest

from linkforge_compile.cli.commands.view import LAYERS
from linkforge_compile.view import html, picture
from tests.cli.in_process import linkforge
from tests.meshes import block, content

PAGE = Path(html.__file__).parent / "page"

SPEC = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 1 m}
links:
  base: {visual: {box: ["$(reach)", 0.1, 0.1]}}
  tip: {visual: {mesh: gone.stl}}
  end: {}
  twin: {}
joints:
  bend: {type: revolute, parent: base, child: tip, axis: x, limits: {lower: -2, upper: 2, effort: 1, velocity: 1}}
  weld: {type: fixed, parent: tip, child: end}
  echo: {type: continuous, parent: base, child: twin, axis: x, mimic: {joint: bend}}
semantic:
  groups: {arm: {joints: [bend]}, all: {joints: [bend]}}
  group_states: {arm: {home: {bend: 0.5}, out: {bend: 1}}}
"""


@pytest.fixture
def arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with a spec; the page is one of a few lines."""
    page = tmp_path / "page" / "out" / "view.html"
    page.parent.mkdir(parents=True)
    page.write_text(
        '<head></head><body><script id="scene" type="application/json">null</script></body>\n</html>', "utf-8"
    )
    monkeypatch.setattr(html, "view_page_file", lambda: page)
    (tmp_path / "arm.robot.yaml").write_text(SPEC, "utf-8")
    return tmp_path


def scene_in(file: Path) -> dict:
    return json.loads(re.findall(r'<script id="scene"[^>]*>(.*?)</script>', file.read_text("utf-8"))[0])


def test_a_page_has_the_scene_and_what_the_options_say(arm: Path):
    options = ("--pose", "arm/home", "--camera=-40,25,2", "--show", "collisions,frames", "reach:=0.7m")
    done = linkforge("view", "arm.robot.yaml", "-o", "arm.html", *options, cwd=arm)
    assert done.returncode == 0, done.stderr
    assert done.stderr.splitlines()[-1] == "wrote arm.html"
    scene = scene_in(arm / "arm.html")
    assert scene["view"] == {
        "panels": True,
        "pose": {"bend": 0.5},
        "camera": {"azimuth": -40, "elevation": 25, "distance": 2},
        "layers": ["collisions", "frames"],
    }
    assert scene["links"][0]["visuals"][0]["size"] == [0.7, 0.1, 0.1]
    assert not scene["live"]
    (line,) = (line for line in done.stderr.splitlines() if "'gone.stl'" in line)
    assert line == "arm.robot.yaml:7:24: warning: there is no mesh 'gone.stl' [LF6021]"
    assert linkforge("view", "arm.robot.yaml", "-o", "arm.html", *options, cwd=arm).stderr.endswith("up to date\n")


def test_a_urdf_and_standard_input_are_shown(arm: Path):
    assert linkforge("compile", "arm.robot.yaml", "-o", "arm.urdf", cwd=arm).returncode == 0
    assert linkforge("view", "arm.urdf", "-o", "-", "--format", "html", cwd=arm).stdout.startswith("<head>")
    assert linkforge("view", "-", "-o", "b.htm", cwd=arm, stdin=SPEC).returncode == 0
    assert scene_in(arm / "b.htm")["name"] == "arm"


def test_a_spec_with_errors_writes_nothing(arm: Path):
    (arm / "arm.robot.yaml").write_text(SPEC.replace("child: tip", "child: top"), "utf-8")
    done = linkforge("view", "arm.robot.yaml", "-o", "arm.html", cwd=arm)
    assert done.returncode == 1
    assert "arm.robot.yaml:11" in done.stderr
    assert not (arm / "arm.html").exists()


@pytest.mark.parametrize(
    ("poses", "position"),
    [
        (("arm/out",), 1),
        (("home",), 0.5),
        (("bend=0.25",), 0.25),
        (("bend=-90 deg",), -1.5707963267948966),
        (("out", "bend=90deg"), 1.5707963267948966),
        (("bend=90deg", "out"), 1),
    ],
)
def test_a_pose_is_a_state_or_a_position(arm: Path, poses: tuple[str, ...], position: float):
    words = [word for pose in poses for word in ("--pose", pose)]
    assert linkforge("view", "arm.robot.yaml", "-o", "a.html", *words, cwd=arm).returncode == 0
    assert scene_in(arm / "a.html")["view"]["pose"] == {"bend": pytest.approx(position)}


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("-o", "arm.svg"), "ends in .html or .png, found 'arm.svg'"),
        (("-o", "a.html", "-o", "a.html"), "is given twice"),
        (("-o", "a.html", "--pose", "arm/hom"), "no state 'arm/hom'; did you mean 'arm/home'?"),
        (("-o", "a.html", "--pose", "hom"), "no state 'hom'; did you mean 'home'?"),
        (("-o", "a.html", "--pose", "bned=1"), "'bned' is not a joint of the robot; did you mean 'bend'?"),
        (
            ("-o", "a.html", "--pose", "bend=3"),
            "--pose bend=3: joint 'bend' is from -2 rad to 2 rad; did you mean 'bend=3deg'?",
        ),
        (("-o", "a.html", "--pose", "bend=180deg"), "'bend' is from -114.592 deg to 114.592 deg"),
        (("-o", "a.html", "--pose", "bend=1 m"), "joint 'bend' takes an angle such as 0.5 or '30 deg', found '1 m'"),
        (("-o", "a.html", "--pose", "bend=up"), "joint 'bend' takes an angle such as 0.5 or '30 deg', found 'up'"),
        (("-o", "a.html", "--camera", "1"), "takes AZIMUTH,ELEVATION[,DISTANCE] in degrees and metres, found '1'"),
        (("-o", "a.html", "--pose", "weld=1"), "'weld' is fixed, and has no position of its own"),
        (("-o", "a.html", "--pose", "echo=1"), "'echo' follows joint 'bend', and has no position of its own"),
        (("-o", "a.html", "--camera", "1,nan"), "found '1,nan'"),
        (("-o", "a.html", "--camera", "-40,25"), "expected one argument; write --camera=-40,25, as a minus begins"),
        (("-o", "a.html", "--camera", "1,91"), "from -90 to 90"),
        (("-o", "a.html", "--camera", "1,1,0"), "above 0 m"),
        (("-o", "a.html", "--size", "100"), "takes WIDTHxHEIGHT, each up to 8192 pixels, found '100'"),
        (("-o", "a.html", "--size", "100x9000"), "found '100x9000'"),
        (("-o", "a.html", "--show", "frame"), "no layer 'frame'; did you mean 'frames'?"),
        (("-o", "arm.robot.yaml", "--format", "html"), "would be replaced"),
    ],
)
def test_a_wrong_option_is_named(arm: Path, words: tuple[str, ...], reason: str):
    done = linkforge("view", "arm.robot.yaml", *words, cwd=arm)
    assert done.returncode == 2
    assert reason in done.stderr
    assert not (arm / "a.html").exists()


def test_a_mesh_is_not_replaced_by_the_picture(arm: Path):
    (arm / "wood.png").write_bytes(b"x")
    (arm / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: r\nlinks: {a: {visual: {sphere: 1, material: {name: m, texture: wood.png}}}}\n", "utf-8"
    )
    done = linkforge("view", "arm.robot.yaml", "-o", "wood.png", cwd=arm)
    assert (done.returncode, "would be replaced" in done.stderr) == (2, True)
    assert (arm / "wood.png").read_bytes() == b"x"


def test_without_a_browser_nothing_is_written(arm: Path):
    done = linkforge(
        "view", "arm.robot.yaml", "-o", "a.html", "-o", "a.png", cwd=arm, **{picture.VARIABLE: "no-such-browser"}
    )
    assert done.returncode == 2
    assert "linkforge view: there is no program 'no-such-browser', which LINKFORGE_BROWSER names" in done.stderr
    assert not list(arm.glob("a.*"))


def test_many_missing_files_are_one_line_a_reason(arm: Path):
    meshes = "".join(f"  l{n}: {{visual: {{mesh: 'package://nowhere/{n}.stl'}}}}\n" for n in range(4))
    joints = "".join(f"  j{n}: {{type: fixed, parent: l0, child: l{n}}}\n" for n in range(1, 4))
    (arm / "arm.robot.yaml").write_text(f"linkforge: 1\nname: r\nlinks:\n{meshes}joints:\n{joints}", "utf-8")
    done = linkforge("view", "arm.robot.yaml", "-o", "a.html", cwd=arm)
    (line,) = (line for line in done.stderr.splitlines() if "not shown" in line)
    assert "arm.robot.yaml:4:" in line
    assert "warning: 'package://nowhere/0.stl' and 3 other files are not shown: package 'nowhere' is not found" in line


def test_a_picture_has_the_size_that_is_asked_for(page: Path, browser: object, tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(SPEC.replace("visual: {mesh: gone.stl}", ""), "utf-8")
    done = linkforge("view", "arm.robot.yaml", "-o", "arm.png", "--size", "200x100", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "wrote arm.png\n")
    assert struct.unpack(">II", (tmp_path / "arm.png").read_bytes()[16:24]) == (200, 100)


@pytest.mark.parametrize(
    ("link", "options", "hint"),
    [
        ("{collision: {sphere: 1}}", (), "the robot has no visuals; use --show collisions,frames"),
        ("{}", ("--show", "visuals,inertias"), "the robot has no visuals or inertias; use --show frames"),
        ("{}", ("--show", "frames"), ""),
        ("{visual: {sphere: 1}}", (), ""),
    ],
)
def test_an_empty_picture_comes_with_a_hint(
    link: str, options: tuple[str, ...], hint: str, arm: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(picture, "find_browser", lambda: ["browser"])
    monkeypatch.setattr(picture, "draw_picture", lambda *_: picture.Picture(b"png", {}))
    (arm / "arm.robot.yaml").write_text(f"linkforge: 1\nname: r\nlinks: {{a: {link}}}\n", "utf-8")
    done = linkforge("view", "arm.robot.yaml", "-o", "a.png", *options, cwd=arm)
    assert done.stderr == (f"the picture is empty: {hint}\n" if hint else "") + "wrote a.png\n"


def test_what_the_browser_cannot_read_is_a_warning_with_its_place(page: Path, browser: object, tmp_path: Path):
    mesh = content(block(1, 1, 1), "ply")
    (tmp_path / "half.ply").write_bytes(mesh[:-40])
    (tmp_path / "arm.robot.yaml").write_text("linkforge: 1\nname: r\nlinks: {a: {visual: {mesh: half.ply}}}\n", "utf-8")
    done = linkforge("view", "arm.robot.yaml", "-o", "arm.png", "--size", "200x100", cwd=tmp_path)
    line = "arm.robot.yaml:3:28: warning: 'half.ply' is not shown: the file ends before its data does\n"
    assert (done.returncode, done.stderr) == (0, f"{line}wrote arm.png\n")


def test_the_layers_are_those_of_the_page():
    text = (PAGE / "src" / "state.ts").read_text("utf-8")
    (layers,) = re.findall(r"LAYERS = \[(.*?)\]", text)
    assert tuple(re.findall(r'"(\w+)"', layers)) == LAYERS
