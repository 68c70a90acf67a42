"""Other people's ways to choose effects, on the same records, with the same inputs, judged by the same judge."""
