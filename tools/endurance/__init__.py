"""Frames of ever changing settings, sizes, volumes and views, and what memory they leave behind."""
