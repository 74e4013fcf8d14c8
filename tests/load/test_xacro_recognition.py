"""A file is a xacro by its name or by its content, which its root and its tags tell."""

from pathlib import Path
from time import process_time

import pytest

from linkforge_compile import load
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.listing import list_used
from linkforge_compile.load.loader import Loader

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ARG = '<xacro:arg name="size" default="1"/>'


@pytest.mark.parametrize(
    ("content", "is_xacro"),
    [
        (f'<robot name="r" {XACRO}>{ARG}</robot>', True),
        (f'<robot name="r" note="a>b" {XACRO}>{ARG}</robot>', True),
        (f'<!-- a --><?xml version="1.0"?><robot name="r" {XACRO}>{ARG}</robot>', True),
        (f'<robot name="r" {XACRO}><xacro:call/></robot>', False),
        (f'<robot name="r" {XACRO}><!-- {ARG} --></robot>', False),
        (f'<robot name="r" {XACRO}><![CDATA[{ARG}]]></robot>', False),
        (f"<!-- <robot {XACRO}> --><robot name='r'><link name='a'/>{ARG}</robot>", False),
        (f'<robot name="r"><part {XACRO}>{ARG}</part></robot>', False),
        ('<robot name="r" note="<a ' + XACRO, False),
    ],
)
def test_a_urdf_is_a_xacro_by_its_root_and_its_tags(content: str, is_xacro: bool, tmp_path: Path):
    file = tmp_path / "r.urdf"
    file.write_text(content, "utf-8")
    assert load.is_xacro(file) is is_xacro


@pytest.mark.parametrize(
    "content",
    ["<robot name='r' xmlns:x='1'><link name='a'/>" + "<!--" * 60_000, "<robot name='r' " + "<a " * 60_000],
)
def test_a_hostile_file_is_recognized_in_linear_time(content: str, tmp_path: Path):
    file = tmp_path / "r.urdf"
    file.write_text(content, "utf-8")
    begin = process_time()
    assert not load.is_xacro(file)
    assert process_time() - begin < 2


def test_the_arguments_of_a_urdf_that_is_a_xacro_are_listed(tmp_path: Path):
    (tmp_path / "r.urdf").write_text(f'<robot name="r" {XACRO}>{ARG}</robot>', "utf-8")
    (tmp_path / "plain.urdf").write_text('<robot name="r"><link name="a"/></robot>', "utf-8")
    spec = tmp_path / "m.robot.yaml"
    spec.write_text("linkforge: 1\nname: m\nmodules: {r: {use: r.urdf}, p: {use: plain.urdf}}\n", "utf-8")
    loader = Loader()
    opened = loader.open(spec, Diagnostics())
    assert opened is not None
    listed = list_used(opened, loader)
    assert {use: [one.name for one in listing.parameters] for use, listing in listed.items()} == {"r.urdf": ["size"]}
