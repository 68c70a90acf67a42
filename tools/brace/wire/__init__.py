"""What the controller shows to the outside, by name: generated from the dictionary."""
