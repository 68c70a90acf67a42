"""`python -m brace.effects`: prints docs/effects.md."""

from brace.effects.page import page

print(page(), end="")
