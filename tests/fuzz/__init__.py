"""Coverage-guided fuzzing: what reads strangers' bytes is fed with bytes that reach ever more of its code."""
