"""The Jinja2 environment of our own templates, their rendering, and what it has in common with that of a user's."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, cached_property
from pathlib import Path
from traceback import walk_tb
from typing import Any

import jinja2
import yaml
from jinja2 import (
    BaseLoader,
    Environment,
    FileSystemLoader,
    ModuleLoader,
    StrictUndefined,
    TemplateError,
    TemplateRuntimeError,
    TemplateSyntaxError,
    pass_eval_context,
)
from jinja2.nodes import EvalContext
from jinja2.runtime import Context, Undefined

from linkforge_compile.core.models.geometry import Color, Transform, Vector3
from linkforge_compile.formats.xml_text import NOTHING, Spellable, Xml, escaped, spelled
from linkforge_compile.resources import compiled_templates_folder, templates_folder
from linkforge_compile.units import number_text

_MADE_BY = "jinja2.txt"
"""The file in the folder of compiled templates that names the version of Jinja2 that compiled them."""


def is_xml(template: str | None) -> bool:
    """Whether a template writes XML, by its name."""
    return template is not None and template.endswith(xml_endings())


@cache
def xml_endings() -> tuple[str, ...]:
    """Return how the names of templates end that write XML: formats of XML are those with a `NAME/robot.xml.j2`."""
    formats = sorted(path.parent.name for path in templates_folder().glob("*/robot.xml.j2"))
    return (".xml.j2", *(f".{name}.j2" for name in formats))


@pass_eval_context
def finalize(context: EvalContext, value: Spellable | None) -> object:
    """Return a value as a template writes it: in XML as URDF spells it, escaped, elsewhere as Jinja2 does.

    Raises:
        TemplateRuntimeError: for what XML has no text for: None, or a part of a robot.

    """
    if not context.autoescape or hasattr(value, "__html__"):
        return value
    if value is None:
        raise TemplateRuntimeError("this is None, which has no text in XML; test it with '{% if … is not none %}'")
    try:
        return Xml(escaped(spelled(value)))
    except (TypeError, ValueError):
        raise TemplateRuntimeError(f"{kind_of(value)} has no text in XML; write one of its fields") from None


def kind_of(value: object) -> str:
    """Return the kind of a value with its article, for a message."""
    name = type(value).__name__
    return f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"


def format_vector(values: Iterable[float]) -> str:
    """Return numbers as URDF writes a vector: with a space between them."""
    return " ".join(map(number_text, values))


def format_yaml(value: object) -> str:
    """Return a value as YAML on one line: text in quotes where it needs them, 1e-05 as 1.0e-05.

    Raises:
        TemplateRuntimeError: for what is no text, number, boolean, None, list, map, vector or pose.

    """
    import yaml

    text: str = yaml.dump(
        _plain(value), Dumper=_dumper(), default_flow_style=True, allow_unicode=True, sort_keys=False, width=math.inf
    )
    return text.removesuffix("\n").removesuffix("\n...")


@cache
def _dumper() -> type[yaml.SafeDumper]:
    """Return a dumper that writes line breaks as escapes, and quotes what readers other than PyYAML resolve."""
    import yaml

    class Dumper(yaml.SafeDumper):
        pass

    def text_node(dumper: Dumper, text: str) -> yaml.ScalarNode:
        is_on_one_line = text.splitlines() in ([], [text])
        style = '"' if not is_on_one_line else "'" if _NOT_PLAIN.fullmatch(text) else None
        return dumper.represent_scalar("tag:yaml.org,2002:str", text, style)

    Dumper.add_representer(str, text_node)
    return Dumper


_NOT_PLAIN = re.compile(
    r"""y|n|yes|no|on|off
    |[-+]?(\.\d+|\d+(\.\d*)?)(e[-+]?\d+)?
    |0o[0-7]+
    |[-+]?0x[0-9a-f]*\.?[0-9a-f]*(p[-+]?\d+)?
    |[-+]?\.?(inf|infinity|nan)""",
    re.IGNORECASE | re.VERBOSE,
)
"""Text that a reader of YAML 1.1, of the core schema of 1.2, or ROS 2 takes for a boolean or a number.

ROS 2 reads numbers with `strtoll` and `strtod`, for which `nan`, `infinity` and `0x1p3` are numbers.
"""


def _plain(value: object) -> object:
    """Return a value as one of the types that PyYAML knows: those of the model derive from them."""
    match value:
        case None | bool():
            return value
        case str() | int() | float():
            return next(kind(value) for kind in (str, int, float) if isinstance(value, kind))
        case Mapping():
            return {_plain(key): _plain(item) for key, item in value.items()}
        case Transform(xyz=xyz, rpy=rpy):
            return {"xyz": _plain(xyz), "rpy": _plain(rpy)}
        case Sequence() | Vector3() if not hasattr(value, "_fields"):
            return [_plain(item) for item in value]
    raise TemplateRuntimeError(f"{kind_of(value)} has no text in YAML; write its fields")


def place_attribute(value: object) -> Xml:
    """Return the attribute that says where a text was written, while a source map is made."""
    return getattr(value, "place", NOTHING)


def element_of(value: Spellable | None, tag: str) -> Xml:
    """Return an element with a text, and where that was written while a source map is made; nothing for None."""
    return NOTHING if value is None else Xml(f"<{tag}{place_attribute(value)}>{escaped(spelled(value))}</{tag}>")


FILTERS: dict[str, Callable[..., object]] = {
    "number": number_text,
    "vector": format_vector,
    "degrees": math.degrees,
    "to_yaml": format_yaml,
    "place": place_attribute,
    "element": element_of,
}
"""The filters that templates have in addition to Jinja2's own."""

