"""Overviews of a robot: values, such as its tree, and modules that write them in a form, such as `tree_text`."""
