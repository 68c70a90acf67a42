"""Where model and measurement disagree: found, named, added to the model, and the gap shown to shrink."""
