"""Two robots against each other, in a robot's own terms: what is new, gone, renamed, moved, and changed by how much."""

from __future__ import annotations

from linkforge_compile.compare.difference import Difference, Kind, Plain
from linkforge_compile.compare.public import Vanished, vanished
from linkforge_compile.compare.robots import compare
from linkforge_compile.compare.walk import TOLERANCE

__all__ = ["TOLERANCE", "Difference", "Kind", "Plain", "Vanished", "compare", "vanished"]
