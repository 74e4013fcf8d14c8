"""The site: `sphinx-build -W --keep-going -n -c docs . SITE` writes it, and fails at a link that leads nowhere.

Its pages are those that are read on GitHub, at the same relative places, so the source folder is the repository. What a
site alone needs is added as the pages are read: the navigation, the list of codes, the reference of the Python package.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx

from linkforge_compile import __version__
from linkforge_compile.diagnostics.codes import REGISTER

NAVIGATION = {
    "Start": ["docs/install", "docs/tutorial", "examples/README", "examples/parts/README"],
    "How-to": [
        "docs/how-to/two-arms",
        "docs/how-to/variants",
        "docs/how-to/moveit",
        "docs/how-to/gazebo",
        "docs/how-to/mujoco",
        "docs/how-to/colcon",
        "docs/how-to/launch",
        "docs/how-to/github",
    ],
    "Guides": [
        "docs/existing-robots",
        "docs/view",
        "docs/overview",
        "docs/collisions",
        "docs/sweep",
        "docs/editors",
        "docs/builds",
        "docs/templates",
    ],
    "Coming from xacro": ["docs/from-xacro", "docs/compared-with-xacro"],
    "Reference": [
        "docs/language",
        "docs/diagnostics",
        "docs/checks",
        "docs/commands",
        "docs/after-urdf",
        "docs/python",
        "docs/source-map",
    ],
    "Project": [
        "docs/security",
        "docs/contributing",
        "docs/how-it-is-built",
        "docs/diagnostics/README",
        "benchmarks/README",
        "editors/vscode/README",
        "CHANGELOG",
    ],
}
FAMILIES = {
    "LF1": "YAML",
    "LF2": "Keys and values",
    "LF3": "Modules, parameters and expressions",
    "LF4": "Names and references",
    "LF5": "Joints, quantities and planning",
    "LF6": "Mass, meshes, hardware and Gazebo",
    "LF7": "Outputs",
    "LF8": "URDF, SRDF and xacro",
}

project = "linkforge-compile"
version = release = __version__
root_doc = "README"
include_patterns = [
    "*.md",
    "docs/**",
    "examples/README.md",
    "examples/parts/README.md",
    "benchmarks/README.md",
    "editors/vscode/README.md",
]
exclude_patterns = ["docs/language.in.md", ".*", "**/node_modules"]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
suppress_warnings = ["misc.highlighting_failure"]  # the manual shows YAML that is wrong
nitpick_ignore_regex = [("py:.*", ".*")]  # types of annotations, which have no pages
myst_heading_anchors = 4  # those of GitHub
myst_enable_extensions = ["deflist"]
default_role = "code"  # as docstrings have it
autodoc_member_order = "bysource"
toc_object_entries = False  # each page of the site has the whole navigation: with 1,000 members it is slow
html_theme = "furo"
html_title = f"{project} {version}"
html_copy_source = False
smartquotes = False  # they make a dash of `--` in the names of options
html_show_copyright = False
html_static_path = ["static"]
html_css_files = ["site.css"]


def add_what_a_site_needs(app: Sphinx, page: str, source: list[str]) -> None:
    """Complete the Markdown of a page, `source[0]`."""
    if page == root_doc:
        source[0] += "".join(_toctree(caption, pages) for caption, pages in NAVIGATION.items())
    elif page == "docs/diagnostics":
        source[0] += "\n## All codes\n" + "".join(_codes(*family) for family in FAMILIES.items())
    elif page == "docs/python":
        source[0] += "\n## Reference\n" + _members("linkforge_compile", "Robot") + _members("linkforge_compile.core")
    elif page.startswith("docs/diagnostics/LF"):
        # Listed in docs/diagnostics.md, not in the navigation.
        title, _, text = source[0].partition("\n")
        source[0] = f"---\norphan: true\n---\n{title}\n\n[All diagnostics](../diagnostics.md)\n{text}"
    elif page == "docs/commands":
        source[0] = re.sub(r"^```text\n(.*?)^```$", _commands, source[0], flags=re.MULTILINE | re.DOTALL)


def _toctree(caption: str, pages: list[str]) -> str:
    listed = "\n".join(f"/{page}" for page in pages)
    return f"\n```{{toctree}}\n:hidden:\n:titlesonly:\n:caption: {caption}\n\n{listed}\n```\n"


def _commands(block: re.Match[str]) -> str:
    """Make a list of the lines of a block, which are too long for a page: a command, blanks, and what it does."""
    lines = (re.split(r"(?<=\S) {2,}", line, maxsplit=1) for line in block[1].splitlines())
    return "\n".join(f"`{command}`\n: {' '.join(text) or '…'}\n" for command, *text in lines)


def _codes(beginning: str, title: str) -> str:
    codes = [code for code in sorted(REGISTER) if code.startswith(beginning)]
    return f"\n### {beginning}: {title}\n\n" + "\n".join(f"- [](diagnostics/{code}.md)" for code in codes) + "\n"


def _members(module: str, but: str = "") -> str:
    options = f"   :members:\n   :exclude-members: {but}\n"
    return f"\n### {module}\n\n```{{eval-rst}}\n.. automodule:: {module}\n{options}```\n"


def remove_links_without_page(app: Sphinx, doctree: nodes.document) -> None:
    """Leave the text of links to folders of the repository, and to its files in Markdown that are no pages."""
    folder = Path(app.srcdir, app.env.docname).parent
    for link in list(doctree.findall(pending_xref)):
        target = link["reftarget"]
        is_file = target not in app.env.found_docs and Path(app.srcdir, f"{target}.md").is_file()
        if is_file if link["refdomain"] == "doc" else (folder / target).is_dir():
            link.replace_self(link.children)


def copy_first_page(app: Sphinx, error: Exception | None) -> None:
    """Make the first page that of the folder."""
    if error is None and app.builder.name == "html":
        shutil.copyfile(Path(app.outdir, f"{root_doc}.html"), Path(app.outdir, "index.html"))


def setup(app: Sphinx) -> None:
    app.connect("source-read", add_what_a_site_needs)
    app.connect("doctree-read", remove_links_without_page)
    app.connect("build-finished", copy_first_page)
