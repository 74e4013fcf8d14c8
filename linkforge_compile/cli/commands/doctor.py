"""`linkforge doctor`: prints what is installed, which packages are found, and why a `package://` is not."""

from __future__ import annotations

import argparse
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from linkforge_compile._version import __version__
from linkforge_compile.cli import FAULTY_SPEC, OK, UsageError
from linkforge_compile.cli.options import add_package_option, packages_of
from linkforge_compile.paths import (
    follow,
    misspelt_part,
    packages_around,
    packages_in_environment,
    searched_places,
    shortest,
    split_package_path,
)
from linkforge_compile.roots import ANYWHERE, exists

_EXAMPLES = """\
Without arguments, it prints the versions of linkforge and its dependencies, the optional extras, the environment
variables that it reads and the ROS packages that it finds. With packages or paths, it prints each place that is
searched, in order. With a spec, the search is the same as from that spec, with the `packages` that it declares, and by
default for the packages that it uses. The exit code is 1 if one of them is not found.

examples:
  linkforge doctor
  linkforge doctor arm_description
  linkforge doctor package://arm_description/meshes/base.stl
  linkforge doctor arm.robot.yaml
  linkforge doctor arm.robot.yaml package://arm_description/meshes/base.stl
"""

_MOST_NAMES = 12
_SPEC_ENDINGS = {".yaml", ".yml", ".urdf", ".xacro", ".xml"}
_KNOWN_AS = {"distributed": "distributed (Dask)", "pin": "pin (Pinocchio)"}
_NAMED = re.compile(r"package://([\w.-]+)|\$\(find ([\w.-]+)\)")
_VARIABLES = ("LINKFORGE_BROWSER", "LINKFORGE_DEBUG", "LINKFORGE_LIMITS", "LINKFORGE_NO_XACRO")


