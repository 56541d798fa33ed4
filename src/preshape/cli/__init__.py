"""The command line: reads options, calls the workflow, shows the result; no logic."""

from preshape.cli.main import main

__all__ = ["main"]
