"""The chain that tells who wrote a value."""

from pathlib import Path

from linkforge_compile import compile_file
from linkforge_compile.source.provenance import WORDS, Kind, provenance_of

ARM = """\
linkforge: 1
name: arm
links: {base: {}, upper: {}}
include: [joints.yaml]
"""
JOINTS = """\
linkforge: 1
joints:
  elbow: {type: revolute, parent: base, child: upper, axis: z, limits: {lower: 0, upper: 1, effort: 5, velocity: 2}}
"""
CELL = """\
linkforge: 1
name: cell
links: {table: {}}
modules:
  left:
    use: arm.robot.yaml
    parent: table
    override: {joints: {elbow: {limits: {effort: 8}}}}
"""


def test_a_chain_leads_from_the_inside_out(tmp_path: Path):
    for name, text in (("arm.robot.yaml", ARM), ("joints.yaml", JOINTS), ("cell.robot.yaml", CELL)):
        (tmp_path / name).write_text(text)
    source = compile_file(tmp_path / "cell.robot.yaml").result().joint("left_elbow").source
    velocity = provenance_of(source, "limits", "velocity")
    assert [(link.kind, link.span.file.path.name, link.span.line, link.name) for link in velocity] == [
        (Kind.WRITTEN, "joints.yaml", 3, ""),
        (Kind.OVERRIDE, "cell.robot.yaml", 8, "effort"),
        (Kind.INCLUDE, "arm.robot.yaml", 4, ""),
        (Kind.USE, "cell.robot.yaml", 6, ""),
    ]


def test_a_chain_of_a_value_in_an_override_does_not_repeat_the_override(tmp_path: Path):
    for name, text in (("arm.robot.yaml", ARM), ("joints.yaml", JOINTS), ("cell.robot.yaml", CELL)):
        (tmp_path / name).write_text(text)
    source = compile_file(tmp_path / "cell.robot.yaml").result().joint("left_elbow").source
    [effort] = provenance_of(source, "limits", "effort")
    assert (effort.kind, effort.span.file.path.name, effort.span.text) == (Kind.WRITTEN, "cell.robot.yaml", "8")


def test_only_an_alias_inserts_the_name_of_a_robot(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text("linkforge: 1\nname: arm\nlinks: {base: }\n")
    [written] = provenance_of(compile_file(tmp_path / "arm.robot.yaml").result().source, "name")
    assert (written.kind, written.span.line) == (Kind.WRITTEN, 2)
    aliased = "linkforge: 1\nlinks: {&name base: }\nname: *name\n"
    (tmp_path / "arm.robot.yaml").write_text(aliased)
    chain = provenance_of(compile_file(tmp_path / "arm.robot.yaml").result().source, "name")
    assert [(link.kind, link.span.line) for link in chain] == [(Kind.WRITTEN, 2), (Kind.ALIAS, 3)]


def test_each_kind_of_link_has_words():
    assert set(WORDS) == set(Kind)
    assert all(any(words) for words in WORDS.values())
