"""The two robots of `linkforge diff`: what the command line says of each, and how it is compiled."""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.cli import UsageError
from linkforge_compile.cli.options import (
    STDIN,
    compile_spec,
    is_xml,
    name_set_by,
    packages_of,
    parse_packages,
    read_unseekable,
    require_file,
)
from linkforge_compile.cli.reports import errors_of
from linkforge_compile.diagnostics import Note
from linkforge_compile.paths import packages_in_environment
from linkforge_compile.roots import as_walked
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    from linkforge_compile.cli.git_tree import GitTree
    from linkforge_compile.core import Robot
    from linkforge_compile.diagnostics import Diagnostic
    from linkforge_compile.source import Span


SIDES = ("before", "after")
"""The names of the sides in options."""


class Side(NamedTuple):
    """One of the two robots as the command line gives it.

    `file` is what is read: the `word`, or its copy in `tree`, the files of a git revision. `assignments`, the variant
    and `packages` are those of this side alone. `text` is the content of standard input or a pipe, None for a file.
    """

    word: str
    file: str
    assignments: Sequence[str]
    variant: str | None
    srdf: str | None
    packages: Mapping[str, str]
    text: str | None
    is_urdf: bool
    tree: GitTree | None = None

    @property
    def parameters(self) -> dict[str, str]:
        return {name_set_by(pair): pair.partition("=")[2] for pair in self.assignments}

    @property
    def label(self) -> str:
        """The name in a heading, with the settings of this side: `arm.robot.yaml (reach=0.7m)`."""
        settings = [self.tree.name] if self.tree else []
        settings += [f"variant {self.variant}"] if self.variant else []
        settings += [f"{name}={value}" for name, value in self.parameters.items()]
        settings += [f"package {name}={folder}" for name, folder in self.packages.items()]
        settings += [self.srdf] if self.srdf else []
        return on_one_line(f"{self.word} ({', '.join(settings)})" if settings else self.word)

    @property
    def srdf_file(self) -> str | None:
        return self.srdf if self.srdf is None or self.tree is None else str(self.tree.path(self.srdf))

    @property
    def parameter_files(self) -> list[str]:
        """The files that may declare parameters: a spec, or the xacros of a URDF and an SRDF."""
        files = [self.file] if not self.is_urdf or _is_xacro(self.file) else []
        return [*files, self.srdf_file] if self.srdf_file and _is_xacro(self.srdf_file) else files

    def all_packages(self, arguments: Namespace) -> dict[str, str]:
        """Return the folders of packages, of both sides and of this one; those in the repository as of its revision."""
        packages = {**packages_of(arguments), **self.packages}
        if self.tree is None:
            return packages
        found = {name: str(folder) for name, folder in self.tree.packages().items()}
        return {**found, **{name: str(self.tree.folder(folder)) for name, folder in packages.items()}}

    @property
    def has_semantic(self) -> bool:
        return not self.is_urdf or self.srdf is not None


def parse_side(name: str, word: str, arguments: Namespace, tree: GitTree | None = None) -> Side:
    """Return the robot of one side with its own settings; UsageError for settings that it cannot have.

    `tree` has the files of the revision in which it is read, None for the files as they are.
    """
    values = vars(arguments)
    assignments: list[str] = values[name]
    variant: str | None = values[f"{name}_variant"]
    srdf: str | None = values[f"{name}_srdf"]
    require_file(f"--{name}-srdf", srdf)
    if word.lower().endswith((".srdf", ".srdf.xacro")):
        raise UsageError(f"'{word}' is an SRDF; pass it with its robot: --{name}-srdf {word}")
    packages = parse_packages(values[f"{name}_package"], f"--{name}-package")
    text = read_unseekable(word)
    file = word if tree is None else str(tree.path(word))
    side = Side(word, file, assignments, variant, srdf, packages, text, is_xml(file, text), tree)
    if side.is_urdf and (variant or (assignments and not side.parameter_files)):
        raise UsageError(f"'{word}' has no {'variants' if variant else 'parameters'}")
    if srdf and not side.is_urdf:
        raise UsageError(f"--{name}-srdf goes with a URDF; '{word}' has 'semantic' for it")
    return side


def share_out(common: Sequence[str], sides: Sequence[Side], arguments: Namespace) -> list[list[str]]:
    """Return for each side the common settings of parameters that it has, and those that neither side has.

    UsageError for a parameter or variant if both sides are URDFs.
    """
    if common and not any(side.parameter_files for side in sides):
        raise UsageError(f"nothing takes '{common[0]}': a URDF has no parameters")
    if arguments.variant and all(side.is_urdf for side in sides):
        raise UsageError(f"nothing takes '--variant {arguments.variant}': a URDF has no variants")
    is_unknown = any(side.text is not None and not side.is_urdf for side in sides)  # a spec that can be read only once
    if not common or is_unknown or len({(side.file, side.srdf) for side in sides}) == 1:
        return [list(common) for _ in sides]
    from linkforge_compile.pipeline import parameters_of

    outside = arguments.allow_outside
    names: list[set[str]] = []
    for side in sides:
        packages = side.all_packages(arguments)
        listings = (parameters_of(file, packages=packages, allow_outside=outside)[0] for file in side.parameter_files)
        names.append({one.name for listing in listings if listing for one in listing.parameters})
    known = set().union(*names)
    return [[pair for pair in common if (name := name_set_by(pair)) in own or name not in known] for own in names]


