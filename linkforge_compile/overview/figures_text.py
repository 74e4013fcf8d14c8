"""The figures of a robot as text, and as JSON has them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from math import floor, log10
from textwrap import wrap
from typing import TYPE_CHECKING

from linkforge_compile.core.models.joint import JointType
from linkforge_compile.overview.figures import Figures, Mass, MeshFile
from linkforge_compile.overview.joint_text import short
from linkforge_compile.source.characters import on_one_line

if TYPE_CHECKING:
    from linkforge_compile.listing import ListedParameter, Listing
    from linkforge_compile.overview.extent import Extent, Reach

WIDTH = 100
_LABEL = 16
_MOST_NAMES = 12
"""How many names of one kind are shown in text."""
_NEGLIGIBLE = 1e-9
"""A length below this is a rounding error [m]."""


def render_figures(figures: Figures, listing: Listing | None) -> Iterator[str]:
    """Yield a line, or several, for each figure that the robot has; `listing` has the parameters of its spec."""
    yield f"{figures.name}: {_count(figures.links, 'link')}, {_count(sum(figures.joints.values()), 'joint')}"
    yield ""
    rows = (_labeled(*row) for row in _motion_rows(figures))
    others = (_labeled(*row) for row in (*_part_rows(figures), *_source_rows(figures, listing)))
    # The names of files and plugins may come from an untrusted spec.
    yield from map(on_one_line, chain(chain.from_iterable(rows), _mesh_lines(figures.meshes), *others))


def _motion_rows(figures: Figures) -> Iterator[tuple[str, str]]:
    """Yield the figures of bodies and joints."""
    yield "joints", ", ".join(f"{figures.joints[kind]} {kind}" for kind in JointType if figures.joints.get(kind))
    follow = f"; {_count(figures.mimics, 'joint')} with mimic not counted" if figures.mimics else ""
    yield "freedom", f"{_count(figures.degrees_of_freedom, 'degree')} of freedom{follow}"
    yield from _mass_rows(figures.mass, figures.root)
    yield "reach", _reach_text(figures.reach)
    yield from _extent_rows(figures.extent)


def _part_rows(figures: Figures) -> Iterator[tuple[str, str]]:
    for label, parts in (
        ("sensors", figures.sensors),
        ("hardware", figures.hardware),
        ("controllers", figures.controllers),
    ):
        for number, one in enumerate(parts):
            about = f" of {_names(one.about)}" if one.about else ""
            yield "" if number else label, f"{one.name}: {one.kind}{about}"
    for group in figures.groups:
        yield "group", f"{group.name}: {', '.join(group.joints) or 'no joint that moves independently'}"
        if group.states:
            yield "", f"states {', '.join(group.states)}"
        if group.reach:
            yield "", f"reach {_reach_text(group.reach)}"
    for one in figures.end_effectors:
        yield "end effector", f"{one.name}: group {one.kind} on {one.about[0]}"


def _source_rows(figures: Figures, listing: Listing | None) -> Iterator[tuple[str, str]]:
    """Yield the figures of the spec itself."""
    if listing and listing.parameters:
        yield "parameters", ", ".join(map(_parameter_text, listing.parameters))
    if listing and listing.variants:
        yield "variants", ", ".join(listing.variants)
    if figures.modules:
        yield "modules", ", ".join(f"{name} ({_count(links, 'link')})" for name, links in figures.modules.items())


def _parameter_text(one: ListedParameter) -> str:
    default = one.default or '""'
    return f"{one.name} (required)" if one.is_required else f"{one.name} = {default}"


def _mass_rows(mass: Mass, root: str) -> Iterator[tuple[str, str]]:
    yield "mass", f"{short(mass.total)} kg" if mass.total else "none"
    if mass.links_without:
        yield "", f"without mass: {_names(mass.links_without)}"
    if mass.centre:
        yield "centre of mass", f"{_vector(mass.centre)} m in {root}, every joint at 0"


def _reach_text(reach: Reach) -> str:
    return f"at most {_lengths(reach.bound)[0]} m, {reach.link} from {reach.start}"


def _extent_rows(extent: Extent) -> Iterator[tuple[str, str]]:
    if extent.box:
        sides = " x ".join(_lengths(*extent.box.sides))
        corners = f"from {_vector(extent.box.low)} to {_vector(extent.box.high)}"
        yield "size", f"{sides} m, every joint at 0; {corners}"
    reasons: dict[str, list[str]] = {}
    for resource, reason in extent.left_out.items():
        reasons.setdefault(reason, []).append(resource)
    for reason, resources in reasons.items():
        yield "" if extent.box else "size", f"without {_count(len(resources), 'mesh')}: {reason}"


def _mesh_lines(meshes: Sequence[MeshFile]) -> Iterator[str]:
    """Yield the sum, and a line for each file that is as long as its name."""
    if not meshes:
        return
    total = sum(mesh.size or 0 for mesh in meshes)
    yield from _labeled("meshes", f"{_count(len(meshes), 'file')}, {total:,} bytes")
    sizes = ["missing" if mesh.size is None else f"{mesh.size:,}" for mesh in meshes]
    width = max(map(len, sizes))
    yield from (f"{'':{_LABEL}}{size:>{width}}  {mesh.resource}" for size, mesh in zip(sizes, meshes, strict=True))
    for reason in dict.fromkeys(mesh.missing for mesh in meshes if mesh.missing):
        yield from _labeled("", reason)


def _labeled(label: str, text: str) -> Iterator[str]:
    for line in wrap(text, WIDTH - _LABEL, break_long_words=False, break_on_hyphens=False) or [""]:
        yield f"{label:{_LABEL}}{line}".rstrip()
        label = ""


def _names(names: Sequence[str]) -> str:
    more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    return ", ".join(names[:_MOST_NAMES]) + more


def _vector(values: Iterable[float]) -> str:
    return f"[{', '.join(_lengths(*values))}]"


def _decimals(values: Sequence[float]) -> int:
    """Return the decimals that lengths keep: to a tenth of a millimetre, and below 1 cm four digits of the largest."""
    largest = max(map(abs, values), default=0.0)
    return 4 if largest >= 0.01 or largest < _NEGLIGIBLE else 3 - floor(log10(largest))


def _lengths(*values: float) -> list[str]:
    """Return lengths [m] that belong together, with the same last decimal."""
    decimals = _decimals(values)
    return [short(round(value, decimals) + 0.0) for value in values]


def _count(number: int, noun: str) -> str:
    plural = f"{noun}es" if noun.endswith("sh") else f"{noun}s"
    return f"{number or 'no'} {noun if number == 1 else plural}"


def figures_document(figures: Figures, listing: Listing | None) -> dict[str, object]:
    """Return the figures for tools, as JSON has them: numbers in SI units, None for what there is not."""
    parameters = {one.name: {"type": one.type, "default": one.default} for one in listing.parameters} if listing else {}
    variants = list(listing.variants) if listing else []
    fields = {name: _plain(value) for name, value in figures._asdict().items()}
    return {"version": 1, **fields, "parameters": parameters, "variants": variants}


def _plain(value: object) -> object:
    """Return a figure as JSON has it: a named tuple is an object by its fields."""
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return _plain(value._asdict())
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    return list(map(_plain, value)) if isinstance(value, list | tuple) else value
