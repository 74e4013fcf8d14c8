"""Where a compile writes: from `-o` and `--format` to a file for each format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.cli.exits import UsageError

if TYPE_CHECKING:
    import argparse

FORMATS = ("urdf", "srdf")
_FILE_ENDINGS = (".urdf", ".srdf", ".xml")
_SPEC_ENDINGS = (".yaml", ".yml")
_STANDARD_OUTPUT = "-"


class Targets(NamedTuple):
    """Where each format goes, by name, None for standard output; `srdf` may be left out unless it was asked for.

    In place of formats, `are_documents`, they may be the documents of a folder of templates.
    """

    paths: Mapping[str, Path | None]
    is_srdf_asked_for: bool = True
    are_documents: bool = False

    @property
    def folder(self) -> Path | None:
        """The folder that the URDF is for, None where that is not known."""
        urdf = self.paths.get("urdf")
        return urdf.parent if urdf else None

    def without_srdf(self) -> Targets:
        paths = {format_: path for format_, path in self.paths.items() if format_ != "srdf"}
        return self._replace(paths=MappingProxyType(paths))

    def require_files(self, option: str, why: str) -> None:
        """Refuse an option that has no meaning where the output is no file."""
        if any(path is None or (path.exists() and not path.is_file()) for path in self.paths.values()):
            raise UsageError(f"{option} {why}, so it takes -o with a folder or a file")


def add_target_options(parser: argparse.ArgumentParser) -> None:
    add_output_option(parser)
    parser.add_argument("--format", choices=FORMATS, help="only this one (standard output: urdf unless said)")


def add_output_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "-o",
        "--output",
        metavar="PATH",
        dest="outputs",
        action="append",
        default=[],
        help="a folder for NAME.urdf and NAME.srdf, or a file that ends in .urdf, .srdf or .xml; "
        "once more for the file of the other format",
    )


def targets_of(spec: str, outputs: Sequence[str], chosen: str | None) -> Targets:
    """Return where each format of a spec goes; UsageError for outputs that cannot be meant together."""
    if "" in outputs:
        raise UsageError("-o takes a file or a folder, found '': is a variable of the shell empty?")
    if not outputs or (len(outputs) == 1 and file_to_write(outputs[0]) is None):
        return Targets({chosen or "urdf": None})
    if len(outputs) > 1:
        return Targets(_several(outputs, chosen))
    (output,) = outputs
    if _is_file(output):
        return Targets({_format_of_file(output, chosen): Path(output)})
    folder, name = Path(output), name_of(spec)
    paths = {format_: folder / f"{name}.{format_}" for format_ in FORMATS if chosen in (None, format_)}
    return Targets(paths, is_srdf_asked_for=chosen == "srdf")


def targets_of_documents(names: Sequence[str], outputs: Sequence[str]) -> Targets | None:
    """Return where the documents of a folder of templates go; None where `outputs` name files of URDF or SRDF.

    Raises:
        UsageError: for several documents that would go to standard output.

    """
    if not outputs or (len(outputs) == 1 and file_to_write(outputs[0]) is None):
        if len(names) > 1:
            found = f"found {len(names)}: {', '.join(names)}"
            raise UsageError(f"standard output takes one document of --template, {found}; write -o FOLDER/")
        return Targets({names[0]: None}, are_documents=True)
    if len(outputs) == len(names) == 1 and _is_document(outputs[0], names[0]):
        return Targets({names[0]: Path(outputs[0])}, are_documents=True)
    if len(outputs) > 1 or not outputs[0] or _is_file(outputs[0]):
        return None
    return Targets({name: Path(outputs[0], name) for name in names}, are_documents=True)


def _is_document(output: str, name: str) -> bool:
    """Whether `-o` names the file of a document: one with an ending, that of a format if the document has it."""
    path = Path(output)
    is_folder = output.endswith(("/", "\\")) or path.is_dir()
    is_of_format = path.suffix in {".urdf", ".srdf"} and path.suffix != Path(name).suffix
    return not is_folder and bool(path.suffix) and not is_of_format


def file_to_write(output: str | None) -> Path | None:
    """Return the file that an option names to write, None for standard output: nothing, or `-`."""
    return None if output is None or output == _STANDARD_OUTPUT else Path(output)


def imported_spec(robot: str, output: str | None) -> Path | None:
    """Return where an imported spec goes: a file, NAME.robot.yaml in a folder, None for standard output."""
    path = file_to_write(output)
    if output is None or path is None:
        return None
    return path if _is_file(output, _SPEC_ENDINGS) else path / f"{name_of(robot)}.robot.yaml"


def name_of(spec: str) -> str:
    """Return what the files of a spec are named after: arm for arm.robot.yaml, arm.xml and arm.urdf.xacro."""
    if spec == "-":
        return "robot"
    name = Path(spec).name
    for ending in (".yaml", ".yml", ".robot", ".xacro", ".xml", ".urdf"):
        name = name.removesuffix(ending)
    return name


def _several(outputs: Sequence[str], chosen: str | None) -> dict[str, Path | None]:
    paths: dict[str, Path | None] = {}
    for output in outputs:
        if file_to_write(output) is None:
            raise UsageError("-o - is standard output, which takes one format; leave the other -o out")
        if not _is_file(output):
            raise UsageError(f"-o takes several files, one a format, or one folder; found the folder '{output}'")
        format_ = _format_of_file(output, chosen)
        if format_ in paths:
            raise UsageError(f"'{paths[format_]}' and '{output}' would be the same {format_}; name one of them")
        paths[format_] = Path(output)
    return paths


def _format_of_file(output: str, chosen: str | None) -> str:
    other = "srdf" if chosen == "urdf" else "urdf"
    if chosen and Path(output).suffix == f".{other}":
        raise UsageError(f"--format {chosen} does not go into '{output}'")
    return chosen or ("srdf" if Path(output).suffix == ".srdf" else "urdf")


def _is_file(output: str, endings: Sequence[str] = _FILE_ENDINGS) -> bool:
    """Whether `-o` names a file: one with one of the endings, a device or a pipe; all else are folders.

    An ending that is neither is refused: `-o arm.robot.yaml` would else replace the spec, or make a folder of it.
    """
    path = Path(output)
    if output.endswith(("/", "\\")) or path.is_dir():
        return False
    if path.suffix and path.suffix not in endings:
        *others, last = endings
        raise UsageError(
            f"-o takes a folder, or a file that ends in {', '.join(others)} or {last}; found '{output}'"
            f" (for a folder of that name, write '{output}/')"
        )
    return bool(path.suffix) or (path.exists() and not path.is_file())
