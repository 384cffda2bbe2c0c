"""One frame: ``declare`` is its passes on one page, ``renderer`` what lives between frames."""

from elemental.frame.renderer import OCTREE_KEYS, Frame, Renderer, max_pixels
from elemental.frame.shadow_needs import SHADOW_KEYS
from elemental.frame.views import VIEWS

__all__ = ["OCTREE_KEYS", "SHADOW_KEYS", "VIEWS", "Frame", "Renderer", "max_pixels"]