def load(side: Side, common: Iterable[str], arguments: Namespace) -> tuple[Robot | None, Sequence[Diagnostic]]:
    """Return the robot of a side, None if it cannot be read, and its errors."""
    own = Namespace(**vars(arguments))
    own.parameters = [*(pair for pair in common if name_set_by(pair) not in side.parameters), *side.assignments]
    own.variant = side.variant or arguments.variant
    packages = side.all_packages(arguments)
    own.packages = [f"{name}={folder}" for name, folder in packages.items()]
    faults: list[Diagnostic] = []
    if side.is_urdf:
        from linkforge_compile.importing import import_urdf
        from linkforge_compile.pipeline import compile_text

        name = STDIN if side.file == "-" else side.file
        imported = import_urdf(
            name,
            srdf=side.srdf_file,
            arguments=own.parameters if side.parameter_files else (),
            packages=packages,
            allow_outside=arguments.allow_outside,
            text=side.text,
        )
        faults += [*errors_of(imported.diagnostics), *imported.losses]
        if errors_of(faults) or imported.text is None:
            return None, _as_in_git(faults, side.tree)
        compilation = compile_text(imported.text, name=name, folder=Path(side.file).parent)
    else:
        own.parameters = _with_files_of(side, own.parameters, packages, arguments)
        compilation = compile_spec(side.file, [], own, text=side.text)
    faults += errors_of(compilation.diagnostics)
    return compilation.robot, _as_in_git(faults, side.tree)


def _with_files_of(
    side: Side, pairs: Sequence[str], packages: Mapping[str, str], arguments: Namespace
) -> Sequence[str]:
    """Return settings of parameters in which a value of type `file` is the file in the revision of a side."""
    if side.tree is None or not pairs:
        return pairs
    from linkforge_compile.pipeline import parameters_of

    listing, _ = parameters_of(side.file, packages=packages, allow_outside=arguments.allow_outside)
    files = {one.name for one in listing.parameters if one.type == "file"} if listing else set()
    mapped: list[str] = []
    for pair in pairs:
        start, equals, value = pair.partition("=")
        is_path = name_set_by(pair) in files and value and "://" not in value
        mapped.append(f"{start}{equals}{side.tree.path_as_typed(value)}" if is_path else pair)
    return mapped


def _as_in_git(diagnostics: Sequence[Diagnostic], tree: GitTree | None) -> Sequence[Diagnostic]:
    """Return diagnostics with the files of a revision named as git names them, not as the temporary copies."""
    if tree is None:
        return diagnostics

    def named(span: Span | None) -> Span | None:
        if span is None or span.file.path is None or (name := tree.shown(span.file.path)) is None:
            return span
        return span._replace(file=replace(span.file, name=name, path=None))

    return [
        replace(
            one,
            message=tree.in_words(one.message),
            span=named(one.span),
            notes=tuple(Note(tree.in_words(note.message), named(note.span)) for note in one.notes),
        )
        for one in diagnostics
    ]


def as_urdfs(
    sides: Sequence[Side], robots: tuple[Robot, Robot], arguments: Namespace
) -> tuple[tuple[Robot, Robot], str | None]:
    """Return the robots; a spec that is compared with a URDF becomes the URDF that it compiles to.

    Also return why that URDF cannot be read back, in which case the spec stays as written; None if it can.
    """
    is_spec = [not side.is_urdf for side in sides]
    if all(is_spec) or not any(is_spec):
        return robots, None
    from linkforge_compile.importing import as_read_back

    robot, faults = as_read_back(robots[is_spec.index(True)], gazebo=arguments.gazebo)
    if robot is None:
        return robots, faults[0].message
    return ((robot, robots[1]) if is_spec[0] else (robots[0], robot)), None


def _is_xacro(word: str) -> bool:
    from linkforge_compile.load import is_xacro

    return is_xacro(Path(word))


def in_common_folders(sides: Sequence[Side], robots: tuple[Robot, Robot], arguments: Namespace) -> tuple[Robot, Robot]:
    """Return the robots with the same absolute path for a file that both have, in a revision or in a package.

    That is its path for the robot after, with links resolved. The content of files is not compared.
    """
    from linkforge_compile.compare import with_folders

    before, after = sides
    packages_after, packages_before = after.all_packages(arguments), before.all_packages(arguments)
    real = {name: os.path.realpath(folder) for name, folder in packages_after.items()}
    are = {path: real[name] for name, folder in packages_after.items() for path in _spellings(folder)}
    common = {name: folder for name, folder in packages_before.items() if name in real}
    were = {path: real[name] for name, folder in common.items() for path in _spellings(folder)}
    if before.tree is not None:
        top, installed = before.tree.top, packages_in_environment()
        # A text may have the path of a link to the repository, and that of an installed package.
        were |= {str(before.tree.copy): str(top)}
        are |= {str(folder): str(top) for folder in Path(after.file).absolute().parents if _is_same(folder, top)}
        are |= {
            str(installed[name]): str(top / copy.relative_to(before.tree.copy))
            for name, copy in before.tree.packages().items()
        }
    return with_folders(robots[0], were), with_folders(robots[1], are)


def _spellings(folder: str) -> Iterator[str]:
    """Yield the paths that a text may have for the folder of a package."""
    absolute = Path(folder).absolute()
    yield from map(str, (absolute, as_walked(absolute), os.path.realpath(folder)))


def _is_same(folder: Path, other: Path) -> bool:
    return os.path.realpath(folder) == str(other)
