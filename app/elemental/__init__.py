"""elemental: the renderer of the 2012 "Elemental" demo [Mittring12], open and readable."""

__version__ = "0.1.0"
