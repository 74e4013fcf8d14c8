"""`linkforge watch`: it compiles again after each change, and reports what went wrong."""

import argparse
import gc
import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from linkforge_compile import Compilation
from linkforge_compile.cli.build import BuildRequest
from linkforge_compile.cli.commands import watch as watch_command
from linkforge_compile.cli.main import main
from linkforge_compile.syntax import YamlMap
from tests.cli.watching import Deed, nothing, removes, run_with, sets
from tests.programs import interruptible

CELL = "linkforge: 1\nname: cell\nlinks: {base: }\nmodules: {arm: {use: arm.robot.yaml, parent: base}}\n"
ARM = "linkforge: 1\nname: arm\nlinks: {hand: }\n"


@pytest.fixture
def cell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    return tmp_path


@pytest.fixture
def watch(cell: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Callable[..., list[str]]:
    def run(*deeds: Deed, words: tuple[str, ...] = ()) -> list[str]:
        return run_with(deeds, ("watch", "cell.robot.yaml", "-o", "out/", *words), cell, monkeypatch, capfd)

    return run


WATCHING = "watching cell.robot.yaml and 1 more; Ctrl-C ends"


def test_a_change_of_a_module_compiles_again(cell: Path, watch: Callable[..., list[str]]):
    output = watch(nothing, sets("arm.robot.yaml", ARM.replace("hand", "gripper")), nothing)
    assert output == [
        "wrote out/cell.urdf",
        WATCHING,
        "arm.robot.yaml changed",
        "wrote out/cell.urdf",
        WATCHING,
    ]
    assert '<link name="arm_gripper"/>' in (cell / "out" / "cell.urdf").read_text()


def test_errors_are_reported_and_the_output_stays_until_they_are_fixed(cell: Path, watch: Callable[..., list[str]]):
    def is_still_there(folder: Path) -> None:
        assert '<link name="arm_hand"/>' in (folder / "out" / "cell.urdf").read_text()

    wrong = ARM.replace("hand: ", "hand: {colision: visual}")
    output = watch(sets("arm.robot.yaml", wrong), is_still_there, sets("arm.robot.yaml", ARM))
    assert "arm.robot.yaml:3:16: error: 'colision' is not a key of a link; did you mean 'collision'? [LF2101]" in output
    assert output[-2:] == ["out/cell.urdf is up to date", WATCHING]


def test_nothing_of_former_compiles_is_kept(watch: Callable[..., list[str]]):
    def count(_folder: Path) -> None:
        counts.append(sum(isinstance(one, YamlMap) for one in gc.get_objects()))

    counts: list[int] = []
    edits = [sets("arm.robot.yaml", ARM.replace("hand", f"hand{number}")) for number in range(3)]
    gc.disable()  # as if no threshold were reached
    try:
        watch(edits[0], count, edits[1], edits[2], count)
    finally:
        gc.enable()
    assert counts[1] == counts[0]


def test_a_file_that_is_missed_is_waited_for(watch: Callable[..., list[str]]):
    output = watch(removes("arm.robot.yaml"), nothing, sets("arm.robot.yaml", ARM))
    assert any("there is no file 'arm.robot.yaml'" in line for line in output)
    assert output.count("arm.robot.yaml changed") == 2
    assert output[-2:] == ["out/cell.urdf is up to date", WATCHING]


def test_several_deleted_outputs_are_reported_together(cell: Path, watch: Callable[..., list[str]]):
    def removes_both(folder: Path) -> None:
        for path in (folder / "out").iterdir():
            path.unlink()

    semantic = f"{CELL}semantic: {{groups: {{all: {{links: [base]}}}}}}\n"
    output = watch(sets("cell.robot.yaml", semantic), removes_both, nothing)
    assert "out/cell.urdf and 1 more are gone" in output


def test_a_file_that_is_used_no_more_is_watched_no_more(watch: Callable[..., list[str]]):
    alone = CELL.partition("modules")[0]
    output = watch(sets("cell.robot.yaml", alone), sets("arm.robot.yaml", "x"), nothing)
    assert output[-3:] == ["cell.robot.yaml changed", "wrote out/cell.urdf", "watching cell.robot.yaml; Ctrl-C ends"]


def by_templates(folder: Path) -> None:
    folder.mkdir()
    (folder / "a.md.j2").write_text("{% include '_b.j2' ignore missing %}\n")


def test_templates_are_watched_and_what_they_miss(cell: Path, watch: Callable[..., list[str]]):
    by_templates(cell / "t")
    deeds = (
        nothing,
        sets("t/a.md.j2", "{% include '_b.j2' ignore missing %}.\n"),
        nothing,
        sets("t/_b.j2", "b"),
        nothing,
    )
    output = watch(*deeds, nothing, sets("t/_b.j2", "changed"), words=("--template", "t"))
    assert [line for line in output if not line.startswith("watching")] == [
        "wrote out/a.md",
        "t/a.md.j2 changed",
        "wrote out/a.md",
        "t/_b.j2 and 1 more changed",
        "wrote out/a.md",
        "t/_b.j2 changed",
        "wrote out/a.md",
    ]
    assert (cell / "out" / "a.md").read_text() == "changed.\n"


def test_a_template_that_is_new_is_rendered_and_a_fault_in_it_waited_for(cell: Path, watch: Callable[..., list[str]]):
    by_templates(cell / "t")
    output = watch(
        sets("t/b.md.j2", "{{ nosuch }}"), nothing, sets("t/b.md.j2", "right"), nothing, words=("--template", "t")
    )
    assert "t/b.md.j2:1:1: error: this template uses an undefined name: 'nosuch' is not defined [LF7202]" in output
    assert (cell / "out" / "b.md").read_text() == "right"


def test_templates_next_to_their_output_do_not_compile_for_ever(cell: Path, watch: Callable[..., list[str]]):
    by_templates(cell / "out")
    output = watch(sets("out/a.md.j2", "changed"), nothing, nothing, words=("--template", "out"))
    assert [line for line in output if line.startswith("wrote")] == ["wrote out/a.md"] * 2


def test_an_output_that_somebody_deletes_is_made_again(cell: Path, watch: Callable[..., list[str]]):
    output = watch(removes("out/cell.urdf"), nothing)
    assert output[2:] == ["out/cell.urdf is gone", "wrote out/cell.urdf", WATCHING]
    assert (cell / "out" / "cell.urdf").exists()


def test_an_output_removed_by_the_command_is_not_missed(cell: Path, watch: Callable[..., list[str]]):
    assert watch(nothing, nothing, words=("--then", "mv out/cell.urdf robot.urdf")) == ["wrote out/cell.urdf", WATCHING]


def beside_and_over(folder: Path, text: str) -> None:
    """Save as most editors do: a new file, moved over the old one."""
    (folder / ".arm.tmp").write_text(text)
    (folder / ".arm.tmp").replace(folder / "arm.robot.yaml")


def aside_and_anew(folder: Path, text: str) -> None:
    """Save as vim does: the old file becomes the backup, and a new one is written."""
    (folder / "arm.robot.yaml").rename(folder / "arm.robot.yaml~")
    (folder / "arm.robot.yaml").write_text(text)


def with_the_same_time(folder: Path, text: str) -> None:
    """Save as a tool that keeps times, with as many bytes as before."""
    path = folder / "arm.robot.yaml"
    times = path.stat()
    (folder / "new").write_text(text)
    os.utime(folder / "new", ns=(times.st_atime_ns, times.st_mtime_ns))
    (folder / "new").replace(path)


@pytest.mark.parametrize("save", [beside_and_over, aside_and_anew, with_the_same_time])
def test_a_fault_and_its_mending_are_seen_however_an_editor_saves(
    cell: Path, watch: Callable[..., list[str]], save: Callable[[Path, str], None]
):
    output = watch(lambda folder: save(folder, ARM.replace("hand", "$and")), lambda folder: save(folder, ARM))
    assert output[2] == "arm.robot.yaml changed"
    assert any("'$and'" in line for line in output)
    assert output[-3:] == ["arm.robot.yaml changed", "out/cell.urdf is up to date", WATCHING]


def test_a_folder_of_modules_that_moves_away_and_back_is_one(cell: Path, watch: Callable[..., list[str]]):
    (cell / "parts").mkdir()
    (cell / "arm.robot.yaml").rename(cell / "parts" / "arm.robot.yaml")
    (cell / "cell.robot.yaml").write_text(CELL.replace("arm.robot.yaml", "parts/arm.robot.yaml"))
    output = watch(lambda _: (cell / "parts").rename(cell / "away"), lambda _: (cell / "away").rename(cell / "parts"))
    assert any("there is no file 'parts/arm.robot.yaml'" in line for line in output)
    assert output[-3:] == ["parts/arm.robot.yaml changed", "out/cell.urdf is up to date", WATCHING]


def test_files_that_change_together_are_one_change(watch: Callable[..., list[str]]):
    def both(folder: Path) -> None:
        sets("cell.robot.yaml", CELL + "\n")(folder)
        sets("arm.robot.yaml", ARM + "\n")(folder)

    output = watch(both)
    assert output[2:] == ["cell.robot.yaml and 1 more changed", "out/cell.urdf is up to date", WATCHING]


def test_what_changes_while_the_command_runs_is_seen(watch: Callable[..., list[str]]):
    output = watch(nothing, words=("--then", "[ -e done ] || { touch done; echo '# more' >> arm.robot.yaml; }"))
    assert output[2:] == ["arm.robot.yaml changed", "out/cell.urdf is up to date", WATCHING]


def test_a_command_runs_after_each_compile_without_errors(cell: Path, watch: Callable[..., list[str]]):
    output = watch(
        sets("arm.robot.yaml", ARM.replace("hand: ", "hand: {colision: visual}")),
        sets("arm.robot.yaml", ARM.replace("hand", "gripper")),
        words=("--then", "grep -c link out/cell.urdf >> counts; exit 3"),
    )
    assert len((cell / "counts").read_text().split()) == 2
    assert output.count("'grep -c link out/cell.urdf >> counts; exit 3' ended with exit code 3") == 2


def test_a_failing_command_is_reported_even_with_quiet(watch: Callable[..., list[str]]):
    assert watch(nothing, words=("-q", "--then", "exit 3")) == ["'exit 3' ended with exit code 3"]


def test_what_is_saved_while_it_is_compiled_is_compiled_again(
    cell: Path, watch: Callable[..., list[str]], monkeypatch: pytest.MonkeyPatch
):
    compile_request = watch_command.compile_request
    saves = iter([ARM.replace("hand", "gripper")])

    def compile_while_a_person_saves(request: BuildRequest, arguments: argparse.Namespace) -> Compilation:
        compilation = compile_request(request, arguments)
        for text in saves:
            (cell / "arm.robot.yaml").write_text(text)
            # The clock of a file system may be some milliseconds behind.
            now = time.time_ns()
            os.utime(cell / "arm.robot.yaml", ns=(now, now))
        return compilation

    monkeypatch.setattr(watch_command, "compile_request", compile_while_a_person_saves)
    assert watch(nothing)[2:] == ["arm.robot.yaml changed", "wrote out/cell.urdf", WATCHING]
    assert '<link name="arm_gripper"/>' in (cell / "out" / "cell.urdf").read_text()


def test_a_refused_output_is_reported_until_it_is_fixed(watch: Callable[..., list[str]]):
    output = watch(
        sets("cell.robot.yaml", CELL.replace("arm.robot.yaml", "out/cell.urdf")),
        sets("cell.robot.yaml", CELL),
        words=("-q",),
    )
    refused = "'out/cell.urdf' would be replaced, and the robot is made from it; write to another place"
    assert output == [f"linkforge watch: {refused}"]


def test_a_file_where_the_output_has_its_folder_does_not_end_it(cell: Path, watch: Callable[..., list[str]]):
    def put_a_file_there(folder: Path) -> None:
        (folder / "out" / "cell.urdf").unlink()
        (folder / "out").rmdir()
        (folder / "out").write_text("")
        sets("arm.robot.yaml", ARM.replace("hand", "gripper"))(folder)

    def make_room(folder: Path) -> None:
        (folder / "out").unlink()
        sets("arm.robot.yaml", ARM.replace("hand", "finger"))(folder)

    output = watch(put_a_file_there, make_room)
    assert any(line.startswith("linkforge watch: cannot write 'out/cell.urdf'") for line in output)
    assert output[-2:] == ["wrote out/cell.urdf", WATCHING]


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("cell.robot.yaml",), "watch renews files, so it takes -o with a folder or a file"),
        (("-", "-o", "out/"), "takes a file, not standard input"),
        ((".", "-o", "out/"), "takes a spec, NAME.robot.yaml, found the folder '.'"),
        (("cell.robot.yaml", "-o", "out/", "--then", " "), "--then takes a command, found nothing"),
    ],
)
def test_what_cannot_be_watched_is_reported(
    cell: Path, capfd: pytest.CaptureFixture[str], words: tuple[str, ...], expected: str
):
    assert main(["watch", *words]) == 2
    assert expected in capfd.readouterr().err


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT to send")
def test_ctrl_c_ends_it_without_a_word(cell: Path):
    command = interruptible("watch", "cell.robot.yaml", "-o", "out/")
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr
        lines = [process.stderr.readline(), process.stderr.readline()]
        process.send_signal(signal.SIGINT)
        try:
            _, rest = process.communicate(timeout=60)
        finally:
            process.kill()
    assert process.returncode == 130
    assert lines == ["wrote out/cell.urdf\n", f"{WATCHING}\n"]
    assert rest == ""
