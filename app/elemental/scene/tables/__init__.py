"""The tables of a scene file, a module a topic: what keys they have and what values those take."""
