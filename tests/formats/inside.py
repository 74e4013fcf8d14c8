"""Parts of a document, so that a test can show only the relevant lines."""

from textwrap import dedent

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.core.models.srdf import SemanticRobotDescription
from linkforge_compile.formats.render import render_srdf, render_urdf


def urdf(*, gazebo="gz", **parts) -> str:
    """Return the lines inside of `<robot>` for a robot of these parts."""
    return inside(render_urdf(Robot("r", **parts), gazebo=gazebo))


def srdf(**parts) -> str:
    """Return the lines inside of `<robot>` for a robot with this semantic part."""
    return inside(render_srdf(Robot("r", semantic=SemanticRobotDescription(**parts))))


def inside(document: str) -> str:
    """Return a document without its declaration and its `<robot>`, as far to the left as it goes."""
    return dedent("".join(document.splitlines(keepends=True)[2:-1]))


def xml(text: str) -> str:
    """Return expected lines written at the depth of the code around them."""
    return dedent(text).lstrip("\n")
