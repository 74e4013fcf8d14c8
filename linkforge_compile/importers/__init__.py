"""Robots that were written elsewhere, as trees of the language: URDF."""
