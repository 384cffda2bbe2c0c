"""The systems of a frame: free functions that take graph handles and return graph handles."""
