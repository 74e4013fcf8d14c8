"""`linkforge check --fix`, run as a program."""

from pathlib import Path

import pytest

from linkforge_compile import compile_text
from tests.cli.in_process import linkforge
from tests.cli.test_compile import PENDULUM

FAULTY = """\
\ufeff# a comment\r
linkforge: 1\r
name: faulty\r
parameters: {height: 1 m}\r
links:\r
  base: {visual: {box: [1, 1, "${height}"]}}   # another\r
  arm:\r
joints:\r
  hinge: {type: Fixed, parent: base, child:arm}\r
"""


def write(path: Path, text: str) -> Path:
    path.write_bytes(text.encode())
    return path


def test_safe_fixes_are_written_and_the_rest_of_the_file_is_kept(tmp_path: Path):
    spec = write(tmp_path / "faulty.robot.yaml", FAULTY)
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert (run.returncode, run.stdout) == (0, "")
    assert run.stderr.splitlines() == ["fixed 3 problems in faulty.robot.yaml", "checked 1 spec: no errors"]
    expected = FAULTY.replace("${height}", "$(height)").replace("Fixed", "fixed").replace("child:arm", "child: arm")
    assert spec.read_bytes().decode() == expected


def test_without_the_option_nothing_is_written(tmp_path: Path):
    spec = write(tmp_path / "faulty.robot.yaml", FAULTY)
    assert linkforge("check", cwd=tmp_path).returncode == 1
    assert spec.read_bytes().decode() == FAULTY


SLIPS = """\
linkforge: 1
name: case
links:
  base:
    visual:
      -box: [1, 1, 1]
  arm: {visual: [box: [1, 1, 1]]}
joints:
  elbow:
    type: hinge
    parent_link: base
    child_link: arm
    axis: [0 0 1]
    limit: {min: 0, max: 1, torque: 3, speed: 4}
"""


def test_slips_of_docs_that_call_them_safe_are_fixed_at_once(tmp_path: Path):
    spec = write(tmp_path / "slips.robot.yaml", SLIPS)
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.stderr.splitlines() == ["fixed 10 problems in slips.robot.yaml", "checked 1 spec: no errors"]
    limits = "limits: {lower: 0, upper: 1, effort: 3, velocity: 4}"
    expected = (
        SLIPS.replace("-box", "- box").replace("_link", "").replace("hinge", "revolute").replace("0 0 1", "0, 0, 1")
    )
    assert spec.read_text() == expected.replace("limit: {min: 0, max: 1, torque: 3, speed: 4}", limits)


def test_tabs_below_spaces_are_left(tmp_path: Path):
    text = "linkforge: 1\nname: case\nlinks:\n  base:\n\ttip:\n"
    spec = write(tmp_path / "tabs.robot.yaml", text)
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert "YAML is indented with spaces, found a tab [LF1002]" in run.stderr
    assert spec.read_text() == text


def test_what_is_not_certain_is_left_and_reported(tmp_path: Path):
    text = FAULTY.replace("child:arm", "child: amr").replace("Fixed", "fixed").replace("${height}", "$(hight)")
    spec = write(tmp_path / "faulty.robot.yaml", text)
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.returncode == 1
    assert "problem" not in run.stderr
    assert "did you mean 'arm'?" in run.stderr
    assert spec.read_bytes().decode() == text


def test_errors_that_a_syntax_error_hid_are_fixed_in_the_same_run(tmp_path: Path):
    spec = write(tmp_path / "arm.robot.yaml", PENDULUM.replace("name: ", "name:").replace("continuous", "Continuous"))
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.stderr.splitlines() == ["fixed 2 problems in arm.robot.yaml", "checked 1 spec: no errors"]
    assert spec.read_text() == PENDULUM


def test_a_module_is_fixed_once_for_all_its_users(tmp_path: Path):
    part = write(tmp_path / "part.robot.yaml", "linkforge: 1\nname: part\nlinks: {base: {visual: {Sphere: 0.1}}}\n")
    for name in ("one", "two"):
        use = "modules:\n  a: {use: part.robot.yaml, parent: base}\n  b: {use: part.robot.yaml, parent: base}\n"
        write(tmp_path / f"{name}.robot.yaml", f"linkforge: 1\nname: {name}\nlinks: {{base: }}\n{use}")
    run = linkforge("check", "--fix", "one.robot.yaml", "two.robot.yaml", cwd=tmp_path)
    assert run.stderr.splitlines()[0] == "fixed 1 problem in part.robot.yaml"
    assert part.read_text().endswith("{visual: {sphere: 0.1}}}\n")


