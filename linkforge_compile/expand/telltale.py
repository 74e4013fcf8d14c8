"""What a text has in it that is judged by its place."""

from __future__ import annotations

import re

TELLTALE = re.compile(r"\bprefix\b(?!['\"]?\s*:)|\b(?:path|link|joint)[\s)]*\(|\$\{|[“„‘]")
"""Is in every text that has something to judge; hardly a spec needs the walk through its tree."""

SIGNS = ("$", "\\", "“", "„", "‘")
"""One of these is in every such text: a dollar sign, as such or escaped, or a quote of word processors."""
