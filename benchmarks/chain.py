"""Specs of a chain of links, to measure the compile time of large robots."""

from __future__ import annotations

_LINK = """
  link{0}:
    visual: {{cylinder: {{radius: 0.05, length: 0.3}}, origin: {{xyz: [0, 0, 0.15]}}, material: steel}}
    collision: {{cylinder: {{radius: 0.05, length: 0.3}}, origin: {{xyz: [0, 0, 0.15]}}}}
    inertial: {{mass: 1.5, origin: [0, 0, 0.15], inertia: {{ixx: 0.0122, iyy: 0.0122, izz: 0.0019}}}}"""

_JOINT = """
  joint{0}:
    type: revolute
    parent: link{0}
    child: link{1}
    origin: {{xyz: [0, 0, 0.3], rpy: [0, 0, 0.1]}}
    axis: [0, 1, 0]
    limits: {{lower: -1.5, upper: 1.5, effort: 50, velocity: 2}}
    dynamics: {{damping: 0.1, friction: 0.05}}"""


def make_chain(links: int) -> str:
    """Return a spec of so many links with inertias and shapes, and the joints between them."""
    return "".join(
        (
            "linkforge: 1\nname: chain\nmaterials:\n  steel: {color: [0.6, 0.6, 0.65]}\nlinks:",
            *(_LINK.format(number) for number in range(links)),
            "\njoints:" if links > 1 else "",
            *(_JOINT.format(number, number + 1) for number in range(links - 1)),
            "\n",
        )
    )


def make_repeated_chain(links: int) -> str:
    """Return a spec of the same robot, with at least two links, written with `for`."""
    link, joint = _LINK.format("$(i)"), _JOINT.format("$(i)", "$(i + 1)")
    return "".join(
        (
            make_chain(1).partition("links:")[0],
            f"links:{link}\n    for: {{i: {links}}}",
            f"\njoints:{joint}\n    for: {{i: {links - 1}}}\n",
        )
    )