def test_a_fix_that_brings_an_error_is_not_applied(tmp_path: Path):
    """The other fixes are."""
    text = PENDULUM.replace("child: rod", "child: Base").replace("continuous", "Continuous")
    spec = write(tmp_path / "arm.robot.yaml", text)
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.returncode == 1
    first, second, *_ = run.stderr.splitlines()
    assert first == "fixed 1 problem in arm.robot.yaml"
    assert second.startswith("arm.robot.yaml:9:50: did not write 'base': it would bring the error 'joint 'hinge' joins")
    assert spec.read_text() == text.replace("Continuous", "continuous")


def test_a_file_outside_the_repository_of_the_spec_is_not_changed(tmp_path: Path):
    (tmp_path / "vendor").mkdir()
    text = "linkforge: 1\nname: part\nlinks: {base: {visual: {Sphere: 1}}}\n"
    part = write(tmp_path / "vendor/part.robot.yaml", text)
    (tmp_path / "own").mkdir()
    use = "modules: {a: {use: package://vendor/part.robot.yaml, parent: base}}\n"
    write(tmp_path / "own/arm.robot.yaml", f"linkforge: 1\nname: arm\nlinks: {{base: }}\n{use}")
    run = linkforge("check", "--fix", "--package", "vendor=../vendor", cwd=tmp_path / "own")
    assert "'Sphere' is not a key" in run.stderr
    assert "fixed" not in run.stderr
    assert part.read_text() == text


def test_a_file_that_is_read_only_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """As root may write every file, the system's answer is replaced."""
    text = PENDULUM.replace("continuous", "Continuous")
    spec = write(tmp_path / "arm.robot.yaml", text)
    monkeypatch.setattr("os.access", lambda *_: False)
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.returncode == 1
    assert run.stderr.splitlines()[0] == "did not change arm.robot.yaml: it is read-only"
    assert spec.read_text() == text


def test_a_link_to_a_spec_stays_a_link(tmp_path: Path):
    spec = write(tmp_path / "arm.robot.yaml", PENDULUM.replace("continuous", "Continuous"))
    (tmp_path / "link.robot.yaml").symlink_to(spec)
    linkforge("check", "--fix", "link.robot.yaml", cwd=tmp_path)
    assert (tmp_path / "link.robot.yaml").is_symlink()
    assert spec.read_text() == PENDULUM


def test_suppressed_codes_are_not_fixed(tmp_path: Path):
    text = PENDULUM.replace("joints:", "joints:   # linkforge: ignore LF6003")
    spec = write(tmp_path / "arm.robot.yaml", text)
    linkforge("check", "--fix", "--ignore", "LF1204", cwd=tmp_path)
    assert spec.read_text() == text


def test_standard_input_cannot_be_fixed(tmp_path: Path):
    run = linkforge("check", "--fix", "-", cwd=tmp_path, stdin=PENDULUM)
    assert run.returncode == 2
    assert "--fix takes files, not standard input" in run.stderr


@pytest.mark.parametrize("form", ["json", "sarif"])
def test_a_form_for_programs_has_what_remains(tmp_path: Path, form: str):
    write(tmp_path / "faulty.robot.yaml", FAULTY)
    run = linkforge("check", "--fix", "--format", form, cwd=tmp_path)
    assert run.returncode == 0
    assert "LF1020" not in run.stdout


def test_the_same_mistake_on_several_lines_is_fixed_everywhere(tmp_path: Path):
    """The parser stops at the first one."""
    joints = "".join(f"  {child}_joint:\n    type:fixed\n    parent: rod\n    child: {child}\n" for child in "ab")
    text = PENDULUM.replace("links:\n", "links:\n  a:\n  b:\n") + joints
    spec = write(tmp_path / "arm.robot.yaml", text)
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.stderr.splitlines()[0] == "fixed 2 problems in arm.robot.yaml"
    assert spec.read_text() == text.replace("type:fixed", "type: fixed")


