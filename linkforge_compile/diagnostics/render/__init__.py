"""Diagnostics for a person, a program, a build log and a code host; each form but text is imported when used."""

from linkforge_compile.diagnostics.render.text import MOST_SHOWN, render_first, render_text, snippet, summary

__all__ = ["FORMS", "MOST_SHOWN", "render_first", "render_text", "snippet", "summary"]

FORMS = ("text", "json", "github", "sarif")
"""The names of the forms."""
