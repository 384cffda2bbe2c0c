"""The atrium, the project's own demonstration scene: shapes, textures, layout and the glb writer.

Everything is generated: `tools/make_atrium.py` writes `content/scenes/atrium/atrium.glb`.
Conventions of the whole package, glTF's: metres, right-handed, y up, outward faces
counter-clockwise.
"""
