"""Datasets from people's own files: tables found in them, columns named, units and signs converted on the user's
word."""
