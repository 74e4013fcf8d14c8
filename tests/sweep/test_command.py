"""`linkforge sweep`, in this process unless a test is about others."""

import json
import math
import os
import re
import shutil
import tarfile
import zipfile
from collections.abc import Mapping, Sequence
from errno import ENOSPC
from pathlib import Path

import pyarrow.parquet
import pytest

from linkforge_compile import compile_file, render_urdf
from linkforge_compile.sweep import SweepError, run
from linkforge_compile.sweep.bundle import changed_files
from linkforge_compile.sweep.place import Place
from linkforge_compile.sweep.plan import Plan
from linkforge_compile.sweep.session import Summary
from linkforge_compile.sweep.store import Chunk, Store
from linkforge_compile.sweep.work import Made
from tests.cli.in_process import linkforge
from tests.sweep.specs import ARM, write_arm


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_arm(tmp_path)
    return tmp_path


def sweep(folder: Path, *words: str, jobs: str = "1") -> tuple[int, str]:
    done = linkforge("sweep", "arm.robot.yaml", "-o", "out", "--jobs", jobs, *words, cwd=folder)
    return done.returncode, re.sub(r", \d+ a second$", "", done.stderr, flags=re.MULTILINE)  # on a slow machine


def rows(folder: Path) -> list[dict[str, object]]:
    return pyarrow.parquet.read_table(folder / "out/table.parquet").to_pylist()


def contents(folder: Path) -> dict[str, bytes]:
    return {str(one.relative_to(folder)): one.read_bytes() for one in folder.rglob("*") if one.is_file()}


def test_each_robot_is_what_compile_writes(folder: Path):
    assert sweep(folder, "--set", "reach=0.4m:1m:3", "--set", "tool=hand,hook") == (0, "6 robots in out\n")
    linkforge("compile", "arm.robot.yaml", "-o", "build/", "reach:=0.7 m", "tool:=hook", cwd=folder)
    assert contents(folder / "out/robots/000003") == contents(folder / "build")
    assert sorted(path.name for path in (folder / "out/robots").iterdir()) == [f"{i:06}" for i in range(6)]


def test_the_table_has_the_figures_of_each_robot(folder: Path):
    """The base of 3 kg is at the origin, as is the upper arm of 2 kg; two fingers of 0.1 kg are at half the reach."""
    sweep(folder, "--set", "reach=0.4m,1m")
    schema = pyarrow.parquet.read_schema(folder / "out/table.parquet")
    assert schema.field("reach").metadata == {b"unit": b"m"}
    assert schema.field("robot_ixx").metadata == {b"unit": b"kg*m^2"}
    first, second = rows(folder)
    assert (second["index"], second["reach"], second["robot_dof"], second["robot_links"]) == (1, 1.0, 1, 4)
    assert second["robot_mass"] == pytest.approx(5.2)
    assert second["robot_com_z"] == pytest.approx(0.2 * 0.5 / 5.2)
    assert second["robot_reach"] == pytest.approx(0.5)
    box, arm, ball = 3 * (2 * 0.1**2) / 12, 2 * (0.5**2 + 0.05**2) / 12, 0.2 * 2 / 5 * 0.02**2
    spread = 0.2 * 0.5**2 - 5.2 * (0.2 * 0.5 / 5.2) ** 2
    assert second["robot_ixx"] == pytest.approx(box + arm + ball + spread)
    assert second["robot_ixy"] == pytest.approx(0, abs=1e-12)
    assert (second["errors"], second["warnings"]) == (0, 0)
    assert second["digest"] != first["digest"]


