"""`brace sim`: the controller's own code over simulated limbs, on loopback ports, with nothing attached."""
