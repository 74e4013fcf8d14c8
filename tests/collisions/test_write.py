"""`--write` changes the pairs of a spec and nothing else of it; `--check` reports whether it would."""

from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.conftest import ROOT

pytest.importorskip("pinocchio")

ROBOT = """\
# An arm.
linkforge: 1
name: robot      # and its name

links:
  base: {collision: {sphere: 0.1}}
  arm: {collision: {sphere: 0.1}}
  left: {collision: {sphere: 0.1}}
  right: {collision: {sphere: 0.1}}
  tool0:
joints:
  shoulder: {type: continuous, parent: base, child: arm, axis: z, origin: [0, 0, 1]}   # turns
  one: {type: fixed, parent: arm, child: left, origin: [0, 1, 0]}
  two: {type: fixed, parent: arm, child: right, origin: [0, -1, 0]}
  three: {type: fixed, parent: arm, child: tool0}
"""

WANTED = """\
    base: {arm: Adjacent, left: Never, right: Never}
    arm: {left: Adjacent, right: Adjacent}
    left: {right: Never}
"""


def write(spec: str, folder: Path, *options: str, newline: str = "\n", name: str = "robot.robot.yaml") -> str:
    """Return what `--write` makes of a spec; a second run changes nothing."""
    path = folder / name
    path.write_bytes(spec.replace("\n", newline).encode())
    done = linkforge("collisions", name, "--write", "--samples", "300", *options, cwd=folder)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    written = path.read_bytes()
    again = linkforge("collisions", name, "--write", "--samples", "300", *options, cwd=folder)
    assert again.stderr.endswith("the pairs are up to date\n")
    assert path.read_bytes() == written
    assert linkforge("collisions", name, "--check", "--samples", "300", *options, cwd=folder).returncode == 0
    return written.decode().replace(newline, "\n")


def semantic(pairs: str) -> str:
    return f"{ROBOT}semantic:\n  passive_joints: [shoulder]  # no motor\n  disabled_collisions:\n{pairs}"


@pytest.mark.parametrize("end", ["", "materials: {}  # the end\n", "# the end"])
def test_a_spec_without_semantic_gets_it_at_its_end(end: str, tmp_path: Path):
    line = "" if end.endswith("\n") or not end else "\n"
    expected = f"{ROBOT}{end}{line}\nsemantic:\n  disabled_collisions:\n{WANTED}"
    assert write(ROBOT + end, tmp_path) == expected


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("end", ["", "\nmaterials: {}  # the end\n"])
def test_semantic_gets_the_section_below_its_last_line(newline: str, mark: str, end: str, tmp_path: Path):
    start = f"{mark}{ROBOT}semantic:\n  groups:\n    arm:\n      joints: [shoulder]   # all\n"
    assert write(start + end, tmp_path, newline=newline) == f"{start}  disabled_collisions:\n{WANTED}{end}"


def test_new_entries_take_the_place_of_the_last_one(tmp_path: Path):
    assert write(semantic("    tool0: {left: Never}\n"), tmp_path) == semantic(WANTED)


@pytest.mark.parametrize(
    "written", ["semantic:", "semantic: null  # later", "semantic:\n  disabled_collisions:  # all"]
)
def test_a_section_without_a_value_gets_one(written: str, tmp_path: Path):
    line = "" if "disabled" in written else "  disabled_collisions:\n"
    made = write(f"{ROBOT}{written}\nmaterials: {{}}\n", tmp_path)
    assert made == f"{ROBOT}{written.replace(' null', '')}\n{line}{WANTED}materials: {{}}\n"


def test_only_entries_that_change_are_written_anew(tmp_path: Path):
    pairs = """\
    # Of the base.
    base: {arm: Adjacent,    left: Never}   # right is missing

    # Of the arm.
    arm:
      left: Adjacent     # by 'one'
      right:   Adjacent
    right:
      # Far away.
      left: Default      # no
"""
    assert write(semantic(pairs), tmp_path) == semantic("""\
    # Of the base.
    base: {arm: Adjacent, left: Never, right: Never}   # right is missing

    # Of the arm.
    arm:
      left: Adjacent     # by 'one'
      right:   Adjacent
    # Far away.
    right: {left: Never}      # no
""")


def test_pairs_of_people_stay_and_others_go(tmp_path: Path):
    pairs = """\
    arm:
      right: Adjacent
      tool0: User          # touches by design
      left: Never
    tool0: {left: Never}   # has no collisions any more
    left: {base: }
    right: {left: Never, base: Never}
    base: {arm: Adjacent}
"""
    assert write(semantic(pairs), tmp_path) == semantic("""\
    # touches by design
    arm: {right: Adjacent, tool0: User, left: Adjacent}
    # has no collisions any more
    left: {base: }
    right: {left: Never, base: Never}
    base: {arm: Adjacent}
""")


def test_expressions_stay_where_their_pairs_are_right(tmp_path: Path):
    pairs = """\
    base:
      arm: Adjacent
      $(side): {for: {side: [left, right]}, value: Never}
    arm:
      $(side): {for: {side: [left, right]}, value: Adjacent}
    left: {right: {when: false, value: Always}}
"""
    assert write(semantic(pairs), tmp_path) == semantic(pairs + "    right: {left: Never}\n")


def test_an_entry_that_changes_is_written_without_expressions(tmp_path: Path):
    pairs = "    $(side): {for: {side: [left, right]}, value: {base: Never, arm: Never}}\n"
    assert write(semantic(pairs), tmp_path) == semantic("""\
    left: {base: Never, arm: Adjacent, right: Never}
    right: {base: Never, arm: Adjacent}
    base: {arm: Adjacent}
""")


