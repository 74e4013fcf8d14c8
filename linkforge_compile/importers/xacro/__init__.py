"""Expand xacro files with the xacro package in a separate process, and trace elements to where they were written."""

from linkforge_compile.importers.xacro.answers import XacroAnswers
from linkforge_compile.importers.xacro.run import (
    Expanded,
    Failed,
    MacroCall,
    Place,
    moved_back,
    plain_message,
    run_xacro,
)
