"""Which package may import which; read from top to bottom, the table is the order of the compiler's stages."""

import ast
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import networkx
import pytest

PACKAGE = Path(__file__).parents[1] / "linkforge_compile"

MAY_IMPORT = {
    "banner": "",
    "source": "",
    "units": "",
    "resources": "",
    "roots": "",
    "fresh_stack": "",
    "gc_paused": "",
    "file_watcher": "",
    "_version": "",
    "installation": "",
    "file_names": "",
    "atomic_file": "",
    "diagnostics": "source",
    "fixing": "source diagnostics roots",
    "limits": "source diagnostics",
    "syntax": "source diagnostics limits units",
    "formatter": "source diagnostics limits syntax",
    "expressions": "source diagnostics limits units syntax",
    "paths": "source diagnostics syntax expressions roots",
    "schema": "source diagnostics syntax units resources expressions",
    "core": "source units roots",
    "compilation": "diagnostics core",
    "importers": "banner source diagnostics limits units syntax core compilation roots paths",
    "load": "source diagnostics limits units syntax schema importers roots paths compilation",
    "expand": "source diagnostics limits units syntax schema expressions importers load paths",
    "listing": "source diagnostics units syntax expressions importers load expand roots paths",
    "lower": "source diagnostics limits units syntax load expand core roots paths",
    "checks": "source diagnostics units core roots",
    "formats": "source diagnostics limits units core resources roots gc_paused",
    "_build_hook": "schema formats",
    "shape_files": "source diagnostics core checks formats roots",
    "overview": "source diagnostics units core listing checks formats shape_files resources",
    "export_spec": "source diagnostics units syntax core expand listing",
    "compare": "source units core formats",
    "collisions": "source diagnostics syntax core checks shape_files",
    "analysis": (
        "source diagnostics limits load expand lower checks formats core roots fresh_stack gc_paused compilation"
    ),
    "pipeline": "diagnostics limits load expand listing formats compilation analysis core",
    "importing": (
        "source diagnostics limits syntax core compilation importers load expand lower formats analysis "
        "pipeline fresh_stack gc_paused"
    ),
    "migration": (
        "source diagnostics units syntax expressions core compilation importers load compare listing analysis pipeline "
        "importing paths roots expand file_names"
    ),
    "launch": "diagnostics formats core load expand listing pipeline file_watcher",
    "editor": "diagnostics units syntax schema load expand listing lower core roots resources formats fresh_stack",
    "lsp": (
        "analysis source diagnostics fixing syntax formatter schema expressions units load expand listing core "
        "export_spec overview editor roots paths resources formats limits lower checks compilation file_names _version"
    ),
    "view": (
        "source diagnostics checks formats core shape_files resources compare expand listing analysis pipeline "
        "file_watcher roots units"
    ),
    "sweep": (
        "source diagnostics units limits syntax expressions core listing load expand formats shape_files overview "
        "banner roots paths analysis compilation file_watcher file_names atomic_file _version"
    ),
    "cli": (
        "banner source diagnostics fixing limits roots paths core checks schema importers load expand listing analysis "
        "pipeline importing migration formats formatter overview export_spec compare collisions view editor lsp "
        "sweep resources units file_watcher installation file_names atomic_file _version"
    ),
}

# LinkForge's API has the methods `Robot.export_urdf` and `export_srdf`, so this file imports packages below it.
EXCEPTIONS = {("core/models/robot.py", package) for package in ("diagnostics", "checks", "formats")}

ENTRY_POINTS = {"__init__", "__main__"}


