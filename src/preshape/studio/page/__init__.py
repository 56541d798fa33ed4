"""The page of the studio: one function that puts it on a server."""

from preshape.studio.page.build import STATIC, build

__all__ = ["STATIC", "build"]
