"""Parameters from measurements: fitted in what the data can tell, with what it cannot tell said aloud."""
