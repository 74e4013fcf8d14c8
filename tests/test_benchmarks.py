"""The parts of the benchmarks work: what they run, the table, and the command line. What they measure is not tested."""

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.chain import make_chain, make_repeated_chain
from benchmarks.same_outputs import commands_for, digest, run_all
from benchmarks.table import Budget, Row, Side, average_rows, format_row, make_record
from benchmarks.worker import ACTIONS, run_process, run_turn
from linkforge_compile import compile_text, render_urdf
from tests.conftest import ROOT

XACRO = ROOT / "benchmarks" / "robots" / "arm" / "arm.urdf.xacro"


def compare(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "benchmarks" / "compare.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)


def test_a_row_has_the_ratios_of_medians_of_which_the_larger_counts_and_the_spread_of_the_rounds():
    row = Row("arm", "xacro", Side([0.2, 0.3, 0.9], [0.2] * 3), Side([0.1, 0.1, 0.3], [0.05] * 3), Budget(2.5, 1.5))
    cells = "arm 300 ms 200 ms 100 ms 50.0 ms xacro 3.00 (2.00-3.00) 4.00 2.5 missed, 1.5 missed"
    assert " ".join(format_row(row).split()) == cells
    assert format_row(row._replace(budget=Budget(4.0, 3.5))).endswith("4 reached, 3.5 missed")
    assert format_row(row._replace(budget=None)).endswith("4.00")


def test_a_row_of_memory_has_no_time():
    row = Row("10,000 links", "1,000 links", Side([250.0], []), Side([30.0], []), unit="MB")
    assert " ".join(format_row(row).split()) == "10,000 links 250 MB 30.0 MB 1,000 links 8.33 (8.33-8.33)"
    assert make_record(row)["processor_ratio"] is None


def test_a_mean_is_the_geometric_one_of_each_round():
    rows = [
        Row("a", "xacro", Side([1.0, 2.0], [1.0, 1.0]), Side([1.0, 1.0], [1.0, 1.0])),
        Row("b", "xacro", Side([4.0, 8.0], [1.0, 9.0]), Side([1.0, 4.0], [1.0, 1.0])),
    ]
    mean = average_rows(rows, "mean", Budget(3.0, 1.0))
    assert [*mean.ours, *mean.other] == [pytest.approx(one) for one in ([2, 4], [1, 3], [1, 2], [1, 1])]


def test_both_chains_are_the_same_robot():
    written, repeated = (render_urdf(compile_text(text(5)).result()) for text in (make_chain, make_repeated_chain))
    assert written == repeated
    assert written.count("<link ") == 5


@pytest.mark.parametrize("action", ACTIONS)
def test_each_action_runs_more_than_once(action: str, tmp_path: Path):
    spec, urdf = tmp_path / "chain.robot.yaml", tmp_path / "chain.urdf"
    spec.write_text(make_chain(3), "utf-8")
    urdf.write_text(render_urdf(compile_text(make_chain(3)).result()), "utf-8")
    swept = tmp_path / "swept.robot.yaml"
    link = "{visual: {sphere: 1}, inertial: {mass: $(n)}}"
    swept.write_text(f"linkforge: 1\nname: a\nparameters: {{n: 1}}\nlinks: {{a: {link}}}\n", "utf-8")
    arguments = {
        **dict.fromkeys(("sweep", "sweep-files-anew", "sweep-modules-anew"), (str(swept), "n=10:30", "2")),
        "xacro-loop": (str(XACRO), "safety_stiffness", "2"),
        "core-loop": (str(urdf), "2"),
        "xacro": (str(XACRO),),
        "rewrite-urdf": (str(urdf),),
        "merge": ("linkforge_compile.core", "2", "3"),
    }.get(action, (str(spec),))
    prepare = ACTIONS[action](*arguments)
    for _ in range(2):
        wall, _, _ = run_turn(prepare())
        assert wall > 0


@pytest.mark.skipif(sys.platform == "win32", reason="processes as POSIX has them")
def test_a_process_is_measured_and_a_failing_one_ends_the_benchmark():
    # From a small process: Linux counts the memory of the process that starts another as that one's, until it runs.
    measure = "import sys; from benchmarks.worker import run_process; print(*run_process(sys.argv[1:]))"
    command = [sys.executable, "-c", measure, sys.executable, "-c", "sum(range(10**6))"]
    measured = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True, timeout=60).stdout
    wall, processor, megabytes = map(float, measured.split())
    assert wall > 0.005
    assert processor > 0.005
    assert 1 < megabytes < 1000
    with pytest.raises(SystemExit, match="exit code 3"):
        run_process([sys.executable, "-c", "raise SystemExit(3)"])


def test_the_command_line_has_help_and_refuses_what_it_cannot_measure(tmp_path: Path):
    shown = compare("--help")
    assert (shown.returncode, "--only cold,warm" in shown.stdout) == (0, True)
    for arguments, message in (
        (("--only", "cold,hot"), "found 'hot'"),
        (("--rounds", "0"), "takes 1 or more"),
        (("--robots", tmp_path), f"no *.urdf.xacro in {tmp_path}"),
        (("--environment", sys.prefix, "--wheel", "any.whl"), "give --wheel with a new folder"),
    ):
        run = compare(*arguments)
        assert run.returncode
        assert message in run.stderr


def test_outputs_are_those_of_the_code_that_is_given(tmp_path: Path):
    cli = tmp_path / "linkforge_compile" / "cli"
    cli.mkdir(parents=True)
    for name in ("__init__.py", "cli/__init__.py"):
        (cli.parent / name).touch()
    main = "import os\ndef main(words):\n  print('a', flush=True)\n  os.write(2, b'b')\n  raise SystemExit(3)\n"
    (cli / "main.py").write_text(main, "utf-8")
    robot = ROOT / "examples" / "arm.robot.yaml"
    outputs = run_all([robot], tmp_path)
    assert set(outputs.values()) == {digest("exit 3\na\nb")}
    assert len(outputs) == len([*commands_for(str(robot), tmp_path)])
    (tmp_path / "linkforge_compile").rename(tmp_path / "elsewhere")
    with pytest.raises(SystemExit, match="linkforge ended"):
        run_all([robot], tmp_path)


def test_the_record_of_a_urdf_has_what_its_import_compiles_to(tmp_path: Path):
    robot = '<robot name="r"><link name="a"/></robot>'
    alone, planned = tmp_path / "alone.urdf", tmp_path / "planned.urdf"
    alone.write_text(robot, "utf-8")
    planned.write_text(robot, "utf-8")
    semantic = '<robot name="r"><group name="g"><link name="a"/></group></robot>'
    planned.with_suffix(".srdf").write_text(semantic, "utf-8")
    outputs = run_all([alone, planned], ROOT)
    files = {name.removeprefix(f"{tmp_path}/") for name in outputs if " -> " in name}
    written = {
        f"{name}.urdf -> {file}" for name in ("alone", "planned") for file in ("again.urdf", "imported.robot.yaml")
    }
    assert files == written | {"planned.urdf -> again.srdf"}


@pytest.mark.skipif(not Path(sys.prefix, "bin", "linkforge").exists(), reason="not installed in an environment")
def test_an_environment_that_exists_is_measured_as_it_is(tmp_path: Path):
    figures = tmp_path / "figures.json"
    run = compare("--environment", sys.prefix, "--only", "start", "--rounds", "1", "--json", figures)
    assert run.returncode == 0, run.stderr
    assert "linkforge --version" in run.stdout
    assert '"processor_ratio"' in figures.read_text("utf-8")