def test_a_key_that_is_there_already_is_not_written_again(tmp_path: Path):
    limits = "limits: {lower: 0, min: 0, upper: 1, effort: 1, velocity: 1}"
    spec = write(tmp_path / "arm.robot.yaml", PENDULUM.replace("type: continuous", f"type: revolute, {limits}"))
    text = spec.read_text()
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert "'min' is not a key of a joint's limits; write 'lower'" in run.stderr
    assert spec.read_text() == text


def test_two_keys_for_one_are_not_both_renamed(tmp_path: Path):
    limits = "limits: {lower: 0, torque: 1, upper: 1, force: 1, velocity: 1}"
    spec = write(tmp_path / "arm.robot.yaml", PENDULUM.replace("type: continuous", f"type: revolute, {limits}"))
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.stderr.splitlines()[0] == "fixed 1 problem in arm.robot.yaml"
    assert spec.read_text().count("effort: 1") == 1


def test_values_of_another_format_are_written_as_ours(tmp_path: Path):
    joint = "hinge: {type: hinge, parent: {link: base}, child_link: rod, axis: '0 1 0', limits: "
    joint += "{min: -90 degrees, max: 90 DEG, effort: '5', speed: 2}}"
    spec = write(tmp_path / "arm.robot.yaml", PENDULUM.partition("  hinge:")[0] + f"  {joint}\n")
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.stderr.splitlines()[0] == "fixed 10 problems in arm.robot.yaml"
    assert spec.read_text().splitlines()[-1] == (
        "  hinge: {type: revolute, parent: base, child: rod, axis: [0, 1, 0], limits: "
        "{lower: -90 deg, upper: 90 deg, effort: 5, velocity: 2}}"
    )


@pytest.mark.parametrize(("default", "is_certain"), [("0.5", True), ("0.5 m", False)])
def test_a_type_of_number_is_not_certain_for_a_value_with_a_unit(tmp_path: Path, default: str, is_certain: bool):
    text = PENDULUM.replace("links:", f"parameters: {{reach: {{type: float, default: {default}}}}}\nlinks:", 1)
    fixes = [fix for one in compile_text(text).diagnostics for fix in one.fixes]
    assert [(fix.title, fix.is_safe) for fix in fixes] == [("write 'number'", is_certain)]


def test_a_color_of_urdf_is_written_as_ours(tmp_path: Path):
    """Its value is wrong only once its key is right."""
    paint = "materials: {red: {rgba: '1 0 0 1'}}\n"
    spec = write(tmp_path / "arm.robot.yaml", PENDULUM + paint)
    run = linkforge("check", "--fix", cwd=tmp_path)
    assert run.stderr.splitlines()[0] == "fixed 2 problems in arm.robot.yaml"
    assert spec.read_text() == PENDULUM + "materials: {red: {color: [1, 0, 0, 1]}}\n"


def test_the_difference_is_shown_and_nothing_is_written(tmp_path: Path):
    text = PENDULUM.replace("continuous", "Continuous")
    spec = write(tmp_path / "arm.robot.yaml", text)
    run = linkforge("check", "--fix", "--diff", cwd=tmp_path)
    assert run.stdout.splitlines()[:2] == ["--- arm.robot.yaml (as written)", "+++ arm.robot.yaml (fixed)"]
    changed = [line for line in run.stdout.splitlines()[2:] if line[0] in "+-"]
    hinge = "  hinge: {type: continuous, parent: base, child: rod, axis: y}"
    assert changed == [f"-{hinge.replace('continuous', 'Continuous')}", f"+{hinge}"]
    assert run.stderr.splitlines()[0] == "would fix 1 problem in arm.robot.yaml"
    assert spec.read_text() == text


@pytest.mark.parametrize("options", [("--diff",), ("--fix", "--diff", "--format", "json")])
def test_the_difference_is_that_of_fixes_as_text(tmp_path: Path, options: tuple[str, ...]):
    write(tmp_path / "arm.robot.yaml", PENDULUM)
    run = linkforge("check", *options, cwd=tmp_path)
    assert run.returncode == 2
    assert "--diff shows what --fix would change" in run.stderr
