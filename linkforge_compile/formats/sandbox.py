"""The sandbox of a user's templates: they read the robot, change and call nothing else, and take bounded work."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import PurePath
from typing import Any

from jinja2 import (
    BaseLoader,
    StrictUndefined,
    Template,
    TemplateRuntimeError,
    nodes,
    pass_context,
    pass_eval_context,
)
from jinja2.exceptions import SecurityError
from jinja2.filters import FILTERS as JINJA_FILTERS
from jinja2.filters import make_attrgetter
from jinja2.nodes import EvalContext
from jinja2.runtime import Context, Undefined
from jinja2.sandbox import ImmutableSandboxedEnvironment
from jinja2.utils import missing
from jinja2.visitor import NodeTransformer

from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.models.named_table import NamedTable
from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.formats.environment import FILTERS, OPTIONS, ViewContext, finalize, kind_of, require_text
from linkforge_compile.limits import Budget, Limit

_READING = ("get", "has", "find", "is", "to", "volume")
"""How the names begin of methods of the model that change nothing and read no file."""

_MOST_BITS = 4096
"""Bits of a whole number that is multiplied, or is a power."""

_MOST_INDENTED = 32
"""Blanks a level in JSON."""

_STEPS_OF_A_CALL = 10
"""Steps that a call or an include costs; a round of a loop costs one."""

_WIDE_FORMAT = re.compile(
    r"%(?:\([^%]*\))?[-+ #0]*(?:\*|\d{5}|\d*\.(?:\*|\d{5}))"  # of %
    r"|\{[^{}]*:[^{}]*(?:\{|\d{5})"  # of str.format
)
"""Part of a format of `%` or of `str.format` that makes a long text, or one as long as an argument says."""

_UNCOUNTED = frozenset({"encode", "to_bytes", "translate"})
"""Methods that a template has no need of, and that make much of little before it can be counted."""

_COUNTED, _MEASURED, _WORDED = "counted", "measured", "worded"

_OF_TEXT = frozenset(
    (
        *("capitalize", "center", "e", "escape", "forceescape", "format", "indent", "lower", "pprint", "replace"),
        *("safe", "string", "striptags", "title", "trim", "truncate", "upper", "urlize", "wordcount", "wordwrap"),
    )
)
"""The filters of Jinja2 that take any value as its text."""


class _StrictUndefined(StrictUndefined):
    """The value of an undefined name: its message offers the names that are like it."""

    @property
    def _undefined_message(self) -> str:
        name, owner = self._undefined_name, self._undefined_obj
        if self._undefined_hint:
            return self._undefined_hint
        if owner is missing:
            return f"'{name}' is not defined"
        if owner is None:
            return f"this is None, which has no '{name}'; test it with '{{% if … %}}'"
        if isinstance(owner, NamedTable) and name in {"keys", "values", "items"}:
            return f"this has no '{name}'; it is a list: loop over it, or over its 'names'"
        whole = "this" if isinstance(owner, NamedTable | Mapping) else kind_of(owner)
        return f"{whole} has no '{name}'{did_you_mean(str(name), _names_in(owner))}"


def _names_in(owner: object) -> Iterator[str]:
    """Yield what a template may name of an object."""
    yield from (str(key) for key in owner) if isinstance(owner, Mapping) else ()
    yield from getattr(owner, "names", ())
    yield from (name for name in dir(owner) if not name.startswith("_"))


class _Counting(NodeTransformer):
    """Passes what loops run over, and what `~` and filters take and make, through filters that count it."""

    def visit_For(self, node: nodes.For) -> nodes.For:  # noqa: N802 the name is NodeTransformer's
        self.generic_visit(node)
        node.iter = _filtered(node.iter, _COUNTED)
        return node

    def visit_Concat(self, node: nodes.Concat) -> nodes.Expr:  # noqa: N802 as above
        self.generic_visit(node)
        node.nodes = [_filtered(child, _WORDED) for child in node.nodes]
        return _filtered(node, _MEASURED)

    def visit_Filter(self, node: nodes.Filter) -> nodes.Expr:  # noqa: N802 as above
        self.generic_visit(node)
        if node.node is None:
            return node  # the first filter of a block: it takes the text of the block
        guard = _WORDED if node.name in _OF_TEXT else _COUNTED if node.name == "list" else _MEASURED
        node.node = _filtered(node.node, guard)
        return _filtered(node, _MEASURED)


def _filtered(node: nodes.Node, name: str) -> nodes.Filter:
    return nodes.Filter(node, name, [], [], None, None, lineno=node.lineno, environment=node.environment)


class FolderEnvironment(ImmutableSandboxedEnvironment):
    """The environment of a folder of templates, which a budget bounds.

    Loops, calls and includes count as steps, texts by their characters; those that an argument makes long are counted
    before they are made.
    """

    context_class = ViewContext
    intercepted_binops = frozenset({"*", "**", "+", "%"})

    def __init__(self, loader: BaseLoader, budget: Budget) -> None:
        super().__init__(loader=loader, **OPTIONS | {"undefined": _StrictUndefined, "finalize": self._finalize})
        self.filters.update(FILTERS)
        self.filters.update({_COUNTED: self._counted, _MEASURED: self._measured, _WORDED: self._worded})
        self.filters.update(
            {"batch": self._batch, "tojson": self._to_json, "to_yaml": self._to_yaml, "wordwrap": self._wordwrap}
        )
        self.filters.update({"center": self._center, "format": self._format, "indent": self._indent})
        self.filters.update(
            {"replace": self._replace, "join": self._join, "map": _map_to_known, "random": _refuse_random}
        )
        del self.globals["lipsum"]
        self._budget = budget

    def text_of(self, template: str, context: Mapping[str, object]) -> str:
        """Return what a template makes of a context."""
        return self.concat(self.get_template(template).generate(context))

    def _generate(
        self, source: nodes.Template, name: str | None, filename: str | None, defer_init: bool = False
    ) -> str:
        """Compile a template whose work is counted, by the hook that Jinja2 has for this."""
        return super()._generate(_Counting().visit(source), name, filename, defer_init)

    # Any: what templates handle, which the signatures of Jinja2 leave open.

    def is_safe_attribute(self, obj: Any, attr: str, value: Any) -> bool:
        """Allow what is data of the model: where it was written, and what finds its meshes, lead to files."""
        leads_to_files = attr in {"source", "resource_resolver"} or isinstance(value, PurePath)
        return not leads_to_files and super().is_safe_attribute(obj, attr, value)

    def is_safe_callable(self, obj: Any) -> bool:
        """Allow methods of Python's values and of Jinja2's, and those of the model that only read."""
        home = (getattr(obj, "__module__", None) or "builtins").partition(".")[0]
        if isinstance(obj, Undefined):
            return True  # to call it reports the name
        if getattr(obj, "__name__", "") in _UNCOUNTED:
            return False
        if home == "linkforge_compile":
            return not isinstance(obj, type) and obj.__name__.partition("_")[0] in _READING
        return home in {"builtins", "jinja2", "markupsafe"} and super().is_safe_callable(obj)

    def getattr(self, obj: Any, attribute: str) -> Any:
        """Return what an object has by a name; undefined too where an index has no such item."""
        try:
            return super().getattr(obj, attribute)
        except RobotModelError:
            if not isinstance(obj, NamedTable):
                raise
            return self.undefined(obj=obj, name=attribute)

    def getitem(self, obj: Any, argument: Any) -> Any:
        """Return an item of an object; undefined too where an index has no such item."""
        try:
            return super().getitem(obj, argument)
        except RobotModelError:
            if not isinstance(obj, NamedTable):
                raise
            return self.undefined(obj=obj, name=argument)

    def call(self, context: Context, obj: Any, /, *args: Any, **kwargs: Any) -> Any:
        self._step(_STEPS_OF_A_CALL)
        if not self.is_safe_callable(obj):
            raise SecurityError(f"'{getattr(obj, '__name__', type(obj).__name__)}' may do more than that")
        owner = getattr(obj, "__self__", None)
        if isinstance(owner, str | list | tuple):
            self._measured(owner)
        if isinstance(owner, str):
            self._foresee(_characters_made(owner, obj.__name__, (*args, *kwargs.values())))
        return self._measured(super().call(context, obj, *args, **kwargs))

    def call_binop(self, context: Context, operator: str, left: Any, right: Any) -> Any:
        """Compute what may make much of little, if it does not."""
        if isinstance(left, int) and isinstance(right, int):
            bits = {"**": left.bit_length() * right, "*": left.bit_length() + right.bit_length()}.get(operator, 0)
            if bits > _MOST_BITS:
                raise OverflowError(f"this number has more than {_MOST_BITS} bits")
        elif operator == "%" and isinstance(left, str):
            _require_narrow(left)
            for value in right if isinstance(right, tuple) else (right,):
                self._worded(value)
        elif operator == "*":
            for text, times in ((left, right), (right, left)):
                if isinstance(text, str | list | tuple) and isinstance(times, int):
                    self._foresee(len(text) * times)
        return self._measured(super().call_binop(context, operator, left, right))

    def wrap_str_format(self, value: Any) -> Callable[..., str] | None:
        wrapped = super().wrap_str_format(value)
        if wrapped is not None:
            _require_narrow(value.__self__)
        return wrapped

    def get_template(self, name: str | Template, *args: Any, **kwargs: Any) -> Template:
        self._step(_STEPS_OF_A_CALL)
        return super().get_template(name, *args, **kwargs)

    def select_template(self, names: Iterable[str | Template] | Undefined, *args: Any, **kwargs: Any) -> Template:
        self._step(_STEPS_OF_A_CALL)
        return super().select_template(names, *args, **kwargs)

    def concat(self, texts: Iterable[str]) -> str:
        """Join texts that a template writes, as far as there may be more."""
        return "".join(map(self._measured, texts))

    def _step(self, steps: int = 1) -> None:
        self._budget.spend(Limit.TEMPLATE_STEPS, steps, None)

    @pass_eval_context
    def _finalize(self, context: EvalContext, value: Any) -> object:
        return finalize(context, value if context.autoescape else self._worded(value))

    @pass_eval_context
    def _join(self, context: EvalContext, value: Any, d: str = "", attribute: str | int | None = None) -> Any:
        items = self._counted(value) if attribute is None else map(make_attrgetter(self, attribute), value)
        texts = list(map(self._worded, items))
        self._foresee(len(texts) * len(str(d)))
        return JINJA_FILTERS["join"](context, texts, d)

    def _batch(self, value: Any, linecount: int, fill_with: object = None) -> object:
        self._foresee(linecount)
        return JINJA_FILTERS["batch"](value, linecount, fill_with)

    def _center(self, value: Any, width: int = 80) -> object:
        self._foresee(width)
        return JINJA_FILTERS["center"](value, width)

    def _format(self, value: Any, *args: Any, **kwargs: Any) -> object:
        _require_narrow(str(value))
        return JINJA_FILTERS["format"](value, *map(self._worded, args), **kwargs)

    def _indent(self, s: Any, width: int | str = 4, first: bool = False, blank: bool = False) -> object:
        self._foresee((str(s).count("\n") + 1) * (width if isinstance(width, int) else len(width)))
        return JINJA_FILTERS["indent"](s, width, first, blank)

    @pass_eval_context
    def _replace(self, context: EvalContext, s: Any, old: str, new: str, count: int | None = None) -> object:
        self._foresee(_characters_made(str(s), "replace", (old, new)))
        return JINJA_FILTERS["replace"](context, s, old, new, count)

    @pass_eval_context
    def _to_json(self, context: EvalContext, value: Any, indent: int | None = None) -> object:
        if indent is not None and indent > _MOST_INDENTED:
            raise TemplateRuntimeError(f"'tojson' takes an indent of at most {_MOST_INDENTED}")
        self._count_all(value)
        return JINJA_FILTERS["tojson"](context, value, indent)

    def _to_yaml(self, value: Any) -> object:
        self._count_all(value)
        return FILTERS["to_yaml"](value)

    def _count_all(self, value: Any) -> None:
        """Count the values in nested lists and maps: a short one may hold the same list again and again."""
        self._step()
        if isinstance(value, Mapping):
            value = [*value, *value.values()]
        if isinstance(value, list | tuple):
            for item in value:
                self._count_all(item)

    def _wordwrap(self, s: str, width: int = 79, *args: Any, **kwargs: Any) -> object:
        between = kwargs.get("wrapstring") or (args[1] if len(args) > 1 else None) or "\n"
        self._foresee((len(s) // max(width, 1) + s.count("\n") + s.count(" ")) * len(between))
        return JINJA_FILTERS["wordwrap"](self, s, width, *args, **kwargs)

    def _foresee(self, characters: int) -> None:
        self._budget.spend(Limit.TEMPLATE_CHARACTERS, max(characters, 0), None)

    def _worded(self, value: Any) -> Any:
        require_text(value, self._step)
        return self._measured(value)

    def _counted(self, items: Iterable[object]) -> Iterator[object]:
        if isinstance(items, set | frozenset):
            raise TemplateRuntimeError("a set has no order, so the text would differ from run to run; write '| sort'")
        for item in items:
            self._step()
            yield item

    def _measured(self, value: Any) -> Any:
        if isinstance(value, str | list | tuple | range | Mapping | NamedTable):
            self._budget.spend(Limit.TEMPLATE_CHARACTERS, len(value), None)
        return value


def _require_narrow(text: str) -> None:
    """Refuse a format with a width of more than four digits, or a computed one."""
    if _WIDE_FORMAT.search(text):
        raise TemplateRuntimeError("a width in a format is a number of at most four digits, written in it")


def _characters_made(text: str, method: str, args: Sequence[Any]) -> int:
    """Return how many characters a method of a text may make of its arguments; 0 where it makes few."""
    match method, args:
        case (("center" | "ljust" | "rjust" | "zfill"), (int(width), *_)):
            return width
        case "expandtabs", (int(width), *_):
            return text.count("\t") * width
        case "replace", (str(old), str(new), *_):
            return text.count(old) * len(new)
        case "join", (list() | tuple() as items, *_):
            return len(text) * len(items)
    return 0


@pass_context
def _map_to_known(context: Context, value: Any, *args: Any, **kwargs: Any) -> Iterator[object]:
    """Map as Jinja2 does, but report a name that an item does not have."""
    for item in JINJA_FILTERS["map"](context, value, *args, **kwargs):
        if isinstance(item, Undefined):
            str(item)  # reports the name
        yield item


def _refuse_random(_: object) -> object:
    raise TemplateRuntimeError("'random' would make another text on every run; write '| first' or an index")
