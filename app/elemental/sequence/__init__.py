"""Frame sequences: the same bytes whether they were made at once or after an interruption."""
