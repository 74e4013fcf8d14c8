"""A user's folder of templates: documents at its top, and templates that override linkforge's."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from itertools import islice
from pathlib import Path

import jinja2
from jinja2.loaders import split_template_path
from jinja2.meta import find_referenced_templates

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes.formats import NOT_XML_FROM_TEMPLATE, TEMPLATE_FAILS, UNUSED_TEMPLATE
from linkforge_compile.diagnostics.codes.modules import BEYOND_LIMIT
from linkforge_compile.diagnostics.enumerations import alternatives
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.formats.sandbox import FolderEnvironment
from linkforge_compile.formats.template_loader import FolderLoader, OutsideError, UnreadableError
from linkforge_compile.formats.xml_text import harmless_in_comment
from linkforge_compile.limits import MAX_NESTED_ELEMENTS, Budget
from linkforge_compile.resources import format_templates, templates_folder
from linkforge_compile.roots import ANYWHERE, Roots
from linkforge_compile.source import SourceFile

SUFFIX = ".j2"
"""How the names of templates end; without it, that of a document's template is the document's."""

_RENDERING_BEYOND_LIMIT = replace(
    BEYOND_LIMIT,
    message="rendering takes more than {most} {counted}; {way_out} (LINKFORGE_LIMITS=10 in the environment allows ten "
    "times as much)",
    in_xml="",
)
"""What exceeds the limit is a user's template, and not the robot."""

_MOST_FILES = 1000
"""Files of a folder that are searched for names and includes."""

_NOT_DOCUMENTS = ("_", ".")
"""How the names of templates begin at the top of a folder that others include."""


def own_names() -> frozenset[str]:
    """Return the paths of the packaged templates that a user's may replace."""
    return frozenset(path.relative_to(templates_folder()).as_posix() for path in format_templates())


def own_folders() -> list[str]:
    """Return the folders of the packaged templates that a user's may replace."""
    return sorted({name.partition("/")[0] for name in own_names()}, reverse=True)


