"""The path-traced reference: our scene as mitsuba's, the comparison and the sheet of both.

Mitsuba 3 [Jakob22 "Mitsuba 3 renderer"] is a development dependency.
"""
