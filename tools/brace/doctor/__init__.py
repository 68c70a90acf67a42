"""What of a machine is there for working with Brace, and what is missing."""
