"""A limb.toml from what people know of a limb: lengths, tubes, gears, servos."""
