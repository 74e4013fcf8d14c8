"""Compile or check a spec, a file or a text; this is what the command and Python programs call."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.analysis import Packages, Parameters, Settings, analyse_path, analyse_source
from linkforge_compile.compilation import Compilation, CompileError
from linkforge_compile.diagnostics import BeyondLimitError, Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.modules import VARIANTS_BEYOND_LIMIT
from linkforge_compile.diagnostics.suggest import suggestion_budget
from linkforge_compile.expand import CliArgument, Unset
from linkforge_compile.formats import NO_OPTIONS, Options, formats_or_default
from linkforge_compile.formats.urdf import Gazebo
from linkforge_compile.limits import Budget
from linkforge_compile.load import is_xacro

if TYPE_CHECKING:
    from linkforge_compile.listing import Listing

__all__ = [
    "CliArgument",
    "Compilation",
    "CompileError",
    "Packages",
    "Parameters",
    "Settings",
    "check_file",
    "check_text",
    "check_variants",
    "compile_file",
    "compile_text",
    "parameters_of",
]


def compile_file(
    path: str | Path,
    *,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    formats: Iterable[str] = (),
    options: Options = NO_OPTIONS,
    output: str | Path | None = None,
    allow_outside: bool = False,
) -> Compilation:
    """Compile a spec file; a required parameter without a value is an error.

    `variant` is the one of the file's `variants` that sets what `parameters` do not, before the defaults, or several
    of them, `a+b`, of which the last one decides. `gazebo` is the simulator, Gazebo Sim or Classic, whose limits are
    reported; give it to `render_urdf` as well. `formats` are those whose limits are reported, URDF and SRDF if there
    are none, and `options` are theirs, such as `{"base": "free"}`; give these to `render` as well. `output` is the
    folder of the URDF, from which relative paths of meshes must lead to a file; None if it is not known.
    What a spec names is read in its own package or repository (else its folder), in `packages`, in those of
    AMENT_PREFIX_PATH and ROS_PACKAGE_PATH, and where `parameters` name a file; `allow_outside` lets it read anything.

    Raises:
        ValueError: for an unknown format or option, and another `gazebo` than `gz` or `classic`.

    """
    options, formats = {"gazebo": gazebo, **options}, tuple(formats)
    folders = {} if output is None else {_format_with_paths(formats): Path(output)}
    settings = Settings(parameters, packages, variant, options, Unset.ERROR, folders, allow_outside, formats)
    return compile_path(path, settings)


def compile_text(
    text: str,
    *,
    name: str = "<text>",
    folder: str | Path | None = None,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    formats: Iterable[str] = (),
    options: Options = NO_OPTIONS,
    allow_outside: bool = False,
) -> Compilation:
    """Compile a spec given as text; `name` is its name in diagnostics, `folder` is where relative paths start."""
    options, formats = {"gazebo": gazebo, **options}, tuple(formats)
    settings = Settings(parameters, packages, variant, options, Unset.ERROR, {}, allow_outside, formats)
    return compile_source(text, name, folder, settings)


def check_file(
    path: str | Path,
    *,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    formats: Iterable[str] = (),
    options: Options = NO_OPTIONS,
    allow_outside: bool = False,
) -> Compilation:
    """Report what is wrong with a spec file; what depends on a required parameter without a value is not checked."""
    options, formats = {"gazebo": gazebo, **options}, tuple(formats)
    settings = Settings(parameters, packages, variant, options, Unset.NOTE, {}, allow_outside, formats)
    return compile_path(path, settings)


def check_text(
    text: str,
    *,
    name: str = "<text>",
    folder: str | Path | None = None,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    variant: str | None = None,
    gazebo: Gazebo = "gz",
    formats: Iterable[str] = (),
    options: Options = NO_OPTIONS,
    allow_outside: bool = False,
) -> Compilation:
    """Report what is wrong with a spec given as text, as `check_file` does."""
    options, formats = {"gazebo": gazebo, **options}, tuple(formats)
    settings = Settings(parameters, packages, variant, options, Unset.NOTE, {}, allow_outside, formats)
    return compile_source(text, name, folder, settings)


def check_variants(
    path: str | Path,
    *,
    parameters: Parameters | None = None,
    packages: Packages | None = None,
    gazebo: Gazebo = "gz",
    allow_outside: bool = False,
) -> dict[str | None, Compilation | None]:
    """Check a spec file with its defaults (None) and each of its variants, by name; None for those not checked.

    Together they have the budget of five compiles: the one that exceeds it is the last that is checked, with LF3304.
    """
    settings = Settings(parameters, packages, None, {"gazebo": gazebo}, Unset.NOTE, allow_outside=allow_outside)
    return check_each_variant(Path(path), settings)


def check_each_variant(file: Path, settings: Settings) -> dict[str | None, Compilation | None]:
    """Check a spec file as `check_variants` does, with settings."""
    from linkforge_compile.expand.arguments import names_of_variants

    whole = Budget(times=5, code=VARIANTS_BEYOND_LIMIT)
    settings = settings._replace(whole=whole)
    names = (None, *names_of_variants(file, settings.loader(file)))
    return {name: None if whole.is_spent else compile_path(file, settings._replace(variant=name)) for name in names}


@suggestion_budget()
def parameters_of(
    path: str | Path, *, packages: Packages | None = None, allow_outside: bool = False
) -> tuple[Listing | None, tuple[Diagnostic, ...]]:
    """List the parameters and variants of a spec file, None if it cannot be read, and what is wrong with them.

    Those of a xacro file are the arguments that it and its includes declare; a URDF declares none.
    """
    from linkforge_compile.listing import list_parameters

    sink, loader = Diagnostics(), Settings(packages=packages, allow_outside=allow_outside).loader(Path(path))
    listing = None
    try:
        if is_xacro(Path(path)):
            from linkforge_compile.listing import list_arguments

            listing = list_arguments(Path(path), loader, sink)
        elif spec := loader.open(Path(path), sink):
            listing = list_parameters(spec, loader, sink)
    except BeyondLimitError as beyond:
        sink.abort(beyond)
    return listing, sink.sorted()


def _format_with_paths(formats: Sequence[str]) -> str:
    """Return the first format with relative paths, URDF if none has."""
    return next((one.name for one in formats_or_default(formats) if one.has_relative_paths), "urdf")


def compile_path(path: str | Path, settings: Settings) -> Compilation:
    """Compile a spec file with settings."""
    return analyse_path(path, settings).compilation


def compile_source(text: str, name: str, folder: str | Path | None, settings: Settings) -> Compilation:
    """Compile a spec given as text with settings."""
    return analyse_source(text, name, folder, settings).compilation
