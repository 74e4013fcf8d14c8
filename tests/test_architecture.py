"""The house, held true: which room may import from which. Read downward, the table is the compiler."""

import ast
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "linkforge_compile"

MAY_IMPORT = {
    "banner": "",
    "source": "",
    "units": "",
    "resources": "",
    "roots": "",
    "manifest": "roots",
    "fresh_stack": "",
    "gc_paused": "",
    "file_watcher": "",
    "_version": "",
    "diagnostics": "source",
    "limits": "source diagnostics",
    "syntax": "source diagnostics limits units",
    "expressions": "source diagnostics limits units syntax",
    "schema": "source diagnostics syntax units resources expressions",
    "core": "manifest source units roots",
    "importers": "banner source diagnostics limits units syntax core",
    "expand": "source diagnostics limits units syntax schema expressions importers manifest roots",
    "lower": "source diagnostics limits units syntax expand core roots",
    "checks": "source diagnostics units core roots",
    "formats": "source diagnostics limits units core resources roots gc_paused",
    "_build_hook": "schema formats",
    "export_spec": "source units syntax core expand",
    "compare": "source units core formats",
    "pipeline": (
        "source diagnostics limits units syntax schema importers expand lower checks formats core roots fresh_stack "
        "gc_paused"
    ),
    "importing": "source diagnostics limits syntax importers expand core lower formats pipeline fresh_stack gc_paused",
    "launch": "diagnostics formats core expand pipeline file_watcher",
    "editor": "diagnostics syntax schema expand lower core roots resources formats fresh_stack",
    "cli": (
        "banner source diagnostics limits roots core checks schema expand pipeline importing formats export_spec "
        "compare editor resources file_watcher _version"
    ),
}

# `Robot.export_urdf` and `export_srdf` are methods because the contract says so: the one place that reaches up.
REACHES_UP = {("core/models/robot.py", room) for room in ("diagnostics", "checks", "formats")}

FACES = {"__init__", "__main__"}


def rooms_imported_by(path: Path) -> Iterator[str]:
    """Yield the room of every import of ours in a file, those inside functions too."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        match node:
            case ast.Import(names=names):
                modules = [alias.name for alias in names]
            case ast.ImportFrom(module="linkforge_compile", names=names, level=0):
                modules = [f"linkforge_compile.{alias.name}" for alias in names]
            case ast.ImportFrom(module=module, level=0):
                modules = [module or ""]
            case ast.ImportFrom():
                pytest.fail(f"{path}:{node.lineno}: relative import; the table reads absolute ones")
            case _:
                continue
        for module in modules:
            package, _, rest = module.partition(".")
            if package == "linkforge_compile" and rest:
                yield rest.split(".")[0]


def room_of(path: Path) -> str:
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


FILES = sorted(path for path in PACKAGE.rglob("*.py") if "_data" not in path.parts)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_a_room_imports_only_what_lies_below_it(path: Path):
    room = room_of(path)
    if room in FACES:
        return
    allowed = {room, *MAY_IMPORT[room].split()}
    above = {
        other
        for other in rooms_imported_by(path)
        if other not in allowed and (path.relative_to(PACKAGE).as_posix(), other) not in REACHES_UP
    }
    assert not above, f"{room} may import {sorted(allowed - {room})}"


def test_the_table_has_no_cycle():
    order: list[str] = []
    for room, below in MAY_IMPORT.items():
        assert set(below.split()) <= set(order), f"{room} imports a room that stands further down"
        order.append(room)


def test_every_room_is_in_the_table():
    assert {room_of(path) for path in FILES} - FACES == set(MAY_IMPORT)


# What the user fixed, and what stands beside it.
TOP_LEVEL = "pyproject.toml linkforge_compile schemas templates tests examples README.md LICENSE CHANGELOG.md"
BESIDE = "benchmarks cmake docs"


def test_nothing_else_is_kept_at_the_top_level():
    if not (PACKAGE.parent / ".git").exists():
        pytest.skip("not a checkout: what is kept is not known")
    kept = subprocess.run(["git", "ls-files", "-z"], cwd=PACKAGE.parent, capture_output=True, text=True, check=True)
    names = {path.split("/")[0] for path in kept.stdout.split("\0") if path and not path.startswith(".")}
    assert names == {*TOP_LEVEL.split(), *BESIDE.split()}
