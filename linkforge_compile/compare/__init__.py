"""Compare two robots: which parts were added, removed, renamed or moved, and by how much values changed."""

from __future__ import annotations

from linkforge_compile.compare.context import TOLERANCE
from linkforge_compile.compare.difference import Difference, Kind
from linkforge_compile.compare.folders import with_folders, with_texts
from linkforge_compile.compare.matching import RemovedName, removed_parts, removed_public_names
from linkforge_compile.compare.robots import compare
