"""The studio: one local web page and its HTTP API over the workbench; a face, no logic."""
