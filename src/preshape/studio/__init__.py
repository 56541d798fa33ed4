"""The studio: one page and an HTTP API, over the workbench."""
