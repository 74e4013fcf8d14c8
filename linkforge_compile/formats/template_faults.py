"""What went wrong in a user's template, as a diagnostic at its line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import groupby
from traceback import walk_tb
from typing import NamedTuple

from jinja2 import TemplateNotFound, TemplateRuntimeError, TemplateSyntaxError, UndefinedError
from jinja2.exceptions import SecurityError
from jinja2.filters import FILTERS as JINJA_FILTERS
from jinja2.tests import TESTS as JINJA_TESTS

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostic, Note
from linkforge_compile.diagnostics.codes.formats import (
    NO_SUCH_TEMPLATE,
    REFUSED_IN_TEMPLATE,
    TEMPLATE_FAILS,
    TEMPLATE_SYNTAX,
    UNDEFINED_IN_TEMPLATE,
    UNREADABLE_TEMPLATE,
)
from linkforge_compile.diagnostics.codes.modules import OUTSIDE_ROOTS
from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.formats.environment import FILTERS
from linkforge_compile.formats.template_loader import FolderLoader, OutsideError, UnreadableError, span_of_line
from linkforge_compile.source import SourceFile, Span

_MOST_SHOWN = 80
"""Characters of a line that a message quotes."""

_UNKNOWN = re.compile(r"No (?P<kind>filter|test) named '(?P<name>\w+)'")
_UNDEFINED = re.compile(r"'(?P<name>\w+)' is not defined")
_KNOWN = {"filter": (*JINJA_FILTERS, *FILTERS), "test": tuple(JINJA_TESTS)}

_DECLARED = re.compile(r"<\?xml\s[^>]*?encoding\s*=\s*[\"']([\w.-]+)")
_UTF_8 = ("utf-8", "utf8")

_OF_THIS = re.compile(r"this (?:is None, which )?has no '(?P<name>\w+)'")

_CODES = (
    (TemplateSyntaxError, TEMPLATE_SYNTAX),
    (SecurityError, REFUSED_IN_TEMPLATE),
    (UndefinedError, UNDEFINED_IN_TEMPLATE),
)


def diagnose(error: Exception, template: str, loader: FolderLoader, names: Iterable[str]) -> Diagnostic:
    """Return the diagnostic of an error that rendering a template raised, at the line of a template.

    `names` are those that the template is given.
    """
    places = list(_places(error, loader.files))
    place = places[0] if places else loader.place_of(template)
    notes = [Note("included here", span) for span in places[1:]]
    match error:
        case BeyondLimitError(diagnostic=diagnostic):
            return replace(diagnostic, span=place, notes=(*diagnostic.notes, *notes))
        case OutsideError(path=path, roots=roots):
            if not loader.has(place.file):  # one of ours includes it
                place, notes = SourceFile(str(path), "", path).whole, []
            notes = [*map(Note, roots.reasons(path)), *notes]
            return OUTSIDE_ROOTS.at(place, path=path, name="NAME", notes=notes)
        case UnreadableError(path=path, reason=reason):
            notes = [Note("included here", span) for span in places]
            return UNREADABLE_TEMPLATE.at(error.place, path=path, reason=reason, notes=notes)
        case TemplateNotFound(name=name):
            return NO_SUCH_TEMPLATE.at(place, name=name, folder=loader.folder, near=loader.names(), notes=notes)
        case RecursionError():
            return TEMPLATE_FAILS.at(place, reason="templates or macros use each other without an end", notes=notes)
        case MemoryError():
            return TEMPLATE_FAILS.at(place, reason="it takes more memory than there is", notes=notes)
    code = next((code for kind, code in _CODES if isinstance(error, kind)), TEMPLATE_FAILS)
    return code.at(place, reason=_naming_owner(_reason(error, names), place.text or ""), notes=notes)


def _naming_owner(reason: str, line: str) -> str:
    """Return a reason with the expression in place of "this", where the line has only one that may be it."""
    if not (missing := _OF_THIS.match(reason)):
        return reason
    name = re.escape(missing["name"])
    owners = set(re.findall(rf"""([A-Za-z_][\w.]*(?:\[[^][]*\][\w.]*)*)(?:\.{name}\b|\[["']{name}["']\])""", line))
    return f"'{owners.pop()}'{reason.removeprefix('this')}" if len(owners) == 1 else reason


def _places(error: Exception, files: Mapping[str, SourceFile]) -> Iterator[Span]:
    """Yield the line at fault, and then of each template around it the line that includes the one before."""
    if isinstance(error, TemplateSyntaxError):
        if error.filename is not None and error.filename in files:
            yield span_of_line(files[error.filename], error.lineno)
        return
    steps = [(frame.f_code.co_filename, line) for frame, line in walk_tb(error.__traceback__)]
    of_templates = [(name, line) for name, line in reversed(steps) if name in files]
    for name, lines in groupby(of_templates, key=lambda step: step[0]):
        yield span_of_line(files[name], next(lines)[1])


def _reason(error: Exception, names: Iterable[str]) -> str:
    text = str(error.message if isinstance(error, TemplateSyntaxError | TemplateRuntimeError) else error)
    text = text.strip().removesuffix(".") or type(error).__name__
    if unknown := _UNKNOWN.search(text):
        text += did_you_mean(unknown["name"], _KNOWN[unknown["kind"]])
    elif undefined := _UNDEFINED.fullmatch(text):
        text += did_you_mean(undefined["name"], names)
    return text if text[1:2].isupper() else f"{text[:1].lower()}{text[1:]}"


class XmlFault(NamedTuple):
    """What is wrong with a text, which quotes the line, and the whole line."""

    problem: str
    line: str


def find_xml_fault(text: str) -> XmlFault | None:
    """Return why a text is no well-formed XML in UTF-8; None where it is."""
    from xml.parsers import expat

    from linkforge_compile.source.malformed_xml import ENDS_BEFORE, find_xml_error

    text = text.encode("utf-8", "backslashreplace").decode()
    # expat takes prefixes without a declaration, as the URDF of many vendors has them.
    parser = expat.ParserCreate("utf-8")
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        fault = find_xml_error(text)
        problem = fault.problem if fault else expat.ErrorString(error.code)
        lines = text.split("\n")
        line = lines[error.lineno - 1].strip() if error.lineno <= len(lines) else ""
        if problem.startswith(ENDS_BEFORE):
            tag = problem.removeprefix(ENDS_BEFORE)
            return XmlFault(f"the output ends at line {error.lineno} without {tag}", line)
        quoted = f", '{line[:_MOST_SHOWN]}'" if line else ""
        return XmlFault(f"{problem}, in line {error.lineno} of it{quoted}", line)
    declared = _DECLARED.match(text)
    if declared and declared[1].lower() not in _UTF_8:
        problem = f"it declares the encoding '{declared[1]}', and is written in UTF-8; write encoding='utf-8'"
        return XmlFault(problem, text.partition("\n")[0].strip())
    return None
