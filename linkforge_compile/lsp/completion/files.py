"""Complete the paths of files and packages, within the folders that a spec may read."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.items import KNOWN, LIKELY, REQUIRED, Kind, Offer
from linkforge_compile.paths import find_package, follow, names_in, packages_in_environment
from linkforge_compile.roots import Roots, as_walked, is_folder, package_name
from linkforge_compile.syntax import YamlScalar

_PACKAGE = "package://"
_SPECS, _MESHES = (".yaml", ".yml"), (".stl", ".dae", ".obj", ".ply", ".glb", ".gltf")
_ENDINGS = {
    "use": (".robot.yaml", ".urdf", ".xacro"),
    "include": _SPECS,
    "data": _SPECS,
    "srdf": (".srdf", ".xacro"),
    "mesh": _MESHES,
    "texture": (".png", ".jpg", ".jpeg", ".tga", ".bmp"),
}
"""The endings of the files that a key names."""


def names_file(context: Context) -> bool:
    """Whether the value at the position is a path."""
    return any(branch.schema.get("title") in ("a file name", "a folder") for branch in context.branches)


def offer_files(context: Context, text: str, endings: tuple[str, ...] = ()) -> list[Offer]:
    """Return the files and folders that go on with a path, or the packages; `text` is the path up to the position."""
    roots = Roots.around(context.document.path, context.settings.packages_by_name.values())
    start, segment = text.rpartition("/")[::2]
    begin = context.column - len(segment)
    end = context.column + len(_rest_of_segment(context))
    if start + "/" == _PACKAGE:
        names = sorted(_packages(context, roots))
        return [Offer(f"{name}/", f"{name}/", Kind.Module, LIKELY, "package", begin=begin, end=end) for name in names]
    folder = _folder(context, start, roots, is_absolute=text.startswith("/"))
    if folder is None or not roots.hold(folder):
        return []
    offers = [_offer(name, folder, begin, end) for name in _listed(folder, context.document.path, roots, endings)]
    package = Offer(_PACKAGE, _PACKAGE, Kind.Folder, KNOWN, "a file in a package", begin=begin)
    is_include = context.cursor.path[:1] == ("include",)  # which takes no package
    return offers if start or is_include else [*offers, package]


def endings_at(context: Context) -> tuple[str, ...]:
    """Return the endings of the files that the key around the position names; none for any."""
    keys = [key for key in context.cursor.path if key in _ENDINGS]
    return _ENDINGS[str(keys[-1])] if keys else ()


def _offer(name: str, folder: Path, begin: int, end: int) -> Offer:
    if is_folder(folder / name):
        return Offer(f"{name}/", f"{name}/", Kind.Folder, LIKELY, begin=begin, end=end)
    return Offer(name, name, Kind.File, REQUIRED, begin=begin, end=end)


def _rest_of_segment(context: Context) -> str:
    """Return what follows the position in its word up to the next slash."""
    word = context.cursor.word
    return context.line[context.column - 1 : word.end_column - 1].partition("/")[0]


def _folder(context: Context, start: str, roots: Roots, *, is_absolute: bool) -> Path | None:
    """Return the folder that the beginning of a path leads to."""
    own = context.document.path.parent
    if not start.startswith(_PACKAGE):
        return Path(start or "/") if is_absolute else follow(own, start)
    name, _, rest = start.removeprefix(_PACKAGE).partition("/")
    found = find_package(name, _declared(context), own, roots)
    return follow(found, rest) if found else None


def _listed(folder: Path, own: Path, roots: Roots, endings: tuple[str, ...]) -> Iterable[str]:
    """Yield the folders and files in a folder, without the open file itself."""
    for name in sorted(names_in(folder)):
        path = folder / name
        is_shown = is_folder(path) or not endings or name.lower().endswith(endings)
        if is_shown and not name.startswith(".") and path != own and roots.hold(path):
            yield name


def _declared(context: Context) -> dict[str, Path]:
    """Return the folders of packages that the user or the file declares."""
    folder = context.document.path.parent
    written = {
        name: follow(folder, value.text)
        for _, name, value in context.sections("packages")
        if isinstance(value, YamlScalar)
    }
    return {**written, **context.settings.packages_by_name}


def _packages(context: Context, roots: Roots) -> set[str]:
    folder = as_walked(context.document.path.parent)
    own = {package_name(one, roots) for one in (folder, *folder.parents)} - {None}
    return {*_declared(context), *packages_in_environment(), *map(str, own)}
