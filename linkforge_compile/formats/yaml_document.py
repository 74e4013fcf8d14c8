"""YAML documents: rendered by a template, with the banner as a comment, and with a source map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import nullcontext

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.formats.format import Document, Format, Rendering, Templates
from linkforge_compile.formats.source_map import Origins, Segment, SourceMap, recording, split_origins


def render_yaml(format_: Format, template: str, robot: Robot, rendering: Rendering, name: str = "") -> Document:
    """Return the document that a template makes of a format's view, which is made here so that it notes origins.

    `template` is a path below the folder of the format, `name` that of the document. The template writes values by the
    filter `to_yaml`, and at the end of a line what `place` or `origin_of` return.

    Raises:
        TemplateError: for what is wrong with one of the user's templates.
        TemplateFaultError: for a packaged template that was changed and cannot be rendered.

    """
    head = [f"# {line.strip()}".rstrip() for line in (rendering.banner or "").splitlines()]
    with recording() if rendering.has_map else nullcontext() as origins:
        views = {"robot": robot, format_.name: format_.view(robot, rendering.options)}
        lines = [*head, *_text(f"{format_.name}/{template}", views, rendering.templates).splitlines()]
    if origins is None:
        return Document("".join(f"{line}\n" for line in lines), name)
    pairs = list(_without_origins(lines, origins))
    map_ = SourceMap((*(segments for _, segments in pairs), ()))
    return Document("".join(f"{line}\n" for line, _ in pairs), name, map_)


def _text(template: str, views: Mapping[str, object], templates: Templates) -> str:
    # Jinja2 takes 70 ms to import, and some commands render nothing.
    if templates is None:
        from linkforge_compile.formats.environment import render_own

        return render_own(template, views)
    from linkforge_compile.formats.user_templates import TemplateFolder

    return TemplateFolder.of(templates).text(template, views)


def _without_origins(lines: list[str], origins: Origins) -> Iterator[tuple[str, tuple[Segment, ...]]]:
    """Yield each line as it is written, and its segments; one without an origin has that of the line around it."""
    places = origins.places
    around: list[tuple[int, tuple[Segment, ...]]] = []
    for line in lines:
        text, segments = "", list[Segment]()
        for piece, number in split_origins(line):
            if number is not None:
                segments.append(Segment(len(text) + 1 if segments else 1, places[number]))
            text += piece
        depth = len(text) - len(text.lstrip())
        while around and around[-1][0] >= depth:
            around.pop()
        own = tuple(segments) or (around[-1][1] if around else ())
        around.append((depth, own[:1]))
        yield text, own
