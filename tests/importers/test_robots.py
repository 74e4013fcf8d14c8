"""Real robots come in, and go out the same: an independent judge compares, and what it does not see is a law."""

import re
from pathlib import Path
from typing import NamedTuple

import pytest

from linkforge_compile import Diagnostic, Severity, compile_text, import_urdf, render_srdf, render_urdf
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.limits import Budget
from linkforge_compile.source import SourceFile
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar, read
from tests.conftest import Judge
from tests.importers.robots import OF_CORPUS, OF_EXAMPLES, PAIRS, STEP

OTHER_ROBOT = "LF8103"
"""An SRDF is written for a robot of another name, which does not come back."""


class Documents(NamedTuple):
    """A robot in the formats that it comes in and goes out; `srdf` is None where it has none."""

    urdf: Path
    srdf: Path | None

    def __str__(self) -> str:
        own = self.srdf or self.urdf
        return f"{own.parent.parent.name}-{own.stem}"


ROBOTS = [
    *[Documents(urdf, None) for urdf in (*OF_CORPUS, *OF_EXAMPLES) if urdf not in {urdf for urdf, _ in PAIRS}][::STEP],
    *(Documents(urdf, srdf) for urdf, srdf in PAIRS),
]


def imported(robot: Documents) -> tuple[str, tuple[Diagnostic, ...]]:
    """Return the spec of a robot, and the losses."""
    whole = import_urdf(robot.urdf, srdf=robot.srdf)
    assert whole.text is not None, whole.diagnostics
    assert not whole.has_errors, whole.diagnostics
    return whole.text, whole.losses


def compiled(text: str, folder: Path) -> Documents:
    """Return the documents that a spec compiles to."""
    compilation = compile_text(text)
    errors = [str(one) for one in compilation.diagnostics if one.severity is Severity.ERROR]
    assert not errors
    robot = compilation.result()
    folder.mkdir()
    documents = Documents(folder / "robot.urdf", folder / "robot.srdf" if robot.has_semantic else None)
    documents.urdf.write_text(render_urdf(robot), "utf-8")
    if documents.srdf:
        documents.srdf.write_text(render_srdf(robot), "utf-8")
    return documents


def texts(robot: Documents) -> list[str]:
    return [path.read_text("utf-8") for path in robot if path]


REFUSED_BY_MUJOCO = {"romeo_laas_small", "tiago", "tiago_dual", "tiago_no_hand", "unitree_go2_description"}
"""The vendors' own files, of which it tells as much as of ours."""


@pytest.mark.parametrize("robot", ROBOTS, ids=str)
def test_a_robot_is_the_same_to_every_consumer_and_stays_so(robot: Documents, judge: Judge, tmp_path: Path):
    """What came in once stays: its spec comes again from what that compiles to, and from then on byte for byte."""
    spec, losses = imported(robot)
    renamed = [loss for loss in losses if loss.code.id == OTHER_ROBOT]
    assert len(losses) == len(renamed)
    ours = compiled(spec, tmp_path / "ours")
    checks = judge(robot.urdf, ours.urdf, *(("--srdf", robot.srdf, ours.srdf) if robot.srdf else ()))
    mujoco = checks.pop("mujoco")["status"]
    assert [one["path"] for one in checks.pop("srdf", {}).get("fatal", ())] == ["/robot/@name"] * len(renamed)
    assert {name: check["status"] for name, check in checks.items()} == dict.fromkeys(("xml", "pin", "urdfdom"), "same")
    assert mujoco == ("both-reject" if robot.urdf.stem in REFUSED_BY_MUJOCO else "same")
    again, lost_again = imported(ours)
    assert not lost_again
    assert texts(compiled(again, tmp_path / "again")) == texts(ours)
    assert content_of(again) == content_of(spec)


def content_of(spec: str) -> object:
    """Return the content of a spec, without comments, spelling of numbers, layout of raw XML and the order of keys."""
    return _content_of(read(SourceFile("spec", spec), Diagnostics(), Budget()))


def _content_of(node: YamlNode | None) -> object:
    if isinstance(node, YamlMap):
        return {entry.name: _content_of(entry.value) for entry in node}
    if isinstance(node, YamlList):
        return [_content_of(item) for item in node]
    assert isinstance(node, YamlScalar)
    if not node.text.startswith("<"):
        return node.value
    words = " ".join(re.sub(r"<!--.*?-->", "", node.text, flags=re.DOTALL).split())
    dense = re.sub(r"\s*(/?>|=)\s*", r"\1", words)
    return re.sub(r"<([^\s<>]+)([^<>]*)></\1>", r"<\1\2/>", dense)