def test_the_inertia_is_in_the_frame_of_the_root(folder: Path):
    """As Pinocchio computes it, of an arm whose parts are turned."""
    pinocchio = pytest.importorskip("pinocchio")
    (folder / "arm.robot.yaml").write_text(
        ARM.replace("sphere: 0.02", "box: [0.1, 0.2, 0.3]").replace("0.1 kg", "1 kg")
    )
    sweep(folder, "--set", "bend=30deg,70deg")
    row = rows(folder)[1]
    robot = compile_file(folder / "arm.robot.yaml", parameters={"bend": "70deg"}).result()
    model = pinocchio.buildModelFromXML(render_urdf(robot), pinocchio.JointModelFreeFlyer())
    data = model.createData()
    pinocchio.ccrba(model, data, pinocchio.neutral(model), pinocchio.utils.zero(model.nv))
    expected = data.Ig.inertia
    names = {"robot_ixx": (0, 0), "robot_iyy": (1, 1), "robot_izz": (2, 2), "robot_ixy": (0, 1), "robot_iyz": (1, 2)}
    for name, place in names.items():
        assert row[name] == pytest.approx(expected[place], abs=1e-12)
    assert row["robot_com_y"] == pytest.approx(pinocchio.centerOfMass(model, data, pinocchio.neutral(model))[1])


def test_values_are_lossless(folder: Path):
    sweep(folder, "--sample", "20", "--seed", "5")
    for row in rows(folder):
        urdf = (folder / f"out/robots/{row['index']:06}/arm.urdf").read_text()
        assert repr(row["reach"] / 2) in urdf


def test_the_same_command_writes_the_same_bytes(folder: Path):
    sweep(folder, "--sample", "20", "--seed", "5")
    first = contents(folder / "out")
    shutil.rmtree(folder / "out")
    sweep(folder, "--sample", "20", "--seed", "5")
    assert contents(folder / "out") == first


BROKEN = ARM.replace("variables:", "variables:\n  most: 1.6 m").replace("mass: 2 kg", "mass: $((most - reach) / most)")
"""The mass of the arm is negative from a reach of 1.6 m."""


def test_a_robot_with_errors_is_a_row_with_its_diagnostics(folder: Path):
    (folder / "arm.robot.yaml").write_text(BROKEN)
    code, text = sweep(folder, "--set", "reach=1m:2m:5")
    assert code == 1
    assert text.splitlines()[-1] == "5 robots in out, 2 with errors"
    assert text.splitlines()[0].startswith("error in 2 robots, such as 000003 (-p reach='1.75 m'): arm.robot.yaml:")
    table = rows(folder)
    assert [row["errors"] > 0 for row in table] == [False, False, False, True, True]
    assert table[4]["robot_mass"] is None
    assert json.loads(table[4]["diagnostics"])[0]["file"] == "arm.robot.yaml"
    assert not (folder / "out/robots/000004").exists()
    assert (folder / "out/robots/000002/arm.urdf").exists()


def test_messages_that_differ_for_each_robot_are_bounded(folder: Path, monkeypatch: pytest.MonkeyPatch):
    """Each of 25 robots has an error in a module of its own."""
    write_tools(folder)
    names = [f"tool_{index}" for index in range(25)]
    for name in names:
        (folder / f"{name}.robot.yaml").write_text(f"linkforge: 1\nname: {name}\nlinks: {{palm: {{mas: 1}}}}\n")
    words = ("--set", f"tool={','.join(names)}", "--quiet")
    for most, expected in ((1000, "and 5 other kinds"), (22, "and more than 2 other kinds")):
        monkeypatch.setattr("linkforge_compile.sweep.session.MAX_GROUPS", most)
        code, text = sweep(folder, *words)
        lines = text.splitlines()
        assert (code, len(lines)) == (1, 21)
        assert lines[20] == f"{expected} of messages; the column `diagnostics` of the table has all"
        shutil.rmtree(folder / "out")


@pytest.mark.parametrize("pack", ["tar", "zip"])
def test_robots_may_be_packed(folder: Path, pack: str):
    sweep(folder, "--set", "reach=0.4m:1m:5", "--pack", pack, "--chunk", "2")
    assert [one.name for one in sorted((folder / "out/robots").iterdir())] == [
        f"{name}.{pack}" for name in ("000000-000001", "000002-000003", "000004-000004")
    ]
    archive = folder / f"out/robots/000002-000003.{pack}"
    with tarfile.open(archive) if pack == "tar" else zipfile.ZipFile(archive) as opened:
        names = opened.getnames() if pack == "tar" else opened.namelist()
    assert names == ["000002/arm.urdf", "000002/arm.srdf", "000003/arm.urdf", "000003/arm.srdf"]


