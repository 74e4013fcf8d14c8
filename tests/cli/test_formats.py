"""`linkforge formats`: what each output format keeps and loses."""

import json
import re
from pathlib import Path

import pytest

from linkforge_compile.formats import FORMATS, format_named
from tests.cli.in_process import linkforge


def test_every_format_is_listed_with_what_it_keeps_and_loses(tmp_path: Path):
    run = linkforge("formats", cwd=tmp_path)
    assert run.returncode == 0
    paragraphs = run.stdout.split("\n\n")
    assert [paragraph.partition(":")[0].strip() for paragraph in paragraphs] == [one.name for one in FORMATS]
    for paragraph, one in zip(paragraphs, FORMATS, strict=True):
        words = " ".join(paragraph.split())
        assert f" keeps {one.keeps} loses {one.loses}" in words
        assert max(map(len, paragraph.splitlines())) <= 110


def test_a_format_is_described_with_its_options(tmp_path: Path):
    run = linkforge("formats", "mjcf", cwd=tmp_path)
    assert run.stdout.startswith("mjcf: the robot for MuJoCo\n  file    NAME.mjcf\n  keeps   links, joints")
    assert "  option  --base fixed|free: whether the robot floats in MuJoCo (default: fixed)\n" in run.stdout
    assert "urdf:" not in run.stdout


def test_tools_read_them_as_json(tmp_path: Path):
    document = json.loads(linkforge("formats", "--json", cwd=tmp_path).stdout)
    assert [one["name"] for one in document] == [one.name for one in FORMATS]
    urdf, *_ = json.loads(linkforge("formats", "urdf", "--json", cwd=tmp_path).stdout)
    assert (urdf["suffix"], urdf["files"], urdf["default"]) == (".urdf", [], True)
    assert [option["choices"] for option in urdf["options"]] == [["gz", "classic"]]


def test_an_unknown_format_is_reported_with_the_nearest(tmp_path: Path):
    run = linkforge("formats", "mjfc", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (
        2,
        "linkforge formats: there is no format 'mjfc'; did you mean 'mjcf'?\n",
    )


@pytest.mark.parametrize("name", [one.name for one in FORMATS])
def test_what_a_format_keeps_and_loses_is_one_sentence_without_a_full_stop(name: str):
    for sentence in (format_named(name).keeps, format_named(name).loses):
        assert re.fullmatch(r"[a-zA-Z].*[^.\s]", sentence)
        assert "\n" not in sentence