def test_all_pairs_may_go(tmp_path: Path):
    robot = ROBOT[: ROBOT.index("  arm: ")] + "  arm:\njoints:\n  one: {type: fixed, parent: base, child: arm}\n"
    section = "semantic:\n  disabled_collisions:\n    base: {arm: Adjacent}\n"
    assert write(robot + section + "materials: {}\n", tmp_path) == (
        f"{robot}semantic:\n  disabled_collisions:\nmaterials: {{}}\n"
    )


def test_pairs_of_an_included_file_are_written_there(tmp_path: Path):
    part = "linkforge: 1\n# Pairs.\nsemantic:\n  disabled_collisions:\n    base: {arm: Adjacent}\n"
    (tmp_path / "pairs.yaml").write_text(part, "utf-8")
    spec = f"{ROBOT}include: [pairs.yaml]\n"
    (tmp_path / "robot.robot.yaml").write_text(spec, "utf-8")
    done = linkforge("collisions", "robot.robot.yaml", "--write", cwd=tmp_path)
    assert done.stderr.endswith("wrote pairs.yaml\n")
    assert (tmp_path / "robot.robot.yaml").read_text("utf-8") == spec
    assert (tmp_path / "pairs.yaml").read_text("utf-8") == part.replace("    base: {arm: Adjacent}\n", WANTED)


@pytest.mark.parametrize("name", ["robot.robot.yaml", "pairs.yaml"])
def test_a_file_that_would_not_declare_the_pairs_stays(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    section = "semantic:\n  disabled_collisions:\n    base: {arm: Adjacent}\n"
    spec, part = (ROBOT, f"linkforge: 1\n{section}") if name == "pairs.yaml" else (ROBOT + section, "linkforge: 1\n")
    (tmp_path / "pairs.yaml").write_text(part, "utf-8")
    (tmp_path / "robot.robot.yaml").write_text(f"{spec}include: [pairs.yaml]\n", "utf-8")
    before = (tmp_path / name).read_text("utf-8")
    monkeypatch.setattr("linkforge_compile.collisions.rewrite.rewrite", lambda *_: before + "# Nothing else.\n")
    done = linkforge("collisions", "robot.robot.yaml", "--write", cwd=tmp_path)
    assert (done.returncode, (tmp_path / name).read_text("utf-8")) == (2, before)
    assert "the section cannot be changed here" in done.stderr


@pytest.mark.parametrize(
    ("section", "reason"),
    [
        ("semantic: {passive_joints: [shoulder]}", "'semantic' is not written below its key, line by line"),
        (
            "semantic:\n  disabled_collisions: {base: {arm: Adjacent}}",
            "'disabled_collisions' is not written below its key, line by line",
        ),
        (
            "variables: {pairs: {base: {arm: Adjacent}}}\nsemantic:\n  disabled_collisions: $(pairs)",
            "'disabled_collisions' is not written below its key, line by line",
        ),
        (
            "semantic:\n  enabled_collisions: &same\n    base: {arm: Adjacent}\n  disabled_collisions: *same",
            "'disabled_collisions' is not written below its key, line by line",
        ),
    ],
)
def test_a_form_that_only_a_person_can_change_is_refused(section: str, reason: str, tmp_path: Path):
    path = tmp_path / "robot.robot.yaml"
    path.write_text(f"{ROBOT}{section}\n", "utf-8")
    done = linkforge("collisions", path.name, "--write", cwd=tmp_path)
    assert (done.returncode, path.read_text("utf-8")) == (2, f"{ROBOT}{section}\n")
    assert f"--write: {reason}; change it by hand" in done.stderr


def test_standard_input_and_urdf_are_not_written(tmp_path: Path):
    done = linkforge("collisions", "-", "--write", cwd=tmp_path, stdin=ROBOT)
    assert done.returncode == 2
    assert "'<stdin>' is not a spec in YAML" in done.stderr
    linkforge("compile", "-", "-o", "robot.urdf", cwd=tmp_path, stdin=ROBOT)
    done = linkforge("collisions", "robot.urdf", "--write", cwd=tmp_path)
    assert done.returncode == 2
    assert "'robot.urdf' is not a spec in YAML; write one that uses it" in done.stderr


def test_check_lists_what_is_out_of_date(tmp_path: Path):
    path = tmp_path / "robot.robot.yaml"
    path.write_text(semantic("    base: {arm: Adjacent, left: Default, tool0: Always}\n"), "utf-8")
    before = path.read_bytes()
    done = linkforge("collisions", path.name, "--check", "--quiet", cwd=tmp_path)
    assert (done.returncode, done.stdout, path.read_bytes()) == (1, "", before)
    assert done.stderr.splitlines() == [
        "- base left Default",
        "- base tool0 Always",
        "+ base left Never",
        "+ base right Never",
        "+ arm left Adjacent",
        "+ arm right Adjacent",
        "+ left right Never",
        "the pairs are out of date; run 'linkforge collisions robot.robot.yaml --write'",
    ]


@pytest.mark.parametrize("example", ["07_quadruped/quadruped", "08_hand/hand", "06_rover/rover", "07_quadruped/leg"])
def test_the_examples_keep_all_other_lines(example: str, tmp_path: Path):
    source = ROOT / "examples" / f"{example}.robot.yaml"
    for file in source.parent.glob("*.yaml"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    before = source.read_text("utf-8")
    after = write(before, tmp_path, name=source.name).splitlines()
    start = before.splitlines().index("  disabled_collisions:")
    assert after[: start + 1] == before.splitlines()[: start + 1]
    for comment in (line.partition("#")[2] for line in before.splitlines() if "#" in line):
        assert any(comment in line for line in after)
