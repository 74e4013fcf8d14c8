"""`linkforge compile`: compiles a spec to standard output or to files, or several specs into a folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linkforge_compile.cli import UsageError
from linkforge_compile.cli.build import Build, BuildRequest, compile_request, deliver, render_request
from linkforge_compile.cli.options import (
    add_format_options,
    add_spec_options,
    packages_of,
    refuse_options_of_other_formats,
    require_one_spec,
    split_assignments,
)
from linkforge_compile.cli.reports import add_report_options, add_strict_option, progress
from linkforge_compile.cli.specs import SpecReport, find_parts, find_specs_of, is_folder
from linkforge_compile.cli.targets import (
    Targets,
    add_target_options,
    is_folder_of_outputs,
    name_of,
    refuse_formats_as_specs,
    targets_of,
    targets_of_documents,
)
from linkforge_compile.diagnostics.codes.modules import PARAMETER_NOT_SET
from linkforge_compile.diagnostics.codes.schema import MISSING_NAME

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection, Sequence

    from linkforge_compile.formats.user_templates import TemplateFolder

_EXAMPLES = """\
examples:
  linkforge compile arm.robot.yaml                      URDF to standard output
  linkforge compile arm.robot.yaml -o build/            build/arm.urdf, and build/arm.srdf if it has `semantic`
  linkforge compile arm.robot.yaml -o arm.urdf          one file
  linkforge compile arm.robot.yaml -o build/ --format urdf --format mjcf     formats from `linkforge formats`
  linkforge compile arm.robot.yaml --format moveit -o src/                   src/arm_moveit_config/config/
  linkforge compile arm.robot.yaml --format moveit -o src/my_moveit_config   src/my_moveit_config/config/
  linkforge compile arm.robot.yaml -p reach=0.7m        with a parameter; reach:=0.7m is the same
  linkforge compile arm.robot.yaml --gazebo classic     with sensors for Gazebo Classic
  linkforge compile arm.robot.yaml --variant sim        with the values of one of its variants
  linkforge compile arm.robot.yaml --variant sim --variant lab -o build/    build/arm_sim.urdf and build/arm_lab.urdf
  linkforge compile arm.robot.yaml --variant sim+lab    with the values of two variants; the last one has precedence
  linkforge compile arm.robot.yaml -o build/ --source-map   and the source of each line, in build/arm.urdf.map.json
  linkforge compile arm.robot.yaml -o urdf/ --check     write nothing; fail if urdf/arm.urdf is out of date
  linkforge compile arm.robot.yaml -o arm.urdf --depfile arm.urdf.d     and its dependencies, for Make and Ninja
  linkforge compile - < arm.robot.yaml                  from standard input
  linkforge compile robots/*.robot.yaml -o build/       several specs, or every spec below a folder: robots/ -o build/
  linkforge compile arm.robot.yaml --template docs/templates -o docs/     docs/joints.md, of docs/templates/joints.md.j2

--template FOLDER writes NAME for each Jinja2 template NAME.j2 at the top of FOLDER, instead of URDF and SRDF. With
--format or -o FILE for a format, or if FOLDER has no such template, the formats are written, and templates in a folder
of FOLDER with the name of a format, FOLDER/urdf/, replace linkforge's own. docs/templates.md describes their data.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = "linkforge compile [options] SPEC ... [NAME:=VALUE ...]"
    parser.epilog = _EXAMPLES
    add_build_arguments(parser, "specs, NAME.robot.yaml, or folders; - for standard input")
    parser.add_argument(
        "--check", action="store_true", help="write nothing, and fail if a file differs from what the spec compiles to"
    )


def add_build_arguments(parser: argparse.ArgumentParser, specs_help: str) -> None:
    """Add the arguments that `compile` and `watch` share."""
    parser.add_argument("words", metavar="SPEC", nargs="+", help=specs_help)
    add_target_options(parser)
    parser.add_argument(
        "--source-map",
        action="store_true",
        help="write FILE.map.json beside each file, from which `linkforge where FILE:LINE` finds the source of a line",
    )
    parser.add_argument(
        "--template",
        metavar="FOLDER",
        help="render the Jinja2 templates NAME.j2 in FOLDER, instead of URDF and SRDF",
    )
    parser.add_argument(
        "--depfile",
        metavar="FILE",
        help="write the dependencies of the output as a Make rule, for build systems; - for standard output",
    )
    parser.add_argument(
        "--installed-in",
        metavar="[FORMAT=]FOLDER",
        action="append",
        default=[],
        help="the final folder of the outputs, from which relative paths of meshes start (default: that of -o); "
        "repeat it for another format, such as sdf=share/arm/sdf",
    )
    add_spec_options(parser, variants_help="repeat it for others, each with outputs NAME_VARIANT in the folder of -o")
    add_format_options(parser)
    add_report_options(parser)
    add_strict_option(parser)


def run(arguments: argparse.Namespace) -> int:
    words, assignments = split_assignments(arguments.words)
    refuse_formats_as_specs(words, "--format")
    arguments.variants = list(dict.fromkeys(arguments.variants))
    if len(words) == 1 and not is_folder(words[0]) and len(arguments.variants) < 2:
        request = parse_request(arguments)
        return deliver([_build(request, arguments)], arguments)
    found = find_specs_of(_require_specs(words), arguments)
    requests = _parse_several(found.specs, assignments, arguments)
    builds = [_build(request, arguments) for request in progress(requests, "compiled", arguments)]
    parts = _parts_in_folders(builds, found.in_folders)
    _refuse_clashes([request for request in requests if request.spec not in parts])
    return deliver([build for build in builds if build.spec not in parts], arguments, found.faults)


def parse_request(arguments: argparse.Namespace) -> BuildRequest:
    """Return what to build of one spec; UsageError for options that contradict each other."""
    specs, assignments = split_assignments(arguments.words)
    refuse_formats_as_specs(specs, "--format")
    if len(arguments.variants) > 1:
        raise UsageError(f"--variant may be given once, found {' and '.join(arguments.variants)}")
    variant = next(iter(arguments.variants), None)
    return _parse_request(require_one_spec(specs), variant, assignments, arguments)


def _parse_several(specs: Sequence[str], assignments: list[str], arguments: argparse.Namespace) -> list[BuildRequest]:
    """Return what to build of each spec in each variant; UsageError for options that need a single spec."""
    variants = arguments.variants or [None]
    if len(arguments.outputs) != 1 or not is_folder_of_outputs(arguments.outputs[0], arguments.formats):
        found = " ".join(f"-o {output}" for output in arguments.outputs) or "none"
        several = "variants" if len(specs) == 1 and len(variants) > 1 else "specs"
        raise UsageError(f"-o takes one folder for the outputs of several {several}, found {found}")
    if arguments.name is not None and len(specs) > 1:
        raise UsageError(f"--name is for the outputs of one spec, found {len(specs)} specs")
    if len(variants) > 1:
        if "-" in specs:
            raise UsageError("several --variant take files, not standard input, which can be read once")
        if wrong := next((name for name in variants if name and not _may_be_in_file_name(name)), None):
            raise UsageError(f"several --variant are part of the names of files, which '{wrong}' cannot be")
    return [_parse_request(spec, variant, assignments, arguments) for spec in specs for variant in variants]


def _may_be_in_file_name(variant: str) -> bool:
    return not variant.startswith(".") and not {"/", "\\"}.intersection(variant)


def _refuse_clashes(requests: Sequence[BuildRequest]) -> None:
    """UsageError if two builds would have the same output, also where case does not distinguish files."""
    names: dict[str, str] = {}
    for request in requests:
        name = f"'{request.spec}'" + (f" with variant '{request.variant}'" if request.variant else "")
        for path in request.targets.paths.values():
            key = str(path).casefold()
            if key in names:
                both = f"that of {names[key]} and of {name}"
                raise UsageError(f"'{path}' would be {both}; rename one, or compile it into another folder")
            names[key] = name


def _parse_request(
    spec: str, variant: str | None, assignments: list[str], arguments: argparse.Namespace
) -> BuildRequest:
    templates = None if arguments.template is None else _template_folder(arguments)
    targets = _targets(_name(spec, variant, arguments), templates, arguments)
    if not targets.are_documents:  # templates of documents see every format
        refuse_options_of_other_formats(arguments, targets.formats, "--format")
    if arguments.source_map:
        targets.require_files("--source-map", "writes its map beside the output")
        if templates is not None:
            raise UsageError("--source-map cannot be combined with --template")
    if arguments.check:
        targets.require_files("--check", "compares with files")
    if arguments.depfile is not None:
        targets.require_files("--depfile", "lists what files are made from")
        if arguments.check:
            raise UsageError("--check writes nothing, so there is no --depfile with it")
    return BuildRequest(spec, assignments, targets, templates, variant)


def _build(request: BuildRequest, arguments: argparse.Namespace) -> Build:
    return render_request(request, compile_request(request, arguments), arguments)


def _require_specs(words: list[str]) -> list[str]:
    """Return words that may be specs; UsageError for those that are a mistake, or for none."""
    if not words:
        raise UsageError("takes one spec or more, found none")
    if "" in words:
        raise UsageError("takes specs, found '': is a variable of the shell empty?")
    # A file may have such a name.
    if assignment := next((word for word in words if "=" in word and not Path(word).exists()), None):
        raise UsageError(f"there is no spec '{assignment}'; write '-p {assignment}' to set a parameter")
    return words


def _parts_in_folders(builds: Sequence[Build], in_folders: Collection[str]) -> frozenset[str]:
    """Return the specs found in folders that are modules of others and cannot be compiled by themselves."""
    reports = {build.spec: SpecReport(build.diagnostics, build.sources) for build in builds}
    return find_parts(reports, (MISSING_NAME, PARAMETER_NOT_SET)).intersection(in_folders)


def _template_folder(arguments: argparse.Namespace) -> TemplateFolder:
    from linkforge_compile.formats.user_templates import TemplateFolder

    folder = arguments.template
    if not folder:
        raise UsageError("--template takes a folder, found '': is a variable of the shell empty?")
    packages = map(Path, packages_of(arguments).values())
    try:
        templates = TemplateFolder(folder, packages=packages, allow_outside=arguments.allow_outside)
        templates.require_templates()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise UsageError(f"--template takes a folder of templates, found '{folder}': {reason}") from None
    return templates


def _name(spec: str, variant: str | None, arguments: argparse.Namespace) -> str:
    """Return the name of the outputs of a spec in a folder; that of the variant is part of it if there are several."""
    if arguments.name is None:
        name = name_of(spec)
    else:
        name = arguments.name
        if not _may_be_name(name):
            raise UsageError(f"--name takes the name of files without their ending, found '{name}'")
        if len(arguments.outputs) != 1 or not is_folder_of_outputs(arguments.outputs[0], arguments.formats):
            raise UsageError("--name is for the files in a folder, so it takes -o FOLDER/")
    return f"{name}_{variant}" if variant and len(arguments.variants) > 1 else name


def _may_be_name(name: str) -> bool:
    """Whether a name is that of a file in a folder, or below it."""
    return bool(name) and not name.endswith("/") and not Path(name).is_absolute() and ".." not in Path(name).parts


def _targets(name: str, templates: TemplateFolder | None, arguments: argparse.Namespace) -> Targets:
    if templates is not None and templates.documents and not arguments.formats:
        documents = targets_of_documents(templates.documents, arguments.outputs)
        if documents is not None:
            return documents
    return targets_of(name, arguments.outputs, arguments.formats)
