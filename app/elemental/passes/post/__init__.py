"""What develops the lit scene into a picture."""
