"""`brace demo`: the paper's table and a simulated limb, end to end, with nothing attached."""
