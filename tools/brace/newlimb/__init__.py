"""A limb.toml from what people know of a limb: lengths, tubes, gears, servos."""

# What may be said of a link; here, because the command line's help says it too.
LINK_FORMS = (
    "'tube OUTER INNER MATERIAL', 'rod DIAMETER MATERIAL', 'measured MM_PER_N', 'rigid' (mm; a material or e.g. 70GPa)"
)
