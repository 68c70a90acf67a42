"""Putting an image on a board: what the image is, what the board is, and the tools that write it."""