def test_the_table_alone(folder: Path):
    sweep(folder, "--set", "reach=0.4m:1m:5", "--table-only", "--format", "mjcf")
    assert sorted(one.name for one in (folder / "out").iterdir()) == ["sweep.json", "table.parquet"]
    assert all(row["digest"] for row in rows(folder))


def test_a_folder_with_a_sweep_is_refused_and_a_finished_one_is_done(folder: Path):
    sweep(folder, "--set", "reach=0.4m,1m")
    before = contents(folder / "out")
    code, text = sweep(folder, "--set", "reach=0.4m,1m")
    assert (code, text) == (
        2,
        "linkforge sweep: 'out' has a sweep; continue it with --resume, remove the folder, or choose another one\n",
    )
    assert sweep(folder, "--set", "reach=0.4m,1m", "--resume") == (0, "2 robots in out, 2 of them before\n")
    assert contents(folder / "out") == before


def test_a_folder_with_other_files_is_refused(folder: Path):
    (folder / "out").mkdir()
    (folder / "out/thesis.tex").write_text("")
    code, text = sweep(folder, "--set", "reach=0.4m,1m")
    assert (code, text) == (
        2,
        "linkforge sweep: 'out' has files that no sweep wrote; choose an empty or a new folder\n",
    )


def test_another_sweep_is_not_resumed(folder: Path):
    sweep(folder, "--set", "reach=0.4m,1m", "-p", "title=a")
    (folder / "arm.robot.yaml").write_text(f"{ARM}\n")
    code, text = sweep(folder, "--set", "reach=0.4m:1m:5", "-p", "title=a", "--where", "$(reach > 0)", "--resume")
    assert (code, text.splitlines()) == (
        2,
        [
            "linkforge sweep: 'out' has another sweep, so --resume cannot continue it:",
            "  'arm.robot.yaml' changed",
            "  --set: reach=0.4m,1m before, reach=0.4m:1m:5 now",
            "  --where: nothing before, $(reach > 0) now",
        ],
    )


def test_a_file_that_only_a_later_robot_reads_is_compared(folder: Path, monkeypatch: pytest.MonkeyPatch):
    """A parameter chooses the file of a module; the sweep is interrupted when both tools were compiled."""
    write_tools(folder)
    words = ("--set", "tool=hand,hook,hand", "--chunk", "1")
    interrupt_after(2, monkeypatch)
    assert sweep(folder, *words)[0] == 130
    monkeypatch.undo()
    assert list(json.loads((folder / "out/sweep.json").read_text())["files"]) == [
        f"{name}.robot.yaml" for name in ("arm", "hand", "hook")
    ]
    text = (folder / "hook.robot.yaml").read_text()
    (folder / "hook.robot.yaml").write_text(text.replace("mass: 2", "mass: 3"))
    code, message = sweep(folder, *words, "--resume")
    assert (code, message.splitlines()[1:]) == (2, ["  'hook.robot.yaml' changed"])
    (folder / "hook.robot.yaml").write_text(text)
    assert sweep(folder, *words, "--resume") == (0, "3 robots in out, 2 of them before\n")