class TemplateError(Exception):
    """A user's templates cannot be rendered; `diagnostics` has the faults, at their lines."""

    def __init__(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        self.diagnostics = diagnostics
        super().__init__("\n".join(map(str, diagnostics)))

    def __reduce__(self) -> tuple[type[TemplateError], tuple[tuple[Diagnostic, ...]]]:
        return TemplateError, (self.diagnostics,)


class TemplateFolder:
    """A user's folder of templates; each is read once, when it is first used."""

    def __init__(self, folder: str | Path, *, packages: Iterable[Path] = (), allow_outside: bool = False) -> None:
        """Templates may be links to what lies in the folder's repository or in `packages`, else with `allow_outside`.

        Raises:
            NotADirectoryError: for what is no folder.
            OSError: for a folder that cannot be read.

        """
        self.folder, self._budget = Path(folder), Budget(code=_RENDERING_BEYOND_LIMIT)
        self._roots = ANYWHERE if allow_outside else Roots.around(self.folder, (self.folder, *packages))
        with os.scandir(self.folder) as entries:
            names = sorted(entry.name for entry in entries if entry.is_symlink() or entry.is_file())
        templates = [name for name in names if name.endswith(SUFFIX) and not name.startswith(_NOT_DOCUMENTS)]
        self.documents = tuple(name.removesuffix(SUFFIX) for name in templates)
        """The names of the documents that its templates make, sorted."""

    @classmethod
    def of(cls, templates: TemplateFolder | str | Path) -> TemplateFolder:
        """Return a folder of templates; raises what the constructor and `require_templates` raise."""
        folder = templates if isinstance(templates, TemplateFolder) else cls(templates)
        folder.require_templates()
        return folder

    def require_templates(self) -> None:
        """Refuse a folder without a document, and without a template that overrides one of linkforge's.

        Raises:
            ValueError: with what a template is named.

        """
        if self.documents or any(os.path.lexists(self.folder / name) for name in own_names()):
            return
        found = sorted(path.relative_to(self.folder).as_posix() for path in islice(self.folder.rglob("*"), _MOST_FILES))
        near = next((f"; '{name}' is like '{own}'" for name in found if (own := nearest(name, own_names()))), "")
        folders = alternatives([f"{folder}/" for folder in own_folders()])
        has = f"NAME.j2 for a document, nor {folders} with a template that overrides one of linkforge's"
        raise ValueError(f"it has no {has}{near}")

    @property
    def unused(self) -> tuple[Diagnostic, ...]:
        """A warning at each file in the folders of overrides that overrides no template and is not included."""
        return tuple(find_unused(self._environment, self._loader))

    @property
    def files(self) -> tuple[Path, ...]:
        """The templates that were read, the packaged ones among them."""
        return tuple(map(Path, self._loader.files))

    @property
    def unread(self) -> tuple[Path, ...]:
        """The files of the folder that do not exist now, but would change the result."""
        return tuple(self._loader.missing)

    def render(self, views: Mapping[str, object], banner: str) -> dict[str, str]:
        """Render all documents and return their texts by name; XML is laid out as URDF is.

        Raises:
            TemplateError: with all that is wrong, one fault a document.

        """
        from linkforge_compile.formats.environment import is_xml
        from linkforge_compile.formats.xml_document import without_marks

        context = {**views, "banner": harmless_in_comment(banner)}
        texts: dict[str, str] = {}
        faults: list[Diagnostic] = []
        for name in self.documents:
            template = f"{name}{SUFFIX}"
            try:
                if is_xml(template):
                    texts[name] = f"{self.xml(template, context, pretty=True)}\n"
                else:
                    texts[name] = without_marks(self.text(template, context))
            except TemplateError as error:
                faults += error.diagnostics
                if self._budget.is_spent:
                    break
        if faults:
            raise TemplateError(tuple(faults))
        return texts

    def xml(self, template: str, context: Mapping[str, object], *, pretty: bool) -> str:
        """Render a template of XML, check that it is well-formed, and return it laid out.

        Raises:
            TemplateError: for what is wrong with it.

        """
        from linkforge_compile.formats.template_faults import find_xml_fault
        from linkforge_compile.formats.xml_document import parse_rendered, write

        rendered = self.text(template, context).lstrip()
        if fault := find_xml_fault(rendered):
            line = self._loader.place_of_line(template, fault.line)
            raise TemplateError((NOT_XML_FROM_TEMPLATE.at(line, problem=fault.problem),))
        try:
            return write(parse_rendered(rendered, most_nested=MAX_NESTED_ELEMENTS), pretty=pretty)
        except RobotGeneratorError as error:
            raise TemplateError((TEMPLATE_FAILS.at(self._loader.place_of(template), reason=error),)) from None

    def text(self, template: str, context: Mapping[str, object]) -> str:
        """Render a template and return its text, not laid out.

        Raises:
            TemplateError: for what is wrong with it.

        """
        try:
            return self._environment.text_of(template, context)
        # A template may raise whatever Python can: each is a fault of the template.
        except Exception as error:
            from linkforge_compile.formats.template_faults import diagnose

            raise TemplateError((diagnose(error, template, self._loader, context),)) from None

    @cached_property
    def _loader(self) -> FolderLoader:
        return FolderLoader(self.folder, self._roots)

    @cached_property
    def _environment(self) -> FolderEnvironment:
        return FolderEnvironment(self._loader, self._budget)


def find_unused(environment: FolderEnvironment, loader: FolderLoader) -> Iterator[Diagnostic]:
    """Yield a warning at each file that replaces no packaged template, and that no template includes.

    Yields none where the name of an included template is computed.
    """
    ours = own_names()
    found = {
        path.relative_to(loader.folder).as_posix(): path
        for place in own_folders()
        for path in sorted(islice((loader.folder / place).rglob("*"), _MOST_FILES))
        if path.is_file()
    }
    strange = {name: path for name, path in found.items() if name not in ours and _is_template(name, ours)}
    used = _included(environment, loader) if strange else set()
    for name, path in strange.items():
        if None not in used and name not in used:
            place = SourceFile(str(path), "", path).whole
            yield UNUSED_TEMPLATE.at(place, name=name, near=ours)


def _is_template(name: str, ours: frozenset[str]) -> bool:
    return name.endswith(SUFFIX) or nearest(name, ours) is not None


def _included(environment: FolderEnvironment, loader: FolderLoader) -> set[str | None]:
    """Return the names of all templates that those of the folder include; None for one that is computed."""
    used: set[str | None] = set()
    for path in islice(loader.folder.rglob(f"*{SUFFIX}"), _MOST_FILES):
        try:
            included = find_referenced_templates(environment.parse(loader.read(path)))
            used |= {name and "/".join(split_template_path(name)) for name in included}
        except (OutsideError, UnreadableError, jinja2.TemplateError):
            continue  # nothing that was rendered uses it
    return used
