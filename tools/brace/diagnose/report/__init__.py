"""report.html: what a diagnosis says, for people; one file without scripts, fonts or pictures from
elsewhere."""