class _Search(NamedTuple):
    """Where packages are looked for: the folder to start in, and the folders that are declared, by name."""

    start: Path
    declared: Mapping[str, Path]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge doctor [options] [SPEC] [NAME | package://NAME/PATH ...]"
    parser.epilog = _EXAMPLES
    parser.add_argument("words", metavar="NAME", nargs="*", help="a package, a path in one, or a spec")
    add_package_option(parser)


def run(arguments: argparse.Namespace) -> int:
    from linkforge_compile.cli.output import write_to_stdout

    specs = [word for word in arguments.words if "://" not in word and Path(word).suffix in _SPEC_ENDINGS]
    asked = [word for word in arguments.words if word not in specs]
    declared = {name: Path(folder) for name, folder in packages_of(arguments).items()}
    if len(specs) > 1:
        raise UsageError(f"takes one spec, found {len(specs)}: {', '.join(specs)}")
    search = _Search(Path.cwd(), declared)
    if specs:
        search, named = _read_spec(Path(specs[0]), declared)
        asked = asked or named
        if not asked:
            write_to_stdout(f"{specs[0]} names no package\n")
            return OK
    if not asked:
        write_to_stdout("".join(f"{line}\n" for line in _about_installation()))
        return OK
    are_found = True
    for number, word in enumerate(asked):
        lines, is_found = _about_package(word, search)
        write_to_stdout("\n" * (number > 0) + "".join(f"{line}\n" for line in lines))
        are_found &= is_found
    return OK if are_found else FAULTY_SPEC


def _read_spec(spec: Path, declared: Mapping[str, Path]) -> tuple[_Search, list[str]]:
    """Return where the packages of a spec are looked for, and the names of those in the files that it reads."""
    from linkforge_compile.analysis import Settings, analyse_path
    from linkforge_compile.expand import Unset

    if not spec.is_file():
        raise UsageError(f"there is no file '{spec}'")
    # Its errors are what `check` reports; those about packages are the reason to be here.
    analysis = analyse_path(spec, Settings(packages=dict(declared), unset=Unset.NOTE))
    of_spec = analysis.instance.packages_of_all if analysis.instance else {}
    names = (match[1] or match[2] for source in analysis.sources for match in _NAMED.finditer(source.text))
    return _Search(spec.absolute().parent, {**of_spec, **declared}), sorted(dict.fromkeys(names))


# What is installed


def _about_installation() -> Iterator[str]:
    import platform

    from linkforge_compile.resources import data_folder

    yield f"linkforge {__version__}, Python {platform.python_version()}, {platform.system()} {platform.machine()}"
    yield f"  schemas and templates in {data_folder()}"
    yield from _about_requirements()
    yield ""
    yield "ROS packages"
    for variable in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        yield _row(variable, _folders_of(variable) or "not set; the setup.bash of ROS or of your workspace sets it")
    found = sorted(packages_in_environment())
    more = f" and {len(found) - _MOST_NAMES} more" if len(found) > _MOST_NAMES else ""
    yield _row("found", f"{len(found)}: {', '.join(found[:_MOST_NAMES])}{more}" if found else "none")
    yield ""
    yield "settings"
    for variable in _VARIABLES:
        yield _row(variable, os.environ.get(variable, "not set"))


def _folders_of(variable: str) -> str:
    """Return the folders that a variable lists, with those that do not exist marked; "" without any."""
    folders = filter(None, os.environ.get(variable, "").split(os.pathsep))
    return os.pathsep.join(folder if Path(folder).is_dir() else f"{folder} (no such folder)" for folder in folders)


def _about_requirements() -> Iterator[str]:
    from linkforge_compile.installation import requirements

    needed = requirements()
    yield ""
    yield "required"
    for one in needed.get("", ()):
        yield _row(one.name, one.version or f"missing; pip install '{one.name}{one.versions}'")
    if not needed:
        yield _row("", "unknown: pip did not install linkforge completely")
    yield ""
    yield "extras"
    for extra, packages in sorted(needed.items()):
        if extra and extra not in ("dev", "docs") and packages:
            missing = [_KNOWN_AS.get(one.name, one.name) for one in packages if one.version is None]
            way_out = f"no {', '.join(missing)}; pip install 'linkforge-compile[{extra}]'"
            yield _row(extra, way_out if missing else ", ".join(f"{one.name} {one.version}" for one in packages))
    yield _row("view", _about_viewer())


def _about_viewer() -> str:
    from linkforge_compile.resources import view_page_file
    from linkforge_compile.view.picture import PictureError, find_browser

    if not view_page_file().is_file():
        return "no page, because npm was not installed when linkforge was built"
    try:
        return f"pictures are drawn by {find_browser()[0]}"
    except PictureError as error:
        return f"{error}"


# Why a package is found, or not


def _about_package(word: str, search: _Search) -> tuple[list[str], bool]:
    """Return where a package, or a path in one, was looked for, and whether it was found."""
    is_path = word.startswith("package://")
    parts = split_package_path(word.removeprefix("package://"))
    if parts is None or (parts[1] and not is_path):
        raise UsageError(f"takes a spec, a package or package://NAME/PATH, found '{word}'")
    name, path = parts
    places = list(searched_places(name, search.declared, search.start, ANYWHERE))
    used, folder = next(((place, place.folder) for place in places if place.folder), (None, None))
    lines = [f"package {name}: {folder.absolute() if folder else 'not found'}"]
    lines += [_row(place.source, place.finding + (" (used)" if place is used else "")) for place in places]
    if folder is None:
        return [*lines, *_ways_out(name, search)], False
    if not path:
        return lines, True
    file = follow(folder.absolute(), path)
    return [*lines, *_about_file(file, path)], exists(file)


def _about_file(file: Path, path: str) -> Iterator[str]:
    from linkforge_compile.diagnostics.suggest import did_you_mean

    if exists(file):
        yield f"{path}: {file}"
    else:
        part, names = misspelt_part(file)
        yield f"{path}: not found; there is no '{part}' in the folder{did_you_mean(part, names)}"


def _ways_out(name: str, search: _Search) -> Iterator[str]:
    from linkforge_compile.diagnostics.suggest import is_misspelling, nearest

    nearby = packages_around(search.start, ANYWHERE, {})
    if name in nearby:
        yield f"there is one nearby; write --package {name}={shortest(nearby[name])}, or declare it in `packages`"
        return
    known = {**packages_in_environment(), **search.declared, **nearby}
    like = nearest(name, known)
    is_likely = like is not None and is_misspelling(name, like)  # most names end alike, in `_description`
    yield f"no package.xml nearby has the name '{name}'" + (f"; did you mean '{like}'?" if is_likely else "")
    yield f"if you have it elsewhere, write --package {name}=FOLDER, declare it in `packages`, or source its workspace"


def _row(title: str, text: str) -> str:
    return f"  {title:18} {text}".rstrip()
