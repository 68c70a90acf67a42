"""Makes what is released: the two-file core, wheels, the Debian package, the sums. `./dev release` runs it."""
