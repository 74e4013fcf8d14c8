"""The language server: the compiler's knowledge in editors, by the Language Server Protocol 3.17.

It needs the extra `lsp` (pygls). What each module knows; it imports only those above it:

    convert       places in a text <-> ranges of the protocol, paths <-> URIs
    cursor        a position in a text, which may not parse -> the path of keys to it and its role there
    workspace     the open buffers, and the latest Analysis of each spec
    diagnostics   the Analyses -> the protocol's diagnostics of each file
    placed        a place in a text -> the nodes of the expanded trees there, one for each use of the file
    completion/   what may be written at a position
    server        requests and notifications -> calls of the above, and of the features

Each feature is a module of its own: functions from an Analysis, a text and a position to values of the protocol.
"""