OPTIONS: dict[str, Any] = {  # Any: the keyword arguments of Environment, each of its own type
    "autoescape": is_xml,
    "finalize": finalize,
    "undefined": StrictUndefined,
    "trim_blocks": True,
    "lstrip_blocks": True,
    "keep_trailing_newline": True,  # an included template ends its last line
    "auto_reload": False,
}
"""The options of every environment."""


@cache
def own_environment() -> Environment:
    """Return the environment of our own templates, compiled when the wheel was built where that is possible."""
    return make_environment(_compiled() or FileSystemLoader(templates_folder()))


def compile_templates(folder: Path) -> None:
    """Write our own templates into a folder as modules of Python, for `own_environment` to load."""
    make_environment(FileSystemLoader(templates_folder())).compile_templates(folder, zip=None, ignore_errors=False)
    (folder / _MADE_BY).write_text(f"{jinja2.__version__}\n", "utf-8")


def make_environment(loader: BaseLoader) -> Environment:
    """Return an environment of templates that are trusted."""
    environment = Environment(loader=loader, **OPTIONS)
    environment.filters.update(FILTERS)
    return environment


def _compiled() -> BaseLoader | None:
    """Return what loads compiled templates; None where there are none, or another Jinja2 has compiled them."""
    folder = compiled_templates_folder()
    try:
        made_by = (folder / _MADE_BY).read_text("utf-8").strip()
    except FileNotFoundError:
        return None
    return ModuleLoader(folder) if made_by == jinja2.__version__ else None


class TemplateFaultError(Exception):
    """A template of linkforge was changed and cannot be rendered; the message has its file, line and fault."""

    def __init__(self, path: Path, line: int, reason: str) -> None:
        super().__init__(
            f"{path}:{line}: {reason}; this template is a part of linkforge: mend it, or install linkforge again"
        )


def render_own(template: str, views: Mapping[str, object]) -> str:
    """Render one of our own templates and return its text, not laid out.

    Raises:
        RobotGeneratorError: for text that XML cannot hold.
        TemplateFaultError: for a template that was changed and cannot be rendered.

    """
    try:
        return own_environment().get_template(template).render(views)
    except TemplateSyntaxError as error:
        path = Path(error.filename or templates_folder() / template)
        raise TemplateFaultError(path, error.lineno, str(error.message)) from None
    except TemplateError as error:
        path, line = next(_places(error), (templates_folder() / template, 1))
        raise TemplateFaultError(path, line, str(error)) from None


def _places(error: BaseException) -> Iterator[tuple[Path, int]]:
    """Yield the lines of templates that led to an error, the innermost first."""
    steps = [(Path(frame.f_code.co_filename), line) for frame, line in walk_tb(error.__traceback__)]
    return ((path, line) for path, line in reversed(steps) if path.suffix == ".j2")


def require_text(value: object, count: Callable[[], None]) -> None:
    """Refuse a value without a text of its own, in a list or a map as well, each item of which is counted.

    Raises:
        TemplateRuntimeError: with what to write instead.
        UndefinedError: for an undefined name.

    """
    if isinstance(value, Mapping):
        _require_all((one for pair in value.items() for one in pair), count)
    elif isinstance(value, list | tuple) and not hasattr(value, "_fields"):
        _require_all(value, count)
    elif isinstance(value, Undefined):
        str(value)  # reports the name
    elif not _is_plain(value) and not isinstance(value, Vector3 | Transform | Color) and not hasattr(value, "__html__"):
        raise TemplateRuntimeError(_reason(value))


def _require_all(items: Iterable[object], count: Callable[[], None]) -> None:
    """Refuse what has no text in a list, where Python writes the repr of an object: a vector has none there."""
    for item in items:
        count()
        if isinstance(item, Vector3 | Transform | Color):
            raise TemplateRuntimeError(f"{kind_of(item)} has no text in a list; write '| join(\", \")'")
        require_text(item, count)


def _is_plain(value: object) -> bool:
    # A number or an array of NumPy has a text as well.
    return value is None or isinstance(value, str | int | float | complex) or hasattr(value, "ndim")


def _reason(value: object) -> str:
    if callable(value):
        name = getattr(value, "__name__", None) or getattr(value, "name", type(value).__name__)
        return f"'{name}' is not called, and has no text; write '{name}()'"
    if isinstance(value, set | frozenset):
        return "a set has no order, so the text would differ from run to run; write '| sort'"
    if isinstance(value, Iterable) and not hasattr(value, "_fields"):
        return f"{kind_of(value)} has no text; write '| list' or '| join(\", \")'"
    return f"{kind_of(value)} has no text; write one of its fields{', such as its name' * hasattr(value, 'name')}"


class DeferredView:
    """The view of a format, as a value in the context of templates."""

    def __init__(self, make: Callable[[], object]) -> None:
        self._make = make

    @cached_property
    def view(self) -> object:
        return self._make()


class ViewContext(Context):
    """Resolves the names that templates use, by the hook that Jinja2 has for this."""

    def resolve_or_missing(self, key: str) -> object:
        value = super().resolve_or_missing(key)
        return value.view if isinstance(value, DeferredView) else value
