"""The version, as a literal: `linkforge --version` answers with it before anything else is imported."""

__version__ = "0.1.0"