def imported_names(path: Path) -> Iterator[str]:
    """Yield the dotted path of all that a file imports, also inside functions: `linkforge_compile.core.Robot`."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        match node:
            case ast.Import(names=names):
                yield from (alias.name for alias in names)
            case ast.ImportFrom(module=str(module), names=names, level=0):
                yield from (f"{module}.{alias.name}" for alias in names)
            case ast.ImportFrom():
                pytest.fail(f"{path}:{node.lineno}: relative import; the table needs absolute ones")


def imported_packages(path: Path) -> Iterator[str]:
    """Yield the package of each import from linkforge_compile in a file."""
    for name in imported_names(path):
        top, *rest = name.split(".")
        if top == "linkforge_compile" and rest:
            yield rest[0]


def package_of(path: Path) -> str:
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


FILES = sorted(path for path in PACKAGE.rglob("*.py") if "_data" not in path.parts)


def test_a_package_imports_only_packages_above_it_in_the_table():
    for path in FILES:
        package, file = package_of(path), path.relative_to(PACKAGE).as_posix()
        if package not in ENTRY_POINTS:
            allowed = {package, *MAY_IMPORT[package].split()}
            others = {other for other in {*imported_packages(path)} - allowed if (file, other) not in EXCEPTIONS}
            assert not others, f"{file} may import {sorted(allowed - {package})}"


def test_the_table_has_no_cycle():
    order: list[str] = []
    for package, imported in MAY_IMPORT.items():
        assert set(imported.split()) <= set(order), f"{package} imports a package below it in the table"
        order.append(package)


def test_every_package_is_in_the_table():
    assert {package_of(path) for path in FILES} - ENTRY_POINTS == set(MAY_IMPORT)


def module_of(path: Path) -> str:
    return ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")


MODULES = {module_of(path) for path in FILES}


def imported_modules(path: Path) -> Iterator[str]:
    """Yield the module of each import from linkforge_compile in a file, also for types alone."""
    for name in imported_names(path):
        if module := next((part for part in (name, name.rpartition(".")[0]) if part in MODULES), None):
            yield module


def test_no_files_import_each_other():
    imports = networkx.DiGraph(
        (module_of(path), module)
        for path in FILES
        for module in imported_modules(path)
        if (path.relative_to(PACKAGE).as_posix(), module.split(".")[1]) not in EXCEPTIONS
    )
    circles = [sorted(group) for group in networkx.strongly_connected_components(imports) if len(group) > 1]
    assert not circles


@pytest.mark.parametrize("package", ["load", "expand"])
def test_a_drawing_has_the_modules_of_its_package_below_those_that_they_import(package: str):
    folder = PACKAGE / package
    drawn = re.findall(r"^    (\w+)  ", ast.get_docstring(ast.parse((folder / "__init__.py").read_text("utf-8"))), re.M)
    assert set(drawn) == {path.stem for path in folder.glob("*.py")} - {"__init__"}
    for place, name in enumerate(drawn):
        imported = {
            module.rpartition(".")[2] for module in imported_modules(folder / f"{name}.py") if f".{package}." in module
        }
        assert imported <= set(drawn[:place]), name


def test_no_function_of_a_package_has_the_name_of_a_module_in_it():
    """Importing the module later would put it in the place of the function."""
    for path in FILES:
        if path.name == "__init__.py":
            modules = {file.stem for file in path.parent.glob("*.py")}
            tree = ast.parse(path.read_text("utf-8"))
            defined = {node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
            assert not defined & modules, path


MOST_LINES_OF_MODULE, MOST_LINES_OF_FUNCTION = 350, 40


def test_modules_and_functions_are_short():
    """A decorator is not counted, a docstring is."""
    for path in FILES:
        text, file = path.read_text("utf-8"), path.relative_to(PACKAGE).as_posix()
        assert text.count("\n") <= MOST_LINES_OF_MODULE, f"{file} is too long: split it by subject"
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                lines = node.end_lineno - node.lineno + 1
                assert lines <= MOST_LINES_OF_FUNCTION, f"{file}:{node.lineno}: '{node.name}' is too long: split it"


GUIDE, OVERVIEW = [
    (PACKAGE.parent / "docs" / name).read_text("utf-8") for name in ("contributing.md", "how-it-is-built.md")
]
NEW_FILES = {"linkforge_compile/cli/commands/links.py", "tests/cli/test_links.py"}
"""Files that the guide creates in an example."""


def test_the_guide_has_a_row_for_each_package():
    rows = re.findall(r"^\| (.*?) \|", OVERVIEW.partition("| package |")[2].partition("\n\n")[0], re.MULTILINE)
    named = {name for row in rows for name in re.findall(r"`(\w+)`", row)}
    assert named == {path.parent.name for path in PACKAGE.glob("*/__init__.py")}


def test_files_in_the_guide_exist():
    folders = (PACKAGE.parent, PACKAGE)
    for name in {*re.findall(r"`([\w./]+/\w+\.\w+(?:\.j2)?)`", OVERVIEW + GUIDE)} - NEW_FILES:
        assert any((folder / name).exists() for folder in folders), name


# The layout that the project prescribes, what colcon reads, and further folders.
TOP_LEVEL = "pyproject.toml linkforge_compile schemas templates tests examples README.md LICENSE CHANGELOG.md"
COLCON = "package.xml setup.py"
FURTHER = "benchmarks cmake docs editors"


def test_nothing_else_is_at_the_top_level():
    if not (PACKAGE.parent / ".git").exists():
        pytest.skip("not a checkout of git")
    kept = subprocess.run(["git", "ls-files", "-z"], cwd=PACKAGE.parent, capture_output=True, text=True, check=True)
    names = {path.split("/")[0] for path in kept.stdout.split("\0") if path and not path.startswith(".")}
    assert names == {*TOP_LEVEL.split(), *COLCON.split(), *FURTHER.split()}
