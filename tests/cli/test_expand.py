"""`linkforge expand`: one flat spec that compiles to the same robot, with the source of each part."""

import re
from pathlib import Path
from textwrap import dedent

import pytest

from linkforge_compile import compile_file, compile_text, render_srdf, render_urdf, write_spec
from linkforge_compile.syntax import YamlMap
from tests.cli.in_process import linkforge
from tests.test_examples import SPECS, name_of

WHEEL = """\
linkforge: 1
name: wheel
parameters: {radius: 0.1 m}
links:
  wheel: {visual: {mesh: meshes/wheel.stl}}
  hub: {visual: {sphere: $(radius)}}
joints:
  axle: {type: fixed, parent: wheel, child: hub}
"""
CART = """\
linkforge: 1
name: cart
links:
  base: {visual: {mesh: base.stl}}
modules:
  left: {use: parts/wheel.robot.yaml, parent: base, with: {radius: 20 cm}}
semantic:
  groups: {all: {links: [left_hub]}}
  disabled_collisions: {base: {left_wheel: Adjacent}}
"""
TRIANGLE = """\
solid shell
  facet normal 0 0 1
    outer loop
      vertex 0 0 0
      vertex 1 0 0
      vertex 0 1 0
    endloop
  endfacet
endsolid shell
"""


@pytest.fixture
def cart(tmp_path: Path) -> Path:
    (tmp_path / "cart.robot.yaml").write_text(CART)
    (tmp_path / "parts" / "meshes").mkdir(parents=True)
    for mesh in ("base.stl", "parts/meshes/wheel.stl"):
        (tmp_path / mesh).write_text(TRIANGLE)
    (tmp_path / "parts" / "wheel.robot.yaml").write_text(WHEEL)
    return tmp_path


@pytest.mark.parametrize("spec", SPECS, ids=name_of)
def test_the_flat_spec_compiles_to_the_same_bytes(spec: Path):
    robot = compile_file(spec).result()
    again = compile_text(write_spec(robot, origins=True), folder=spec.parent)
    assert render_urdf(again.result()) == render_urdf(robot)
    assert render_srdf(again.result()) == render_srdf(robot)


@pytest.mark.parametrize("spec", SPECS, ids=name_of)
def test_nothing_is_left_to_compute_in_it_and_nothing_to_warn_of(spec: Path):
    text = write_spec(compile_file(spec).result(), origins=True)
    tree = compile_text(text, folder=spec.parent).result().source
    assert tree is not None
    assert isinstance(tree.node, YamlMap)
    assert not {"modules", "parameters", "variables", "defaults", "include", "mount", "data"} & set(tree.node.entries)
    assert not re.search(r"(?<!\$)\$\(", text)


def test_each_part_names_its_source_relative_to_the_spec(cart: Path):
    run = linkforge("expand", "cart.robot.yaml", cwd=cart)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout == dedent("""\
        # Expanded by linkforge from cart.robot.yaml; edit that file, not this one.
        linkforge: 1
        name: cart

        links:
          # cart.robot.yaml:4
          base: {visual: {mesh: base.stl}}
          # parts/wheel.robot.yaml:5, used at cart.robot.yaml:6
          left_wheel: {visual: {mesh: parts/meshes/wheel.stl}}
          # parts/wheel.robot.yaml:6, used at cart.robot.yaml:6
          left_hub: {visual: {sphere: 0.2}}

        joints:
          # parts/wheel.robot.yaml:8, used at cart.robot.yaml:6
          left_axle: {type: fixed, parent: left_wheel, child: left_hub}
          # cart.robot.yaml:6
          left_joint: {type: fixed, parent: base, child: left_wheel}

        semantic:
          groups:
            # cart.robot.yaml:8
            all: {links: [left_hub]}
          disabled_collisions:
            # cart.robot.yaml:9
            base: {left_wheel: Adjacent}
    """)


def test_it_is_the_same_text_wherever_it_runs_and_tells_no_path_of_the_machine(cart: Path, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    here = linkforge("expand", "cart.robot.yaml", cwd=cart).stdout
    there = linkforge("expand", str(cart / "cart.robot.yaml"), cwd=elsewhere).stdout
    assert here == there
    assert str(cart) not in there


def test_the_output_goes_to_a_file_and_parameters_are_set(cart: Path):
    run = linkforge("expand", "parts/wheel.robot.yaml", "-o", "flat.robot.yaml", "radius:=5cm", cwd=cart)
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "wrote flat.robot.yaml\n")
    assert "sphere: 0.05" in (cart / "flat.robot.yaml").read_text()
    assert (
        "up to date"
        in linkforge("expand", "parts/wheel.robot.yaml", "-o", "flat.robot.yaml", "radius:=5cm", cwd=cart).stderr
    )


def test_no_file_is_replaced_that_it_is_made_from(cart: Path):
    run = linkforge("expand", "cart.robot.yaml", "-o", "parts/wheel.robot.yaml", cwd=cart)
    assert (run.returncode, run.stdout) == (2, "")
    assert "'parts/wheel.robot.yaml' would be replaced, and the robot is made from it" in run.stderr
    assert (cart / "parts" / "wheel.robot.yaml").read_text() == WHEEL


def test_standard_input_is_expanded_too(cart: Path):
    run = linkforge("expand", "-", cwd=cart, stdin=WHEEL)
    assert "# <stdin>:6\n  hub: {visual: {sphere: 0.1}}" in run.stdout


def test_a_spec_with_errors_is_reported_and_not_expanded(cart: Path):
    run = linkforge("expand", "-", cwd=cart, stdin=WHEEL.replace("child: hub", "child: wheels"))
    assert (run.returncode, run.stdout) == (1, "")
    assert "did you mean 'wheel'?" in run.stderr
