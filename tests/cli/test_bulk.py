"""`linkforge compile` of several specs: one process, one report, and outputs as each spec's own compile writes them."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from linkforge_compile.cli import reports
from tests.cli.in_process import linkforge
from tests.programs import program

ARM = """\
linkforge: 1
name: arm
links: {base: , rod: {visual: {box: [1, 1, 1]}}}
joints: {turn: {type: fixed, parent: base, child: rod}}
semantic: {groups: {arm: {joints: [turn]}}}
"""
HAND = "linkforge: 1\nname: hand\nlinks: {palm: }\n"
FAULTY = "linkforge: 1\nname: faulty\nlinks: {base: }\njoints: {j: {type: fixed, parent: base, child: rood}}\n"
WARNED = "linkforge: 1\nname: warned\nlinks: {base: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 3}}}}\n"


@pytest.fixture
def robots(tmp_path: Path) -> Path:
    """A folder `robots` with two right specs and a faulty one, in the folder that is returned."""
    folder = tmp_path / "robots"
    folder.mkdir()
    for name, text in {"arm": ARM, "faulty": FAULTY, "hand": HAND}.items():
        (folder / f"{name}.robot.yaml").write_text(text)
    return tmp_path


def files(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in sorted(folder.iterdir())}


BOTH = ("robots/arm.robot.yaml", "robots/hand.robot.yaml")


def test_outputs_are_those_of_a_compile_of_each_spec(robots: Path):
    run = linkforge("compile", *BOTH, "-o", "build/", "--source-map", cwd=robots)
    assert (run.returncode, run.stdout) == (0, "")
    assert run.stderr == "compiled 2 specs, 6 files written: no errors\n"
    for spec in BOTH:
        linkforge("compile", spec, "-o", "single/", "--source-map", cwd=robots)
    assert files(robots / "build") == files(robots / "single")
    again = linkforge("compile", *BOTH, "-o", "build/", cwd=robots)
    assert again.stderr == "compiled 2 specs, 3 files up to date: no errors\n"


def test_errors_of_one_spec_do_not_stop_the_others(robots: Path):
    run = linkforge("compile", "robots/", "nowhere.robot.yaml", "-o", "build/", cwd=robots)
    assert run.returncode == 1
    assert sorted(files(robots / "build")) == ["arm.srdf", "arm.urdf", "hand.urdf"]
    lines = [line for line in run.stderr.splitlines() if not line.startswith(" ")]
    assert lines == [
        "robots/faulty.robot.yaml:4:48: error: no link named 'rood' [LF4102]",
        "error: there is no file 'nowhere.robot.yaml' [LF3001]",
        "compiled 2 of 4 specs, 3 files written: 2 errors",
    ]


def test_a_fault_of_a_module_that_two_specs_use_is_reported_once(robots: Path):
    for name in ("cell", "hall"):
        modules = "modules: {m: {use: faulty.robot.yaml, parent: floor}}\n"
        (robots / "robots" / f"{name}.robot.yaml").write_text(
            f"linkforge: 1\nname: {name}\nlinks: {{floor: }}\n{modules}"
        )
    run = linkforge("compile", "robots/cell.robot.yaml", "robots/hall.robot.yaml", "-o", "build/", cwd=robots)
    assert run.stderr.count("no link named 'rood'") == 1
    assert run.stderr.endswith("compiled none of 2 specs: 1 error\n")


def test_a_module_in_the_folder_that_cannot_be_compiled_by_itself_is_no_robot(robots: Path):
    (robots / "robots" / "faulty.robot.yaml").unlink()
    (robots / "robots" / "wheel.robot.yaml").write_text(
        "linkforge: 1\nname: wheel\nparameters: {radius: {type: length}}\n"
        "links: {wheel: {visual: {sphere: {radius: $(radius)}}}}\n"
    )
    (robots / "robots" / "cart.robot.yaml").write_text(
        "linkforge: 1\nname: cart\nlinks: {base: }\n"
        "modules: {w: {use: wheel.robot.yaml, parent: base, with: {radius: 1 m}}}\n"
    )
    run = linkforge("compile", "robots", "-o", "build/", cwd=robots)
    assert (run.returncode, run.stderr) == (0, "compiled 3 specs, 4 files written: no errors\n")
    assert "wheel.urdf" not in files(robots / "build")
    named = linkforge("compile", "robots", "robots/wheel.robot.yaml", "-o", "build/", cwd=robots)
    assert named.returncode == 1
    assert "parameter 'radius' has no default" in named.stderr


def test_two_specs_with_one_output_are_refused_before_anything_is_written(robots: Path):
    (robots / "other").mkdir()
    (robots / "other" / "hand.robot.yaml").write_text(HAND)
    run = linkforge("compile", "robots/", "other/", "-o", "build/", cwd=robots)
    assert run.returncode == 2
    assert "'build/hand.urdf' would be that of 'robots/hand.robot.yaml' and of 'other/hand.robot.yaml'" in run.stderr
    assert not (robots / "build").exists()


def test_an_output_that_another_spec_is_made_from_is_refused(robots: Path):
    (robots / "hand.urdf").write_text('<robot name="vendor"><link name="palm"/></robot>')
    (robots / "cell.robot.yaml").write_text(
        "linkforge: 1\nname: cell\nlinks: {base: }\nmodules: {m: {use: hand.urdf, parent: base}}\n"
    )
    run = linkforge("compile", "robots/hand.robot.yaml", "cell.robot.yaml", "-o", ".", cwd=robots)
    assert run.returncode == 2
    assert "'hand.urdf' would be replaced, and the robot is made from it" in run.stderr
    assert "vendor" in (robots / "hand.urdf").read_text()
    assert not (robots / "cell.urdf").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ((*BOTH,), "-o takes one folder for the outputs of several specs, found none"),
        ((*BOTH, "-o", "-"), "-o takes one folder for the outputs of several specs, found -o -"),
        ((*BOTH, "-o", "a.urdf"), "-o takes one folder for the outputs of several specs, found -o a.urdf"),
        (("robots/", "-o", "a.urdf", "-o", "a.srdf"), "several specs, found -o a.urdf -o a.srdf"),
        ((*BOTH, "length=1", "-o", "b/"), "there is no spec 'length=1'; write '-p length=1' to set a parameter"),
        ((*BOTH, "", "-o", "b/"), "takes specs, found '': is a variable of the shell empty?"),
        ((BOTH[0], "--format", "urdf", "--format", "srdf", "-o", "a.urdf"), "several --format go with -o FOLDER/"),
        ((*BOTH, "-o", "b/", "--template", "t"), "'b/joints.md' would be that of 'robots/arm.robot.yaml' and of"),
        ((*BOTH, "-o", "b/", "--check", "--depfile", "d"), "--check writes nothing, so there is no --depfile with it"),
    ],
)
def test_what_several_specs_cannot_have_is_refused(robots: Path, words: tuple[str, ...], message: str):
    (robots / "t").mkdir()
    (robots / "t" / "joints.md.j2").write_text("x")
    run = linkforge("compile", *words, cwd=robots)
    assert run.returncode == 2
    assert message in run.stderr
    assert sorted(path.name for path in robots.iterdir()) == ["robots", "t"]


def test_templates_that_override_those_of_linkforge_are_for_every_spec(robots: Path):
    (robots / "t" / "urdf").mkdir(parents=True)
    (robots / "t" / "urdf" / "robot.xml.j2").write_text('<robot name="{{ robot.name }}" own="1"/>')
    run = linkforge("compile", *BOTH, "-o", "build/", "--template", "t", "--format", "urdf", cwd=robots)
    assert run.returncode == 0, run.stderr
    assert [text.count('own="1"') for text in files(robots / "build").values()] == [1, 1]


def test_every_stale_file_is_reported(robots: Path):
    linkforge("compile", *BOTH, "-o", "build/", cwd=robots)
    words = ("compile", *BOTH, "-o", "build/", "--check")
    assert linkforge(*words, cwd=robots).stderr == "checked 2 specs, 3 files up to date: no errors\n"
    (robots / "build" / "arm.srdf").unlink()
    (robots / "build" / "hand.urdf").write_text("old\n")
    run = linkforge(*words, cwd=robots)
    assert run.returncode == 1
    assert [code in run.stderr for code in ("[LF7096]", "[LF7095]")] == [True, True]
    assert run.stderr.endswith("checked none of 2 specs: 2 errors\n")
    assert not (robots / "build" / "arm.srdf").exists()


def test_formats_that_are_requested_are_those_written(robots: Path):
    run = linkforge("compile", BOTH[0], "-o", "build/", "--format", "urdf", "--format", "srdf", cwd=robots)
    assert (run.returncode, sorted(files(robots / "build"))) == (0, ["arm.srdf", "arm.urdf"])
    run = linkforge("compile", *BOTH, "-o", "build/", "--format", "urdf", "--format", "srdf", cwd=robots)
    assert run.returncode == 1
    assert "robot 'hand' has no 'semantic' part" in run.stderr


def test_make_reads_the_depfile_of_several_specs(robots: Path):
    shutil.copy(robots / "robots" / "hand.robot.yaml", robots / "part.yaml")
    (robots / "cell.robot.yaml").write_text(
        "linkforge: 1\nname: cell\nlinks: {base: }\nmodules: {m: {use: part.yaml, parent: base, prefix: m_}}\n"
    )
    run = linkforge("compile", BOTH[1], "cell.robot.yaml", "-o", "build/", "--depfile", "robots.d", cwd=robots)
    assert (run.returncode, run.stderr) == (0, "")
    (robots / "Makefile").write_text(
        "all: build/hand.urdf build/cell.urdf\nbuild/%.urdf:\n\t@echo $@\n-include robots.d\n"
    )

    def outdated() -> list[str]:
        made = subprocess.run([program("make")], cwd=robots, capture_output=True, text=True, check=True, timeout=60)
        return [line for line in made.stdout.splitlines() if line.startswith("build/")]

    assert outdated() == []
    later = (robots / "build" / "cell.urdf").stat().st_mtime + 5
    os.utime(robots / "part.yaml", (later, later))
    assert outdated() == ["build/cell.urdf"]


def test_a_report_for_programs_is_one_document(robots: Path):
    run = linkforge("compile", "robots/", "-o", "build/", "--diagnostics", "json", cwd=robots)
    assert run.returncode == 1
    assert [one["code"] for one in json.loads(run.stderr)["diagnostics"]] == ["LF4102"]


def test_a_warning_as_an_error_keeps_back_the_output_of_its_spec(robots: Path):
    (robots / "warned.robot.yaml").write_text(WARNED)
    words = ("compile", BOTH[1], "warned.robot.yaml", "-o", "build/")
    assert linkforge(*words, "--werror", cwd=robots).returncode == 1
    assert sorted(files(robots / "build")) == ["hand.urdf"]
    assert linkforge(*words, cwd=robots).returncode == 0


def test_progress_is_printed_when_it_takes_long(robots: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(reports, "PROGRESS_INTERVAL", 0.0)
    words = ("compile", *BOTH, "-o", "build/")
    assert linkforge(*words, cwd=robots).stderr.splitlines()[0] == "compiled 1 of 2 specs"
    assert linkforge(*words, "-q", cwd=robots).stderr == ""
    assert linkforge(*words, "--depfile", "d", cwd=robots).stderr == ""


def test_a_folder_with_one_spec_is_compiled_into_a_folder(robots: Path):
    (robots / "one").mkdir()
    (robots / "one" / "hand.robot.yaml").write_text(HAND)
    run = linkforge("compile", "one/", cwd=robots)
    assert (run.returncode, run.stdout) == (2, "")
    assert "-o takes one folder for the outputs of several specs, found none" in run.stderr
    run = linkforge("compile", "one/", "-o", "build/", cwd=robots)
    assert (run.returncode, run.stderr) == (0, "wrote build/hand.urdf\n")


def test_a_folder_without_specs_is_an_error(robots: Path):
    (robots / "empty").mkdir()
    run = linkforge("compile", "empty/", "-o", "build/", cwd=robots)
    assert run.returncode == 1
    assert run.stderr.splitlines() == [
        "error: there is no spec, NAME.robot.yaml, in the folder 'empty/' or below it [LF3067]",
        "compiled no specs: 1 error",
    ]


VARIED = """\
linkforge: 1
name: arm
parameters: {size: 1 m}
variants: {small: {size: 10 cm}, large: {size: 9 m}}
links: {base: {visual: {box: [$(size), 1, 1]}}}
"""


def test_each_of_several_variants_has_outputs_of_its_own(robots: Path):
    (robots / "robots" / "arm.robot.yaml").write_text(VARIED)
    words = ("compile", "robots/arm.robot.yaml", "-o", "build/", "--variant", "small")
    run = linkforge(*words, "--variant", "small+large", cwd=robots)
    assert (run.returncode, run.stderr.splitlines()[-1]) == (
        0,
        "compiled 1 spec, 2 files written: 1 warning",
    )
    assert "note: with variant 'small+large' only" in run.stderr
    sizes = {name: text.partition('box size="')[2][:3] for name, text in files(robots / "build").items()}
    assert sizes == {"arm_small.urdf": "0.1", "arm_small+large.urdf": "9 1"}
    run = linkforge(*words, "--variant", "small", cwd=robots)
    assert (run.returncode, run.stderr) == (0, "wrote build/arm.urdf\n")
    run = linkforge(*words[:2], *words[4:], "--variant", "large", cwd=robots)
    assert "-o takes one folder for the outputs of several variants, found none" in run.stderr


def test_check_reports_several_variants_together(robots: Path):
    (robots / "robots" / "arm.robot.yaml").write_text(VARIED.replace("9 m}", "0 m}"))
    run = linkforge("check", "robots/arm.robot.yaml", "--variant", "small", "--variant", "large", cwd=robots)
    assert "note: with variant 'large' only" in run.stderr


@pytest.mark.parametrize("variant", ["../escaped", "a/b", "a\\b", ".hidden"])
def test_a_variant_that_cannot_be_part_of_a_file_name_is_refused(robots: Path, variant: str):
    (robots / "robots" / "arm.robot.yaml").write_text(VARIED.replace("small:", f"'{variant}':"))
    words = ("compile", "robots/arm.robot.yaml", "-o", "build/", "--variant", variant)
    assert linkforge(*words, cwd=robots).returncode == 0
    run = linkforge(*words, "--variant", "large", cwd=robots)
    assert (run.returncode, sorted(files(robots / "build"))) == (2, ["arm.urdf"])
    assert f"several --variant are part of the names of files, which '{variant}' cannot be" in run.stderr


@pytest.mark.parametrize("command", [("compile", "-", "-o", "build/"), ("check", "-")])
def test_standard_input_is_not_compiled_in_several_variants(robots: Path, command: tuple[str, ...]):
    run = linkforge(*command, "--variant", "small", "--variant", "large", cwd=robots)
    assert run.returncode == 2
    assert "several --variant take files, not standard input, which can be read once" in run.stderr


def test_a_spec_that_is_named_in_two_ways_is_compiled_once(robots: Path):
    run = linkforge("compile", "robots/hand.robot.yaml", "./robots/../robots/hand.robot.yaml", "-o", "b/", cwd=robots)
    assert (run.returncode, run.stderr) == (0, "wrote b/hand.urdf\n")
    (robots / "linked.robot.yaml").symlink_to("robots/hand.robot.yaml")
    linkforge("compile", "robots/hand.robot.yaml", "linked.robot.yaml", "-o", "links/", cwd=robots)
    assert list(files(robots / "links")) == ["hand.urdf", "linked.urdf"]


def test_outputs_that_differ_in_case_alone_are_refused(robots: Path):
    (robots / "Hand.robot.yaml").write_text(HAND)
    run = linkforge("compile", "Hand.robot.yaml", BOTH[1], "-o", "build/", cwd=robots)
    assert run.returncode == 2
    assert "'build/hand.urdf' would be that of 'Hand.robot.yaml' and of 'robots/hand.robot.yaml'" in run.stderr


def test_modules_of_a_folder_that_are_left_out_have_no_outputs_that_clash(robots: Path):
    for side in ("left", "right"):
        (robots / side).mkdir()
        (robots / side / "wheel.robot.yaml").write_text(
            "linkforge: 1\nname: wheel\nparameters: {radius: {type: length}}\nlinks: {wheel: }\n"
        )
    uses = ", ".join(
        f"{side}: {{use: {side}/wheel.robot.yaml, parent: base, prefix: {side}_, with: {{radius: 1}}}}"
        for side in ("left", "right")
    )
    (robots / "car.robot.yaml").write_text(f"linkforge: 1\nname: car\nlinks: {{base: }}\nmodules: {{{uses}}}\n")
    shutil.rmtree(robots / "robots")
    run = linkforge("compile", ".", "-o", "build/", cwd=robots)
    assert (run.returncode, run.stderr) == (0, "wrote build/car.urdf\n")


def test_an_unknown_parameter_is_reported_for_each_spec(robots: Path):
    run = linkforge("compile", *BOTH, "-o", "build/", "-p", "reach=1", cwd=robots)
    assert run.stderr.count("no parameter named 'reach' [LF3020]") == 2
    assert [f"{spec}:1:1: note: this file declares no parameters" in run.stderr for spec in BOTH] == [True, True]
    assert run.stderr.endswith("compiled none of 2 specs: 2 errors\n")
