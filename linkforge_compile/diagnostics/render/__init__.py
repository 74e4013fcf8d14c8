"""Diagnostics for a person, a program, a build log and a code host: a module each."""

FORMS = ("text", "json", "github", "sarif")
"""The names of the forms."""
