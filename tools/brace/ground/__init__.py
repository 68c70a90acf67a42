"""What every room stands on: errors, files, units, slips of the pen. Nothing here knows a limb."""
