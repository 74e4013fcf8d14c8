"""Format specs: only the white space between the tokens of YAML changes.

    safe_format  format a text, and compare what is read of it before and after
    layout       indentation, spaces, places of comments, and columns that spaces align
    pieces       a text as tokens with the gaps between them, and texts over several lines

A library that reads a text with its comments and writes it anew was tried (ruamel.yaml): it joins lists and maps that
continue on several lines, moves comments after anchors, and writes `False` and `velocity: ` differently.
"""

from __future__ import annotations

from linkforge_compile.formatter.safe_format import format_source, format_text