def interrupt_after(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Ctrl-C come when so many chunks are written."""
    add, added = Store.add, []

    def interrupted(self: Store, chunk, made) -> None:
        if len(added) == count:
            raise KeyboardInterrupt
        added.append(chunk)
        add(self, chunk, made)

    monkeypatch.setattr(Store, "add", interrupted)


def test_an_interrupted_sweep_goes_on(folder: Path, monkeypatch: pytest.MonkeyPatch):
    words = ("--sample", "12", "--seed", "2", "--chunk", "3")
    sweep(folder, *words)
    whole = contents(folder / "out")
    shutil.rmtree(folder / "out")
    interrupt_after(2, monkeypatch)
    code, text = sweep(folder, *words)
    assert (code, text) == (
        130,
        "linkforge sweep: interrupted; the same command with --resume continues in 'out'\n",
    )
    assert not (folder / "out/table.parquet").exists()
    monkeypatch.undo()
    assert sweep(folder, *words, "--resume") == (0, "12 robots in out, 6 of them before\n")
    assert contents(folder / "out") == whole


def test_a_file_that_changes_and_is_restored_leaves_no_robots_of_two_texts(folder: Path):
    """The spec is edited while the sweep runs, and restored before it goes on."""
    spec, edits = folder / "arm.robot.yaml", [ARM.replace("mass: 3 kg", "mass: 9 kg")]

    def edit(_robot: object, values: Mapping[str, object]) -> None:
        if values["reach"] == 1.0 and edits:
            spec.write_text(edits.pop())

    grid = {"reach": [0.5, 1.0, 1.5]}
    with pytest.raises(SweepError, match="changed while the sweep ran; restore it"):
        run(spec, grid, edit, output=folder / "out")
    spec.write_text(ARM)
    assert sorted(path.name for path in (folder / "out/robots").iterdir()) == ["000000"]
    resumed = run(spec, grid, edit, output=folder / "out", resume=True)
    assert resumed["robot_mass"].to_pylist() == pytest.approx([5.2, 5.2, 5.2])


def test_a_table_of_values_that_changes_meanwhile_is_not_resumed(folder: Path, monkeypatch: pytest.MonkeyPatch):
    """The manifest is written again when the second robot reads another file."""
    write_tools(folder)
    table = folder / "points.csv"
    table.write_text("tool\nhand\nhook\nhook\n")
    add = Store.add

    def edit(self: Store, chunk: Chunk, made: Sequence[Made]) -> None:
        if chunk.begin == 2:
            raise KeyboardInterrupt
        add(self, chunk, made)
        table.write_text("tool\nhook\nhand\nhand\n")

    monkeypatch.setattr(Store, "add", edit)
    words = ("--values", "points.csv", "--chunk", "1")
    assert sweep(folder, *words)[0] == 130
    monkeypatch.undo()
    assert sweep(folder, *words, "--resume")[1].splitlines()[1:] == ["  --values: the table changed"]


def test_two_sweeps_do_not_write_to_one_folder(folder: Path):
    """The second begins while the first compiles its first robot."""
    spec, output = folder / "arm.robot.yaml", folder / "out"

    def begin_another(_robot: object, _values: object) -> None:
        run(spec, {"reach": [1.5]}, output=output)

    with pytest.raises(SweepError, match=r"or another sweep writes to it now; choose another folder"):
        run(spec, {"reach": [0.5, 1.0]}, begin_another, output=output)
    assert pyarrow.parquet.read_table(output / "table.parquet")["reach"].to_pylist() == [1.5]


def test_another_function_is_not_resumed(folder: Path):
    spec, grid, output = folder / "arm.robot.yaml", {"reach": [0.5, 1.0]}, folder / "out"

    def score(_robot: object, _values: object) -> float:
        return 1.0

    run(spec, grid, score, output=output)
    assert run(spec, grid, score, output=output, resume=True)["result"].to_pylist() == [1.0, 1.0]

    def score(_robot: object, _values: object) -> float:
        return 2.0

    with pytest.raises(SweepError, match=r"\n  function: it changed$"):
        run(spec, grid, score, output=output, resume=True)


def test_an_error_of_a_function_stands_beside_the_warnings(folder: Path):
    spec = folder / "arm.robot.yaml"
    spec.write_text(ARM.replace("{mass: 3 kg}", "{mass: 3 kg, inertia: {ixx: 900, iyy: 900, izz: 900}}"))
    without = run(spec, {"reach": [0.5]}).to_pylist()[0]
    assert without["warnings"] > 0
    failed = run(spec, {"reach": [0.5]}, lambda _robot, values: values["no"]).to_pylist()[0]
    assert (failed["errors"], failed["warnings"]) == (1, without["warnings"])
    *warnings, error = json.loads(failed["diagnostics"])
    assert warnings == json.loads(without["diagnostics"])
    assert re.fullmatch(r"the function raised KeyError in line \d+, in <lambda>: 'no'", error["message"])


def test_what_is_no_function_is_an_error(folder: Path):
    with pytest.raises(SweepError, match="function takes a function of a robot and its values, found 5"):
        run(folder / "arm.robot.yaml", {"reach": [0.5]}, 5)  # type: ignore[arg-type]
    failed = run(folder / "arm.robot.yaml", {"reach": [0.5]}, lambda: 1)  # type: ignore[arg-type,misc]
    assert "the function raised TypeError: " in failed["diagnostics"][0].as_py()


@pytest.mark.parametrize("chunk", [1, 4])
def test_a_column_of_several_kinds_has_strings(folder: Path, chunk: int):
    """Both where the kinds meet in one part of the table and where each part has one kind."""
    kinds = {0.4: 1, 0.5: "far", 0.6: True, 0.7: None}
    table = run(
        folder / "arm.robot.yaml", {"reach": list(kinds)}, lambda _, values: kinds[values["reach"]], chunk=chunk
    )
    assert table["result"].to_pylist() == ["1", "far", "true", None]


def test_an_integer_that_no_column_holds_is_an_error_of_its_robot(folder: Path):
    table = run(folder / "arm.robot.yaml", {"reach": [0.5, 1]}, lambda _, values: 2 ** int(70 * values["reach"]))
    assert table["result"].to_pylist() == [2**35, None]
    assert "column 'result' takes integers of 64 bits, found 1180591620717411303424" in table["diagnostics"][1].as_py()


def test_python_packs_and_takes_pairs_as_a_grid(folder: Path):
    run(folder / "arm.robot.yaml", [("reach", [0.5, 1])], output=folder / "out", pack="tar", chunk=2)
    assert [one.name for one in (folder / "out/robots").iterdir()] == ["000000-000001.tar"]


def test_one_misspelt_variant_is_refused_before_anything_is_compiled(folder: Path):
    code, told = sweep(folder, "--set", "reach=0.4m:1m:2", "--variant", "simm")
    assert (code, told) == (2, "linkforge sweep: there is no variant 'simm'; did you mean 'sim'?\n")
    assert not (folder / "out").exists()


@pytest.mark.parametrize(
    ("words", "difference"),
    [
        (("--package", "tools=."), "--package: nothing before, tools=. now"),
        (("--allow-outside",), "--allow-outside: False before, True now"),
    ],
)
def test_what_files_can_be_read_is_compared(folder: Path, words: tuple[str, ...], difference: str):
    sweep(folder, "--set", "reach=0.4m,1m")
    assert sweep(folder, "--set", "reach=0.4m,1m", *words, "--resume")[1].splitlines()[1:] == [f"  {difference}"]


def test_variants_are_selected_in_one_way(folder: Path):
    """Both would make each robot of the column once for each --variant."""
    (folder / "points.csv").write_text("variant\nsim\nreal\n")
    message = "--variant and a column of 'points.csv' both select variants; leave one of them out"
    for names in (("sim",), ("sim", "real")):
        words = [word for name in names for word in ("--variant", name)]
        assert sweep(folder, "--values", "points.csv", *words) == (2, f"linkforge sweep: {message}\n")


def test_a_sweep_that_ended_before_its_first_robot_is_in_nobodys_way(folder: Path):
    """Such as one whose scheduler was not there."""
    whole = ("--set", "reach=0.4m:1m:2")
    sweep(folder, *whole)
    for path in (folder / "out/robots", folder / "out/table.parquet"):
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    (folder / "out/.parts").mkdir()
    assert sweep(folder, "--set", "reach=0.4m:1m:3") == (0, "3 robots in out\n")


def write_tools(folder: Path) -> None:
    """Write an arm whose parameter chooses the file of a module, a hand or a hook."""
    for name, mass in (("hand", 1), ("hook", 2)):
        text = (
            f"linkforge: 1\nname: {name}\nlinks: {{palm: {{visual: {{sphere: 0.1}}, inertial: {{mass: {mass} kg}}}}}}\n"
        )
        (folder / f"{name}.robot.yaml").write_text(text)
    (folder / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nparameters: {tool: hand}\nlinks: {base: {}}\n"
        "modules: {tool: {use: $(tool).robot.yaml, parent: base}}\n"
    )


def test_modules_by_value(folder: Path):
    write_tools(folder)
    assert sweep(folder, "--set", "tool=hand,hook,hok")[0] == 1
    assert [row["robot_mass"] for row in rows(folder)] == [1, 2, None]


def test_a_xacro_is_swept_by_its_arguments(folder: Path):
    pytest.importorskip("xacro")
    (folder / "arm.urdf.xacro").write_text(
        '<robot xmlns:xacro="http://ros.org/wiki/xacro" name="x"><xacro:arg name="mass" default="1"/>'
        '<link name="base"><inertial><mass value="$(arg mass)"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" '
        'iyz="0"/></inertial></link></robot>'
    )
    done = linkforge("sweep", "arm.urdf.xacro", "--set", "mass=1:3:3", "-o", "out", "--jobs", "1", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert [(row["mass"], row["robot_mass"]) for row in rows(folder)] == [(1, 1), (2, 2), (3, 3)]


def test_diagnostics_count_robots_by_message(folder: Path):
    """A warning of every robot is one line."""
    (folder / "arm.robot.yaml").write_text(
        ARM.replace("sphere: 0.02", "mesh: hand.stl").replace(
            "{mass: 0.1 kg}", "{mass: 0.1 kg, inertia: {ixx: 1e-3, iyy: 1e-3, izz: 1e-3}}"
        )
    )
    code, text = sweep(folder, "--set", "reach=1m:2m:5")
    assert code == 0
    assert any(line.startswith("warning in 5 robots, such as 000000") for line in text.splitlines())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--seed", "3", "--set", "reach=1,2"], "--seed is for --sample; add --sample N, or leave it out"),
        (["--sample", "0"], "argument --sample: takes a whole number from 1, found '0'"),
        (["--sample", "9", "--seed", "1.5"], "argument --seed: takes a whole number, found '1.5'"),
        (["--values", "-"], "--values takes a file, not standard input or a pipe: it is read several times"),
        (["--set", "reach=1,2", "--format", "urd"], "--format: there is no format 'urd'; did you mean 'urdf'?"),
        (
            ["--set", "reach=1,2", "--variant", "sim", "--variant", "rel"],
            "there is no variant 'rel'; did you mean 'real'?",
        ),
        (["--sample", "9", "--values", "x.csv"], "--sample draws values and --values lists them; use one of them"),
        (["--values", "x.csv"], "--values x.csv: No such file or directory"),
        (
            ["--set", "reach=1,2", "--tls-ca", "x"],
            "--tls-ca, --tls-cert and --tls-key are for --scheduler; leave them out",
        ),
    ],
)
def test_a_wrong_command_is_refused(folder: Path, words: list[str], message: str):
    code, text = sweep(folder, *words)
    assert code == 2
    assert message in text
    assert not (folder / "out").exists()


def test_numbers_of_the_table_are_finite_or_missing(folder: Path):
    sweep(folder, "--set", "reach=0.4m,1m")
    assert all(math.isfinite(value) for row in rows(folder) for value in row.values() if isinstance(value, float))


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("file", "'file' is a file; choose a folder for the robots and the table"),
        ("file/out", "cannot write to 'file/out': Not a directory; choose another folder"),
        ("-", "-o takes a folder, not standard output; write ./- for a folder of that name"),
        ("", "-o takes a folder, found '': is a variable of the shell empty?"),
    ],
)
def test_a_folder_that_cannot_be_written_is_an_error(folder: Path, output: str, message: str):
    (folder / "file").write_text("")
    done = linkforge("sweep", "arm.robot.yaml", "-o", output, "--jobs", "1", "--set", "reach=1,2", cwd=folder)
    assert (done.returncode, done.stderr) == (2, f"linkforge sweep: {message}\n")


def test_a_file_is_read_again_only_if_its_time_or_size_changed(folder: Path, monkeypatch: pytest.MonkeyPatch):
    """A touched file has no other text, and an edit of the same length is found."""
    spec, output, read = folder / "arm.robot.yaml", folder / "out", []
    edits = {0.6: ARM, 0.8: ARM.replace("mass: 3 kg", "mass: 9 kg")}

    def edit(_robot: object, values: Mapping[str, object]) -> None:
        if text := edits.get(values["reach"]):
            spec.write_text(text)

    def counted(files: Mapping[str, str]) -> list[str]:
        read.append(len(files))
        return changed_files(files)

    monkeypatch.setattr("linkforge_compile.sweep.session.changed_files", counted)
    with pytest.raises(SweepError, match="changed while the sweep ran"):
        run(spec, {"reach": [0.4, 0.5, 0.6, 0.7, 0.8, 0.9]}, edit, output=output)
    assert read == [1, 0, 1, 0, 1]
    assert [path.name for path in sorted((output / "robots").iterdir())] == [f"{index:06}" for index in range(4)]


def test_a_file_that_changes_without_a_folder_for_robots(folder: Path):
    """Nothing is kept, so nothing can be resumed."""
    spec = folder / "arm.robot.yaml"

    def edit(_robot: object, _values: object) -> None:
        spec.write_text(ARM.replace("mass: 3 kg", "mass: 9 kg"))

    with pytest.raises(SweepError, match="changed while the sweep ran; start again; with output=FOLDER"):
        run(spec, {"reach": [0.5, 1.0]}, edit)


def test_a_full_disk_is_an_error(folder: Path, monkeypatch: pytest.MonkeyPatch):
    def full(self: Store, chunk: Chunk, made: object) -> None:
        raise OSError(ENOSPC, os.strerror(ENOSPC))

    monkeypatch.setattr(Store, "add", full)
    message = "cannot write to 'out': No space left on device; once it can be written, --resume continues"
    assert sweep(folder, "--set", "reach=1,2") == (2, f"linkforge sweep: {message}\n")


@pytest.mark.parametrize(("robots", "jobs"), [(99, 1), (100, 7)])
def test_few_robots_need_no_other_process(folder: Path, monkeypatch: pytest.MonkeyPatch, robots: int, jobs: int):
    places = []

    def execute(plan: Plan, store: Store, place: Place, packing: str, **_more: object) -> Summary:
        places.append(place)
        return Summary(plan.size)

    monkeypatch.setattr("linkforge_compile.sweep.session.execute", execute)
    monkeypatch.setattr("dask.system.cpu_count", lambda: 7)
    linkforge("sweep", "arm.robot.yaml", "-o", "out", "--sample", str(robots), cwd=folder)
    assert places == [Place(jobs)]


def test_the_table_of_a_sweep_is_a_table_of_values(folder: Path):
    """Its figures and diagnostics vary nothing."""
    sweep(folder, "--sample", "5", "--seed", "5", "--variant", "sim", "--variant", "real", "--pack", "tar")
    first = rows(folder)
    shutil.move(folder / "out/table.parquet", folder / "points.parquet")
    shutil.rmtree(folder / "out")
    assert sweep(folder, "--values", "points.parquet")[0] == 0
    assert rows(folder) == first


def test_a_long_sweep_shows_its_progress(folder: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("linkforge_compile.cli.progress_bar.PROGRESS_INTERVAL", 0.0)
    monkeypatch.setattr("linkforge_compile.cli.progress_bar.STEADY", 0.0)
    (folder / "arm.robot.yaml").write_text(BROKEN)
    _, text = sweep(folder, "--set", "reach=1m:2m:6", "--where", "$(reach > 1.1)")
    assert "\n6 of 6 points, 0 s left\n" in text
    assert "\n0 of 5 robots\n" in text
    assert re.search(r"^3 of 5 robots, \d+ s left, 1 with errors$", text, re.MULTILINE)
    assert text.splitlines()[-1] == "5 robots in out (1 of 6 points left out by --where), 3 with errors"
