"""Real robots come in, and go out the same: an independent judge compares, and what it does not see is a law."""

import json
import re
import runpy
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import pytest

from benchmarks.import_table import differences_of
from linkforge_compile import Severity, compile_text, import_urdf, render_srdf, render_urdf
from linkforge_compile.bounds import Budget
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar, read
from tests.importers.robots import OF_CORPUS, OF_EXAMPLES, PAIRS


def imported(path: Path) -> str:
    whole = import_urdf(path)
    assert whole.text is not None, whole.diagnostics
    assert not whole.has_errors, whole.diagnostics
    assert not whole.losses
    return whole.text


def compiled(text: str) -> str:
    compilation = compile_text(text)
    errors = [str(one) for one in compilation.diagnostics if one.severity is Severity.ERROR]
    assert not errors
    return render_urdf(compilation.result())


@pytest.fixture(scope="session")
def judge(shared: Path):
    """Return what tells whether two files are the same robot to each consumer; in process, which costs a tenth."""
    main = runpy.run_path(str(shared / "tools" / "urdf_equiv.py"))["main"]

    def checks(theirs: Path, ours: Path) -> dict[str, dict[str, object]]:
        with redirect_stdout(StringIO()) as told:
            main([str(theirs), str(ours), "--json"])
        return json.loads(told.getvalue())["checks"]

    return checks


REFUSED_BY_MUJOCO = {"romeo_laas_small", "tiago", "tiago_dual", "tiago_no_hand", "unitree_go2_description"}
"""The vendors' own files, of which it tells as much as of ours."""

COLOURED_BY_ORDER = {"so101", "talos_full_v2", "talos_full_v2_box"}
"""MuJoCo alone gives these other colours than the vendor's file: it goes by the order of the document, in which the
first of two colours of one name counts, and a collision has the colour of the visual before it."""


@pytest.mark.parametrize("path", [*OF_CORPUS, *OF_EXAMPLES], ids=lambda path: f"{path.parent.parent.name}-{path.stem}")
def test_a_robot_is_the_same_to_every_consumer_and_stays_so(path: Path, judge, tmp_path: Path):
    """What came in once stays: its spec comes again from what that compiles to, and from then on byte for byte."""
    spec = imported(path)
    urdf = compiled(spec)
    ours = tmp_path / "ours.urdf"
    ours.write_text(urdf, "utf-8")
    checks = judge(path, ours)
    mujoco = checks.pop("mujoco")
    assert {name: check["status"] for name, check in checks.items()} == dict.fromkeys(("xml", "pin", "urdfdom"), "same")
    if path.stem in COLOURED_BY_ORDER:
        assert all(one.endswith(": geoms differ") for one in mujoco["diffs"])
    else:
        assert mujoco["status"] == ("both-reject" if path.stem in REFUSED_BY_MUJOCO else "same")
    again = imported(ours)
    assert compiled(again) == urdf
    assert told(again) == told(spec)


def told(spec: str) -> object:
    """Return what a spec says, but for comments, spelling of numbers, layout of raw XML and the order of keys."""
    return _told(read(SourceFile("spec", spec), Diagnostics(), Budget()))


def _told(node: YamlNode | None) -> object:
    if isinstance(node, YamlMap):
        return {entry.name: _told(entry.value) for entry in node}
    if isinstance(node, YamlList):
        return [_told(item) for item in node]
    assert isinstance(node, YamlScalar)
    if not node.text.startswith("<"):
        return node.value
    words = " ".join(re.sub(r"<!--.*?-->", "", node.text, flags=re.DOTALL).split())
    dense = re.sub(r"\s*(/?>|=)\s*", r"\1", words)
    return re.sub(r"<([^\s<>]+)([^<>]*)></\1>", r"<\1\2/>", dense)


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
