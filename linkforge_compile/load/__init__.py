"""Read the files of a compile, each once, as validated trees: specs with all that they include, URDF and xacro.

What each module knows; it imports only those above it:

    spec_tree         the text of a spec -> its validated tree, with the files of `include` merged
    files_read        the files that a compile has read so far, and what became of each
    loader            the files of one compile, each read once -> SpecFile
    locations         what a path in a spec names -> a file; a path relative to one file -> relative to another
    xacro_library     a xacro file and what it includes -> the arguments and macros that they declare, by reading alone
    xacro_written     the elements of xacro files as they are written, by the places that xacro's elements have
    xacro             a xacro file -> SpecFile; what xacro reports -> diagnostics where it is written
    macro_roles       a macro -> which of its parameters are the link above it, its place there, its prefix, or a length
    xacro_macro       an entry of `modules` with `macro` -> the call of the macro, and the SpecFile that it makes
"""

from linkforge_compile.load.loader import ImportSite, Loader, SpecFile
from linkforge_compile.load.locations import is_xacro
