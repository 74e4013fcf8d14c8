"""The page for people who know xacro: each construct makes the same robot as the spec beside it."""

import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import pytest

from linkforge_compile import Robot, compile_file, import_urdf
from linkforge_compile.compare import compare
from tests.conftest import ROOT

xacro = pytest.importorskip("xacro")

PAGE = (ROOT / "docs" / "from-xacro.md").read_text("utf-8")
BLOCK = re.compile(r"```(?:xml|yaml) file=(\S+)\n(.*?)```", re.DOTALL)
ROOT_TAG = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="robot">{}</robot>'
HEAD = "linkforge: 1\nname: robot\n"


class Pair(NamedTuple):
    """A xacro and the spec beside it, with the other files that both may read."""

    title: str
    xacro: str
    spec: str
    files: dict[str, str]


def pairs() -> Iterator[Pair]:
    """Yield every spec of the page with the last xacro above it."""
    for section in PAGE.split("\n### ")[1:]:
        title = section.partition("\n")[0]
        blocks = BLOCK.findall(section.partition("\n## ")[0])
        starts = [place for place, (name, _) in enumerate(blocks) if name == "robot.xacro"] + [len(blocks)]
        for start, end in pairwise(starts):
            files = {name: text for name, text in blocks[start:end] if name != "robot.robot.yaml"}
            specs = [text for name, text in blocks[start:end] if name == "robot.robot.yaml"]
            assert specs, f"{title}: a xacro has no spec beside it"
            for number, spec in enumerate(specs):
                yield Pair(f"{title} {number}" if number else title, files["robot.xacro"], spec, files)


PAIRS = [*pairs()]


def write(folder: Path, pair: Pair) -> None:
    for name, text in pair.files.items():
        (folder / name).write_text(ROOT_TAG.format(text) if name.endswith(".xacro") else text, "utf-8")
    whole = pair.spec if pair.spec.startswith("linkforge:") else HEAD + pair.spec
    (folder / "robot.robot.yaml").write_text(whole, "utf-8")


def expanded(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Robot:
    """Return what xacro makes, read by the importer."""
    monkeypatch.chdir(folder)
    (folder / "expanded.urdf").write_text(xacro.process_file("robot.xacro").toxml(), "utf-8")
    spec = import_urdf(folder / "expanded.urdf").text
    assert spec
    (folder / "expanded.robot.yaml").write_text(spec, "utf-8")
    return compile_file(folder / "expanded.robot.yaml").result()


@pytest.mark.parametrize("pair", PAIRS, ids=[pair.title for pair in PAIRS])
def test_a_construct_makes_the_robot_of_the_spec_beside_it(pair: Pair, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    write(tmp_path, pair)
    made = compile_file(tmp_path / "robot.robot.yaml")
    assert [str(one) for one in made.diagnostics if not one.code.id.startswith("LF6")] == []
    assert not list(compare(expanded(tmp_path, monkeypatch), made.result(), tolerance=0))


CONSTRUCTS = """
    xacro:arg xacro:attribute xacro:call xacro:element xacro:if xacro:include xacro:insert_block xacro:macro
    xacro:property xacro:unless xacro:eval-comments scope="parent" scope="global" default="0.4" `remove` `lazy_eval`
    :=^ ^|0.1 **more *origin `ns` optional="true" :=0.7 $${ $(arg $(cwd) $(dirname) $(env $(eval $(find $(optenv
    load_yaml !degrees !radians !meters !millimeters !foot !inches dict( xacro.arg xacro.tokenize xacro.dotify
    xacro.abs_filename xacro.fatal `warning` `error` `message` `print_location` --inorder math. python.
"""
"""What xacro has, of its documentation and its source."""


@pytest.mark.parametrize("construct", CONSTRUCTS.split())
def test_the_page_has_every_construct(construct: str):
    assert construct in PAGE.partition("## What is written in place")[0]
