"""Completion of command lines: `finder` answers a shell through argcomplete, `candidates` knows what a word may be."""
