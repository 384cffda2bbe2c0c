"""Maths, conventions, layouts and images: everything that needs no GL."""
