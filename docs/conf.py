"""Sphinx configuration: `make docs`. The pages load nothing from outside, so mathematics is MathML, made here."""

import logging
import os
import sys
from importlib.metadata import version as installed
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "extensions"))

# Linear algebra on small matrices must not start threads of its own: where others work too they slow it down tenfold.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Cells run with settings of their own, not with those of whoever builds; their kernels speak of errors only.
os.environ["IPYTHONDIR"] = str(HERE / "_build" / "ipython")
PROFILE = HERE / "_build" / "ipython" / "profile_default"
PROFILE.mkdir(parents=True, exist_ok=True)
(PROFILE / "ipython_kernel_config.py").write_text("get_config().IPKernelApp.log_level = 40\n")
logging.getLogger("traitlets").setLevel(logging.WARNING)

project = "preshape"
author = "The preshape developers"
copyright = "2026, the preshape developers"
version = release = installed("preshape")
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "mathematics",
    "nothing_from_outside",
    "whole_reference",
]
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["_build", "extensions", "figures", "jupyter_execute", "theory/numbers"]

# The gallery and whatever else has code cells is executed at every build: a page that fails stops the build.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_execution_timeout = 180
nb_merge_streams = True
nb_output_stderr = "error"
nb_render_markdown_format = "myst"

html_theme = "furo"
html_title = "preshape"
html_math_renderer = "mathml"
html_static_path = ["style"]
html_css_files = ["preshape.css"]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
napoleon_google_docstring = False
napoleon_use_ivar = True
