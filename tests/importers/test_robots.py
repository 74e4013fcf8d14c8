"""Real robots come in, and go out the same: an independent judge compares, and what it does not see is a law."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.import_table import differences_of
from linkforge_compile import Severity, compile_text, import_urdf, render_srdf, render_urdf
from tests.importers.robots import OF_CORPUS, OF_EXAMPLES, PAIRS


def imported(path: Path) -> str:
    read = import_urdf(path)
    assert read.text is not None, read.diagnostics
    assert not read.has_errors, read.diagnostics
    assert not read.losses
    return read.text


def compiled(text: str) -> str:
    compilation = compile_text(text)
    errors = [str(one) for one in compilation.diagnostics if one.severity is Severity.ERROR]
    assert not errors
    return render_urdf(compilation.result())


def judge(shared: Path, theirs: Path, ours: Path, consumers: str) -> None:
    words = [str(shared / "tools" / "urdf_equiv.py"), str(theirs), str(ours), "--with", consumers, "--json"]
    run = subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False, timeout=300)
    assert run.returncode == 0, run.stdout + run.stderr
    assert "skipped" not in json.dumps(json.loads(run.stdout)), run.stdout


@pytest.mark.parametrize("path", OF_CORPUS, ids=lambda path: path.stem)
def test_a_robot_of_the_corpus_is_the_same_to_every_consumer(path: Path, shared: Path, tmp_path: Path):
    ours = tmp_path / "ours.urdf"
    ours.write_text(compiled(imported(path)), "utf-8")
    judge(shared, path, ours, "xml,pin,mujoco,urdfdom")


@pytest.mark.parametrize("path", OF_EXAMPLES, ids=lambda path: f"{path.parent.parent.name}-{path.stem}")
def test_an_example_robot_has_the_same_elements(path: Path, shared: Path, tmp_path: Path):
    ours = tmp_path / "ours.urdf"
    ours.write_text(compiled(imported(path)), "utf-8")
    judge(shared, path, ours, "xml")


@pytest.mark.parametrize(
    "path", [*OF_CORPUS, *OF_EXAMPLES[::6]], ids=lambda path: f"{path.parent.parent.name}-{path.stem}"
)
def test_what_came_in_once_stays_as_it_is(path: Path, tmp_path: Path):
    """The second import reads what we write: no element moves any more, and the third spec is the second."""
    urdf = compiled(imported(path))
    again = tmp_path / "again.urdf"
    again.write_text(urdf, "utf-8")
    second = imported(again)
    assert compiled(second) == urdf
    again.write_text(compiled(second), "utf-8")
    assert imported(again) == second


def of_pair(pair: tuple[Path, Path]) -> str:
    return f"{pair[1].parent.parent.name}-{pair[1].stem}"


@pytest.mark.parametrize("pair", PAIRS, ids=of_pair)
def test_a_robot_with_its_srdf_is_the_same_but_for_the_name_that_was_told(pair: tuple[Path, Path], shared: Path):
    urdf, srdf = pair
    read = import_urdf(urdf, srdf=srdf)
    assert read.text is not None
    assert not read.has_errors, read.diagnostics
    robot = compile_text(read.text).result()
    differences = differences_of(robot, shared / "tools" / "urdf_equiv.py", urdf, srdf, "xml")
    renamed = [loss for loss in read.losses if loss.code.id == "LF8103"]
    assert [one["path"] for one in differences] == ["/robot/@name"] * len(renamed)
    assert len(read.losses) == len(renamed)


@pytest.mark.parametrize("pair", PAIRS[::4], ids=of_pair)
def test_an_srdf_that_came_in_once_stays_as_it_is(pair: tuple[Path, Path], tmp_path: Path):
    urdf, srdf = pair
    specs, documents = [], []
    for number in range(3):
        text = import_urdf(urdf, srdf=srdf).text
        assert text is not None
        robot = compile_text(text).result()
        specs.append(text)
        documents.append((render_urdf(robot), render_srdf(robot)))
        urdf, srdf = (tmp_path / f"{number}.{kind}" for kind in ("urdf", "srdf"))
        for file, document in zip((urdf, srdf), documents[-1], strict=True):
            file.write_text(document, "utf-8")
    assert documents[0] == documents[1] == documents[2]
    assert specs[1] == specs[2]
