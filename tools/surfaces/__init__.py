"""Pictures of decals, and shapes of a room that shows them and glass."""
