"""Makes the textures of the post-processing effects from code alone, the same every time."""
