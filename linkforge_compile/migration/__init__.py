"""Translate a xacro into specs: modules, parameters and variables, proved equal to what xacro expands.

The stages, from top to bottom; each imports those above it:

    deadline     the time that all of it may take
    symbols      names of a spec (parameters, variables, data), and the texts that xacro computes of them
    constants    the value of an expression of which all names are known
    expressions  expressions of xacro as expressions of the language
    sources      the files of a xacro as elements with places, and where `$(find)` and relative paths lead
    scopes       properties, macros and blocks by name, as xacro looks them up
    template     what a file expands to: elements with expressions, conditions and uses of modules
    expand       walks a xacro as xacro does, but keeps what depends on a parameter as an expression
    calls        calls of macros: written in place, or as a module
    without_effect  elements that no URDF reader acts on
    written      a template as URDF in which a number stands for each expression
    values       expressions in the place of these numbers
    merge        one tree of the trees for the outcomes of conditions
    parameters   types of parameters, and lists and numbers as variables have them
    heads        the comments that begin a spec
    files        a template as the tree of a spec
    combinations which values of the arguments a proof compares
    proof        compares what the specs compile to with what xacro expands
    report       what was translated, what was not and why
    migrate      all of it, and the ways back when a proof fails
"""
