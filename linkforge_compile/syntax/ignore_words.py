"""The words of comments such as `# linkforge: ignore LF6003`, by which a file without any is known."""

from __future__ import annotations

import re

# A search for plain text is a hundred times as fast as one for the whole pattern, and most files have none.
IGNORE_WORDS = re.compile(r"linkforge[: \t]+(?:ignore|disable|suppress|skip|noqa|nolint)\b")
"""Is found in every text that `ignore_comments` finds something in."""
