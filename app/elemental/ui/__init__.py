"""The window: fly camera, HUD, key bindings."""
