"""Meshes, materials, lights, cameras and their importers: plain numpy, no GL."""
