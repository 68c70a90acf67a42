"""A page that shows the limbs of a bus as they stand, in a browser on the same computer."""
