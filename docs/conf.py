"""Sphinx configuration: `make docs`."""

from importlib.metadata import version as installed

project = "preshape"
author = "The preshape developers"
copyright = "2026, the preshape developers"
version = release = installed("preshape")
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath"]
exclude_patterns = ["_build"]
html_theme = "furo"
html_title = "preshape"
autodoc_member_order = "bysource"
autodoc_typehints = "none"
napoleon_google_docstring = False
napoleon_use_ivar = True
nitpicky = False
