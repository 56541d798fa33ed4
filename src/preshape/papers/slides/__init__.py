"""Hyde, Chang & Seering's slides for NASA (1991), a summary of Hyde's thesis."""

from preshape.papers.slides.paper import SLIDES

__all__ = ["SLIDES"]
