"""The small scenes that accuracy is measured on, as code: `tools/make_rooms.py` writes their files.

The geometry of each is a glb here; camera, light from outside and settings stand in the scene file
of the same name under content/scenes.
"""
