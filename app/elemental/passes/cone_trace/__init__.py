"""Indirect light: cones from the G-buffer through the octree. [Mittring12], [Crassin11]"""
